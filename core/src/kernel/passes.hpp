// Passes over chunks of bodies: threads, results of chunks, and computing time.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "grit/contact/batch.hpp"
#include "kernel/model.hpp"
#include "motion/motion.hpp"
#include "threads/chunks.hpp"
#include "threads/stopwatch.hpp"
#include "threads/team.hpp"

namespace grit {

enum class StepPhase : std::size_t { search, contacts, walls, motion };
inline constexpr std::size_t step_phases = 4;

/// Results of the last pass for one chunk, and its computing time if measured.
struct alignas(64) ChunkResult {
  double overlap = 0;  ///< largest, over a radius
  Losses losses;
  Motion motion, clumps;
  Mat3 crossing = Mat3::Zero();  ///< see EnergyBalance
  bool moved = false;
  std::array<double, step_phases> seconds{};

  double& time_of(StepPhase phase) { return seconds[static_cast<std::size_t>(phase)]; }
};

/// Adds its lifetime to a phase, and to its parallel part what passes take.
class PhaseWatch {
 public:
  PhaseWatch(PhaseTime& phase, const Team& team)
      : phase_(phase), team_(team), before_(team.parallel_seconds()), watch_(phase.seconds) {}
  ~PhaseWatch() { phase_.parallel += team_.parallel_seconds() - before_; }
  PhaseWatch(const PhaseWatch&) = delete;
  PhaseWatch& operator=(const PhaseWatch&) = delete;

 private:
  PhaseTime& phase_;
  const Team& team_;
  double before_;
  Stopwatch watch_;
};

class Passes {
 public:
  explicit Passes(unsigned threads);

  Team& team() { return team_; }
  unsigned threads() const { return team_.threads(); }
  std::vector<ChunkResult>& chunks() { return chunks_; }
  const std::vector<ChunkResult>& chunks() const { return chunks_; }
  void resize(std::size_t bodies) { chunks_.resize(chunks_of(bodies)); }

  /// Shares work(chunk, laps) among the threads; times one chunk in eight.
  template <class Work>
  void each(std::uint64_t step, Work work) {
    const PhaseWatch watch(passes_, team_);
    team_.each(chunks_.size(), [&](std::size_t chunk) {
      Laps laps((chunk + step) % timed_every == 0);
      work(chunk, laps);
    });
  }
  /// part(chunk), evaluated by all threads and summed in the order of the chunks.
  template <class Part>
  auto sum(Part part) {
    std::vector<decltype(part(std::size_t{0}))> found(chunks_.size());
    team_.each(found.size(), [&](std::size_t chunk) { found[chunk] = part(chunk); });
    return std::accumulate(found.begin(), found.end(), decltype(part(std::size_t{0})){});
  }
  /// Measures a phase outside each().
  PhaseWatch watch(StepPhase phase) { return {phases_[static_cast<std::size_t>(phase)], team_}; }
  /// Times of all phases; that of each() is divided in proportion to the timed chunks.
  std::vector<PhaseTime> phases() const;

  void serialize(Archive& archive, std::size_t bodies);

 private:
  // Reading the clock takes about 30 ns, a chunk about 20 µs.
  static constexpr std::uint64_t timed_every = 8;

  Team team_;
  std::vector<ChunkResult> chunks_;
  std::vector<PhaseTime> phases_;
  PhaseTime passes_;  // of all calls of each()
};

}  // namespace grit
