// Attraction that acts over less than the way of a body in a step.
#pragma once

#include <optional>

#include "kernel/kernel.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message if a contact law acts at a distance that a body may pass in one step.
std::optional<UnusedSetting> short_reach(const Kernel& kernel);

}  // namespace grit
