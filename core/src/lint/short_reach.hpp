// Attraction over distances shorter than the displacement of a body per step.
#pragma once

#include <optional>

#include "kernel/kernel.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message if the reach of the contact law is below the maximum displacement per step.
std::optional<UnusedSetting> short_reach(const Kernel& kernel);

}  // namespace grit
