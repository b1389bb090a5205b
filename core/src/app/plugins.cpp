#include <iomanip>
#include <iostream>

#include "app/options.hpp"
#include "app/reference.hpp"
#include "grit/error.hpp"
#include "plugins/build_facts.hpp"

namespace grit {

ExitStatus plugins_command(const Options& options) {
  const auto registry = options.registry();
  if (!options.words().empty()) {
    std::cout << component_text(*registry, options.only_word("name"), true);
    return ExitStatus::done;
  }
  const BuildFacts& build = build_facts();
  std::cout << "grit " << build.version << ", instruction set " << build.instruction_set << " (-march=" << build.arch
            << ")\n\n";
  ExitStatus status = ExitStatus::done;
  for (const Installed& one : registry->installed()) {
    const std::string file = one.file.empty() ? "" : "\n" + std::string(40, ' ') + one.file.lexically_normal().string();
    std::cout << std::left << std::setw(10) << one.kind << std::setw(22) << one.name << std::setw(8);
    try {
      const PluginInfo& info = registry->info(one.kind, one.name);
      std::cout << info.version << info.doc << file << std::endl;
    } catch (const PluginError& error) {  // the others are still listed
      std::cout << "-"
                << "cannot be loaded" << file << std::endl;
      std::cerr << "grit: " << error.what() << std::endl;
      status = ExitStatus::plugin;
    }
  }
  return status;
}

}  // namespace grit
