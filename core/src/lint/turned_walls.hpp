// Walls with the bodies behind them.
#pragma once

#include <vector>

#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message for each one-sided wall that has most bodies of the first instant behind it and none in front of its face,
/// with no other wall in between. Such a wall holds no body. Bodies that reach it are refused elsewhere.
std::vector<UnusedSetting> turned_walls(const Scene& described, const World& world);

}  // namespace grit
