#include <iomanip>
#include <iostream>

#include "app/options.hpp"
#include "app/reference.hpp"

namespace grit {

ExitStatus plugins_command(const std::vector<std::string>& words) {
  Options options(command("plugins"));
  if (!options.read(words)) return ExitStatus::done;
  const auto registry = options.registry();
  if (!options.words().empty()) {
    std::cout << component_text(*registry, options.only_word("name"));
    return ExitStatus::done;
  }
  for (const Installed& one : registry->installed()) {
    const PluginInfo& info = registry->info(one.kind, one.name);
    std::cout << std::left << std::setw(10) << one.kind << std::setw(20) << one.name << std::setw(8) << info.version
              << info.doc << (one.file.empty() ? "" : "\n" + std::string(38, ' ') + one.file.lexically_normal().string())
              << '\n';
  }
  return ExitStatus::done;
}

}  // namespace grit
