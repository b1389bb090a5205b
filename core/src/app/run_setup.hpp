// Facts about a run, for several commands.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "description/components.hpp"
#include "description/description.hpp"
#include "output/run_json.hpp"

namespace grit {

/// Spheres and errors of each group of clumps.
std::map<std::string, ClumpFacts> clumps_of(const Components& components);

/// State of bodies that the picture needs.
StateRequest picture_state(const SceneDescription& scene);

/// State of bodies that the picture and the components need.
StateRequest run_state(const SceneDescription& scene, const Components& components);

/// The same as text, with the components that need it: "rotation: picture".
std::vector<std::string> state_by_component(const SceneDescription& scene, const Components& components);

}  // namespace grit
