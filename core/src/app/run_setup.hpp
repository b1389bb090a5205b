// Facts about a run, for several commands.
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

/// Spheres and errors of each group of clumps.
std::map<std::string, ClumpFacts> clumps_of(const Components& components);

/// State of bodies that the picture needs.
StateRequest picture_state(const SceneDescription& scene);

/// State of bodies that the picture and the components need.
StateRequest run_state(const SceneDescription& scene, const Components& components);

/// The same as text, with the components that need it: "rotation: picture".
std::vector<std::string> state_by_component(const SceneDescription& scene, const Components& components);

}  // namespace grit
