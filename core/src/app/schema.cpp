#include "input/schema.hpp"

#include <iostream>

#include "app/options.hpp"

namespace grit {

ExitStatus schema_command(const Options& options) {
  if (!options.words().empty())
    throw UsageError("'grit schema' takes no arguments; it prints the schema of all descriptions");
  std::cout << scene_schema(*options.registry()).dump(2) << '\n';
  return ExitStatus::done;
}

}  // namespace grit
