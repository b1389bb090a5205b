// Targets of servos that bodies cannot bear, or that a condition does not wait for.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "grit/geometry.hpp"
#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message for each servo that pulls, if no contact law with these materials has attraction: normal stresses of a
/// cell below 0, forces along a wall's normal away from the bodies. `geometries`: of the walls at the start.
std::vector<UnusedSetting> tensile_targets(const Scene& described,
                                           const std::map<std::string, std::shared_ptr<const Geometry>>& geometries);

/// A message for each condition on a pressure or stress that is outside the range of the servo's targets in this stage
/// and the one before, so that the run cannot meet it.
std::vector<UnusedSetting> missed_targets(const Scene& described);

}  // namespace grit
