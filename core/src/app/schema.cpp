#include "input/schema.hpp"

#include <iostream>

#include "app/options.hpp"

namespace grit {

ExitStatus schema_command(const std::vector<std::string>& words) {
  Options options(command("schema"));
  if (!options.read(words)) return ExitStatus::done;
  if (!options.words().empty())
    throw UsageError("'grit schema' takes no arguments; it prints the schema of all descriptions");
  std::cout << scene_schema(*options.registry()).dump(2) << '\n';
  return ExitStatus::done;
}

}  // namespace grit
