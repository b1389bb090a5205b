// Passes over chunks of bodies: threads, results of chunks, and computing time.
#pragma once

#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "grit/contact/batch.hpp"
#include "kernel/model.hpp"
#include "motion/motion.hpp"
#include "ranks/shared_archive.hpp"
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
  double relative_speed = 0;  ///< see Skins::relative_speed()
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
  explicit Passes(unsigned threads, Communicator* ranks = nullptr);

  Team& team() { return team_; }
  Ranks& ranks() { return ranks_; }
  const Ranks& ranks() const { return ranks_; }
  unsigned threads() const { return team_.threads(); }
  std::vector<ChunkResult>& chunks() { return chunks_; }
  const std::vector<ChunkResult>& chunks() const { return chunks_; }
  void resize(std::size_t bodies) { chunks_.resize(chunks_of(bodies)), ranks_.resize(chunks_.size()); }
  /// Divides the chunks among the ranks by their recent computing time.
  void divide();
  /// Completes the computing times of chunks.
  void collect_times();
  /// Computing time of the busiest rank over the mean, less 1, until times were last collected or chunks divided.
  double imbalance() const { return mean_ > 0 ? busiest_ / mean_ - 1 : 0; }

  /// Shares work(chunk, laps) among the threads, for some chunks; times one in eight.
  template <class Work>
  void each(std::uint64_t step, std::span<const std::uint32_t> chunks, Work work) {
    each_of(
        step, chunks.size(), [chunks](std::size_t k) { return std::size_t{chunks[k]}; }, work);
  }
  /// The same for own chunks.
  template <class Work>
  void each(std::uint64_t step, Work work) {
    each_of(
        step, ranks_.last() - ranks_.first(), [first = ranks_.first()](std::size_t k) { return first + k; }, work);
  }
  /// The same for all chunks, on every rank.
  template <class Work>
  void each_on_all_ranks(std::uint64_t step, Work work) {
    each_of(
        step, chunks_.size(), [](std::size_t k) { return k; }, work);
  }
  /// work(chunk) for own chunks, without measuring time.
  template <class Work>
  void each_own(Work work) {
    team_.each(ranks_.last() - ranks_.first(), [&](std::size_t k) { work(ranks_.first() + k); });
  }
  /// part(chunk) of all chunks, evaluated by the threads of their ranks.
  template <class Part>
  auto of_chunks(Part part) {
    std::vector<decltype(part(std::size_t{0}))> found(chunks_.size());
    each_own([&](std::size_t chunk) { found[chunk] = part(chunk); });
    ranks_.complete(found);
    return found;
  }
  /// These summed in the order of the chunks.
  template <class Part>
  auto sum(Part part) {
    const auto found = of_chunks(part);
    return std::accumulate(found.begin(), found.end(), decltype(part(std::size_t{0})){});
  }
  /// Extremes of the results of all chunks.
  struct Extremes {
    double overlap = 0, speed = 0;
    double furthest = 0;  ///< see find_extremes()
    bool finite = true;
  };
  /// Finds them. `furthest`: of own chunks. With `energies`, completes the results of all chunks.
  void find_extremes(double furthest, bool energies);
  const Extremes& extremes() const { return extremes_; }
  /// Measures a phase outside each().
  PhaseWatch watch(StepPhase phase) { return {phases_[static_cast<std::size_t>(phase)], team_}; }
  /// Times of all phases; that of each() is divided in proportion to the timed chunks.
  std::vector<PhaseTime> phases() const;

  /// Restoring, divides the chunks among the ranks.
  void serialize(SharedArchive& archive);

 private:
  // Reading the clock takes about 30 ns, a chunk about 20 µs.
  static constexpr std::uint64_t timed_every = 8;

  template <class Chunk, class Work>
  void each_of(std::uint64_t step, std::size_t count, Chunk chunk_of, Work work) {
    const PhaseWatch watch(passes_, team_);
    team_.each(count, [&](std::size_t k) {
      const std::size_t chunk = chunk_of(k);
      Laps laps((chunk + step) % timed_every == 0);
      work(chunk, laps);
    });
  }

  Ranks ranks_;
  Team team_;
  std::vector<ChunkResult> chunks_;
  Extremes extremes_;
  // Of each chunk [s]: computing time until times were last collected, and recently: since the last division with half
  // of what it was then.
  std::vector<double> counted_, recent_;
  double busiest_ = 0, mean_ = 0;  // computing times of ranks, summed over collections [s]
  std::vector<PhaseTime> phases_;
  PhaseTime passes_;  // of all calls of each()
};

}  // namespace grit
