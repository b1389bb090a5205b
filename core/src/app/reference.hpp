// One component in full, for `grit plugins NAME` and `grit describe NAME`.
#pragma once

#include <string>

#include "plugins/registry.hpp"

namespace grit {

/// What is installed under this name, of whatever kind: where it comes from, how it was built, its parameters. Throws
/// PluginError, with the nearest name, if there is nothing.
std::string component_text(const Registry& registry, const std::string& name);

}  // namespace grit
