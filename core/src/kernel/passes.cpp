#include "kernel/passes.hpp"

namespace grit {

Passes::Passes(unsigned threads)
    : team_(threads), phases_{{"search", 0}, {"contacts", 0}, {"walls", 0}, {"motion", 0}} {}

std::vector<PhaseTime> Passes::phases() const {
  std::array<double, step_phases> timed{};
  for (const ChunkResult& chunk : chunks_)
    for (std::size_t phase = 0; phase < step_phases; ++phase) timed[phase] += chunk.seconds[phase];
  const double all = std::accumulate(timed.begin(), timed.end(), 0.0);
  auto phases = phases_;
  for (std::size_t phase = 0; phase < step_phases && all > 0; ++phase)
    phases[phase].seconds += passes_.seconds * timed[phase] / all,
        phases[phase].parallel += passes_.parallel * timed[phase] / all;
  return phases;
}

void Passes::serialize(Archive& archive, std::size_t bodies) {
  archive(passes_.seconds, passes_.parallel);
  for (PhaseTime& phase : phases_) archive(phase.seconds, phase.parallel);
  resize(bodies);
  for (ChunkResult& chunk : chunks_) archive(chunk.seconds);
}

}  // namespace grit
