// Walls that pass bodies in a prescribed time step.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "grit/geometry.hpp"
#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message for each wall that moves towards bodies by more than /guards/travel of `smallest_radius` [m] in a
/// prescribed time step. Other time steps follow the walls. `geometries`: of the walls at the start.
std::vector<UnusedSetting> fast_walls(const Scene& described,
                                      const std::map<std::string, std::shared_ptr<const Geometry>>& geometries,
                                      double smallest_radius);

}  // namespace grit
