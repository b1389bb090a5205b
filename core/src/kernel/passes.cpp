#include "kernel/passes.hpp"

#include <algorithm>
#include <utility>

namespace grit {

Passes::Passes(unsigned threads, Communicator* ranks)
    : ranks_(ranks), team_(threads), phases_{{"search", 0}, {"contacts", 0}, {"walls", 0}, {"motion", 0}} {}

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

void Passes::collect_times() {
  if (!ranks_.several()) return;
  std::vector<std::array<double, step_phases>> seconds;
  for (const ChunkResult& chunk : chunks_) seconds.push_back(chunk.seconds);
  ranks_.complete(seconds);
  counted_.resize(chunks_.size()), recent_.resize(chunks_.size());
  std::vector<double> of_ranks(ranks_.count());
  for (std::size_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    chunks_[chunk].seconds = seconds[chunk];
    const double total = std::accumulate(seconds[chunk].begin(), seconds[chunk].end(), 0.0);
    const double since = total - std::exchange(counted_[chunk], total);
    recent_[chunk] += since, of_ranks[ranks_.cuts().owner(chunk)] += since;
  }
  busiest_ += std::ranges::max(of_ranks);
  mean_ += std::accumulate(of_ranks.begin(), of_ranks.end(), 0.0) / ranks_.count();
}

void Passes::divide() {
  if (!ranks_.several()) return;
  collect_times();
  ranks_.divide(recent_);
  for (double& recent : recent_) recent *= 0.5;
}

void Passes::find_extremes(double furthest, bool energies) {
  if (energies) ranks_.complete(chunks_);
  double overlap = 0, speed = 0;
  bool finite = true;
  for (std::size_t chunk = ranks_.first(); chunk < ranks_.last(); ++chunk) {
    const ChunkResult& own = chunks_[chunk];
    overlap = std::max(overlap, own.overlap), speed = std::max(speed, own.motion.velocities.largest_speed());
    finite = finite && own.motion.finite;
  }
  std::array<double, 4> all{overlap, speed, furthest, finite ? 0.0 : 1.0};
  ranks_.largest(all);
  extremes_ = {all[0], all[1], all[2], all[3] == 0};
}

void Passes::serialize(SharedArchive& archive) {
  chunks_.resize(archive.length(chunks_.size(), sizeof(ChunkResult::seconds)));
  ranks_.resize(chunks_.size());
  archive(passes_.seconds, passes_.parallel);
  for (PhaseTime& phase : phases_) archive(phase.seconds, phase.parallel);
  archive.each_chunk(chunks_.size(), [this](Archive& own, std::size_t chunk) { own(chunks_[chunk].seconds); });
  if (!archive.restoring()) return;
  recent_.clear();
  for (const ChunkResult& chunk : chunks_)
    recent_.push_back(std::accumulate(chunk.seconds.begin(), chunk.seconds.end(), 0.0));
  counted_ = recent_;
  divide();
}

}  // namespace grit
