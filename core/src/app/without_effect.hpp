// Parts of a description that change nothing.
#pragma once

#include <string>
#include <vector>

#include "run/simulation.hpp"
#include "scene/description.hpp"

namespace grit {

/// One line each, with the pointer of the part and why; `world` is the scene at its start.
std::vector<std::string> without_effect(const SceneDescription& scene, const Simulation& world);

}  // namespace grit
