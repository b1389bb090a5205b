#include <cstdlib>
#include <sstream>

#include "plugins/registry.hpp"

namespace grit {

std::vector<std::filesystem::path> plugin_directories(const std::vector<std::string>& option,
                                                      const std::filesystem::path& beside) {
  std::vector<std::filesystem::path> directories(option.begin(), option.end());
  if (const char* variable = std::getenv("GRIT_PLUGIN_PATH")) {
    std::istringstream list(variable);
    for (std::string one; std::getline(list, one, ':');)
      if (!one.empty()) directories.emplace_back(one);
  }
  directories.push_back(beside);
  return directories;
}

}  // namespace grit
