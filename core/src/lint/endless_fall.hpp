// Bodies that nothing can stop.
#pragma once

#include <optional>

#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message if gravity accelerates bodies in a domain that is periodic along all axes, and neither a wall, a held body
/// nor another force of an engine can stop them.
std::optional<UnusedSetting> endless_fall(const Scene& described);

}  // namespace grit
