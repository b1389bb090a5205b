// Densities that no solid has.
#pragma once

#include <vector>

#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message for each material of bodies whose density is far from that of any solid, probably by its unit.
std::vector<UnusedSetting> odd_densities(const SceneDescription& scene);

}  // namespace grit
