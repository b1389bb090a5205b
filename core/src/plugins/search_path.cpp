#include <cstdlib>
#include <sstream>

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

}  // namespace grit
