// What `grit plugins NAME` and `grit describe NAME` know.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plugins/registry.hpp"

namespace grit {

/// Parameters of every component of this name, of any kind; `in_full` adds the file and the build. Throws PluginError
/// with the nearest name if there is none.
std::string component_text(const Registry& registry, const std::string& name, bool in_full);

/// Names of sections of a description and of files of commands, each with one line.
std::vector<std::pair<std::string, std::string>> described_sections(const Registry& registry);

}  // namespace grit
