// One component, for `grit plugins NAME` and `grit describe NAME`.
#pragma once

#include <string>

#include "plugins/registry.hpp"

namespace grit {

/// What is installed under this name, of whatever kind: its parameters; `in_full` with where it comes from and how it
/// was built. Throws PluginError, with the nearest name, if there is nothing.
std::string component_text(const Registry& registry, const std::string& name, bool in_full);

}  // namespace grit
