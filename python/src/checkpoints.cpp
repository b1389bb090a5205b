#include "checkpoints.hpp"

#include "output/checkpoint.hpp"
#include "output/plugins_used.hpp"
#include "simulation/parts.hpp"

namespace grit::python {
namespace {

RunFacts facts_of(Simulation& simulation) {
  const OpenedScene& opened = *simulation.parts().opened;
  return {.description = simulation.description(),
          .plugins = plugins_used(*opened.scene.description, *opened.registry)};
}

}  // namespace

void write(const std::filesystem::path& path, Simulation& simulation, const Checkpoint& checkpoint) {
  write_checkpoint(path, facts_of(simulation), checkpoint);
}

Checkpoint read(const std::filesystem::path& path, Simulation& simulation) {
  return read_checkpoint(path, facts_of(simulation));
}

}  // namespace grit::python
