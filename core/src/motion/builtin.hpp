// Engines that are part of the kernel: what they ask for is done inside the kernel's own passes.
#pragma once

#include <span>

#include "grit/plugin.hpp"

namespace grit {

/// gravity, local-damping, hold.
std::span<const PluginInfo> builtin_engines();

}  // namespace grit
