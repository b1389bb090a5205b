// Gravity towards a side without a wall.
#pragma once

#include <optional>

#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message if a stage waits for bodies to rest on each other, but gravity, the only force, leads none of those of the
/// first instant to a wall. `world`: at the first instant.
std::optional<UnusedSetting> missed_floor(const Scene& described, const World& world);

}  // namespace grit
