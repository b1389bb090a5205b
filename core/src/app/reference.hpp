// One component, for `grit plugins NAME` and `grit describe NAME`.
#pragma once

#include <string>

#include "plugins/registry.hpp"

namespace grit {

/// Parameters of every component of this name, of any kind; `in_full` adds the file and the build. Throws PluginError
/// with the nearest name if there is none.
std::string component_text(const Registry& registry, const std::string& name, bool in_full);

}  // namespace grit
