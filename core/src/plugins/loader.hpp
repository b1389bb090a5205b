// Opens the file of a plugin and believes nothing that it has not checked.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plugins/kind.hpp"

namespace grit {

/// The directory of this library: the plugins that come with it are there too.
std::filesystem::path library_directory();

/// Every difference between two build tags, each as "what: expected …, found …"; none if a plugin with the tag `found`
/// may be used by a kernel with the tag `expected`. Reads no further than what `found` proves to have.
std::vector<std::string> mismatches(const BuildTag& expected, const BuildTag& found);

/// Opens `file`, which is never closed again, and checks what it says of itself. The build tag is compared before
/// anything else is touched. Throws PluginError with the file and what mends it. Safe to call from several threads.
const PluginInfo& load_plugin(const std::filesystem::path& file, const Kind& kind, const std::string& name);

}  // namespace grit
