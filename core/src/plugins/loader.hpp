// Opens the file of a plugin and checks it before use.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "plugins/kind.hpp"

namespace grit {

/// The file of this library.
std::filesystem::path library_file();
/// Its directory, which also contains the plugins that come with it.
std::filesystem::path library_directory();

/// All differences between two build tags, as "what: expected …, found …"; none if a kernel with the tag `expected` can
/// use a plugin with the tag `found`. Reads `found` only as far as it has been verified.
std::vector<std::string> mismatches(const BuildTag& expected, const BuildTag& found);

/// Opens `file`, which is never closed again, if it is complete, and checks its PluginInfo, the build tag before
/// anything else. Throws PluginError with the file and the remedy. Safe to call from several threads.
const PluginInfo& load_plugin(const std::filesystem::path& file, const Kind& kind, const std::string& name);

}  // namespace grit
