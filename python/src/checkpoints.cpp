#include "checkpoints.hpp"

#include <utility>

#include "grit/error.hpp"
#include "output/checkpoint.hpp"
#include "output/plugins_used.hpp"
#include "simulation/parts.hpp"
#include "storage/atomic_file.hpp"
#include "storage/state_file.hpp"

namespace grit::python {

Description facts_of(Simulation& simulation) {
  const OpenedScene& opened = *simulation.parts().opened;
  return checkpoint_facts(
      {.description = simulation.description(), .plugins = plugins_used(*opened.scene.description, *opened.registry)});
}

void check_fits(const SavedState& saved, const Description& facts) {
  check_facts(saved.name, *saved.facts, facts, ResumedBy::python);
}

void write_saved(const std::filesystem::path& path, const SavedState& saved) {
  write_state(path, *saved.facts, saved.checkpoint, {}, free_temporary_path(path));
}

SavedState read_saved(const std::filesystem::path& path) try {
  StateFile file = read_state(path);
  return {std::move(file.checkpoint), std::make_shared<const Description>(std::move(file.facts)), path.string()};
} catch (const FileError& error) {
  throw FileError(error.what() + std::string("\n  it is not a complete checkpoint of this grit; run from the start"));
}

}  // namespace grit::python
