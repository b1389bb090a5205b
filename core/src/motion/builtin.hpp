// Built-in engines. The kernel applies their settings in its own passes over the bodies.
#pragma once

#include <span>

#include "grit/plugin.hpp"

namespace grit {

/// gravity, drag, density-scaling, local-damping, hold, planar, prescribed-motion, sink.
std::span<const PluginInfo> builtin_engines();

}  // namespace grit
