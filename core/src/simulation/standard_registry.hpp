// The built-in components and the installed plugins.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plugins/registry.hpp"

namespace grit {

/// Searches the folders of `plugin_path` first, then those of GRIT_PLUGIN_PATH, then those next to the library.
/// `option`: what sets `plugin_path`, in messages.
std::unique_ptr<Registry> standard_registry(const std::vector<std::string>& plugin_path,
                                            const std::string& option = "--plugin-path");

}  // namespace grit
