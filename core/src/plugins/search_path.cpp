#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "format/names.hpp"
#include "plugins/build_facts.hpp"
#include "plugins/registry.hpp"

namespace grit {

std::vector<std::filesystem::path> plugin_directories(const std::vector<std::string>& option,
                                                      const std::filesystem::path& beside) {
  std::vector<std::filesystem::path> directories;
  const auto add = [&](const std::filesystem::path& directory) {
    std::error_code none;
    if (const auto own = directory / build_facts().arch; std::filesystem::is_directory(own, none))
      directories.push_back(own);
    directories.push_back(directory);
  };
  for (const auto& one : option) add(one);
  if (const char* variable = std::getenv("GRIT_PLUGIN_PATH")) {
    std::istringstream list(variable);
    for (std::string one; std::getline(list, one, ':');)
      if (!one.empty()) add(one);
  }
  directories.push_back(beside);
  return directories;
}

std::string fault_of_plugin_directory(const std::filesystem::path& directory) {
  std::error_code none;
  if (!std::filesystem::exists(directory, none)) return "which does not exist";
  if (!std::filesystem::is_directory(directory, none)) return "which is a file";
  const auto has_a_kind = [&](const std::filesystem::path& there) {
    return std::ranges::any_of(
        kinds, [&](const Kind& kind) { return std::filesystem::is_directory(there / kind.folder, none); });
  };
  const std::filesystem::directory_iterator inside(directory, none), end;
  // Or one for each instruction set, each with folders of kinds.
  if (has_a_kind(directory) || std::any_of(inside, end, [&](const auto& entry) { return has_a_kind(entry.path()); }))
    return "";
  std::vector<std::string> folders;
  for (const Kind& kind : kinds) folders.push_back(kind.folder);
  return "which has none of the folders " + listed(folders);
}

}  // namespace grit
