// The plugins that take part in a run.
#pragma once

#include <vector>

#include "description/description.hpp"
#include "output/run_facts.hpp"
#include "plugins/registry.hpp"

namespace grit {

/// Every component of the scene, once, by kind and name.
std::vector<PluginUsed> plugins_used(const SceneDescription& scene, const Registry& registry);

}  // namespace grit
