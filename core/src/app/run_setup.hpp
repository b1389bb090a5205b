// What several commands need to know before a run.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "description/components.hpp"
#include "description/description.hpp"
#include "output/run_json.hpp"
#include "plugins/registry.hpp"

namespace grit {

/// Every component of the scene, once, by kind and name.
std::vector<PluginUsed> plugins_used(const SceneDescription& scene, const Registry& registry);

/// Of each group of clumps.
std::map<std::string, ClumpFacts> clumps_of(const Components& components);

/// State of bodies that the scene's picture asks for.
StateRequest picture_state(const SceneDescription& scene);

/// The same, with what the scene's components ask for.
StateRequest run_state(const SceneDescription& scene, const Components& components);

/// The same, with who asked: "rotation: picture".
std::vector<std::string> who_asked(const SceneDescription& scene, const Components& components);

}  // namespace grit
