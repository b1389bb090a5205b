// Values of geometries that a stage repeats.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// Values of a wall's geometry in the change of a stage that are those which the wall has: they do not put back a wall
/// that has moved. Checks values for which `is_written(pointer)`.
std::vector<UnusedSetting> repeated_geometry(const Scene& described,
                                             const std::function<bool(const std::string&)>& is_written);

}  // namespace grit
