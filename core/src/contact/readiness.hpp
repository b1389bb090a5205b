// Which chunks may move while others are still being evaluated.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace grit {

/// The bodies of a chunk may move once it is evaluated, and all chunks that look at its bodies or do something to them.
class Readiness {
 public:
  /// `reached[c]`: chunks other than c whose bodies the evaluation of c looks at.
  void build(std::vector<std::vector<std::uint32_t>> reached) {
    reached_ = std::move(reached);
    awaited_.assign(reached_.size(), 1);
    for (const auto& chunks : reached_)
      for (const std::uint32_t chunk : chunks) ++awaited_[chunk];
    waits_ = std::make_unique<std::atomic<std::uint32_t>[]>(reached_.size());
  }
  /// Begins a pass; before any thread takes part in it.
  void restart() {
    for (std::size_t c = 0; c < awaited_.size(); ++c) waits_[c].store(awaited_[c], std::memory_order_relaxed);
  }
  /// Whether the chunk waits for nothing but its own evaluation. Once true, it remains so until evaluated(chunk).
  bool waits_for_itself(std::size_t chunk) const { return waits_[chunk].load(std::memory_order_acquire) == 1; }
  /// Says that a chunk has been evaluated, from any thread; calls move(c) for each c that may move now.
  template <class Move>
  void evaluated(std::size_t chunk, Move move) {
    const auto one_less = [&](std::size_t c) {
      if (waits_[c].fetch_sub(1, std::memory_order_acq_rel) == 1) move(c);
    };
    one_less(chunk);
    for (const std::uint32_t c : reached_[chunk]) one_less(c);
  }

 private:
  std::vector<std::vector<std::uint32_t>> reached_;
  std::vector<std::uint32_t> awaited_;  // by chunk: evaluations, its own among them
  std::unique_ptr<std::atomic<std::uint32_t>[]> waits_;
};

}  // namespace grit
