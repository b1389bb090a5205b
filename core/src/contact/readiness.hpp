// Which chunks may move while others are still being evaluated.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace grit {

/// The bodies of a chunk may move as soon as it and all chunks that read its bodies are evaluated. Evaluated in
/// ascending order, each may move at once, as chunks only read higher ones.
class Readiness {
 public:
  /// `reached[c]`: chunks above c whose bodies the evaluation of c reads.
  void build(std::vector<std::vector<std::uint32_t>> reached) {
    reached_ = std::move(reached);
    dependents_.assign(reached_.size(), 0);
    for (const auto& chunks : reached_)
      for (const std::uint32_t chunk : chunks) ++dependents_[chunk];
    waits_ = std::make_unique<std::atomic<std::uint32_t>[]>(reached_.size());
  }
  /// Begins a pass; call before any thread takes part in it.
  void restart() {
    for (std::size_t c = 0; c < dependents_.size(); ++c) waits_[c].store(dependents_[c], std::memory_order_relaxed);
  }
  /// Marks a chunk as evaluated; from any thread. Returns whether it may move.
  bool evaluated(std::size_t chunk) {
    for (const std::uint32_t c : reached_[chunk]) waits_[c].fetch_sub(1, std::memory_order_release);
    return waits_[chunk].load(std::memory_order_acquire) == 0;
  }

 private:
  std::vector<std::vector<std::uint32_t>> reached_;
  std::vector<std::uint32_t> dependents_;                // by chunk: number of chunks that read it
  std::unique_ptr<std::atomic<std::uint32_t>[]> waits_;  // number of these not evaluated yet
};

}  // namespace grit
