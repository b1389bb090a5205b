// Which chunks may move while others are still being evaluated.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace grit {

/// The bodies of a chunk may move once it is evaluated, and so are all chunks that look at its bodies. Evaluated in
/// rising order, each may at once, as chunks look at higher ones alone.
class Readiness {
 public:
  /// `reached[c]`: chunks above c whose bodies the evaluation of c looks at.
  void build(std::vector<std::vector<std::uint32_t>> reached) {
    reached_ = std::move(reached);
    lookers_.assign(reached_.size(), 0);
    for (const auto& chunks : reached_)
      for (const std::uint32_t chunk : chunks) ++lookers_[chunk];
    waits_ = std::make_unique<std::atomic<std::uint32_t>[]>(reached_.size());
  }
  /// Begins a pass; before any thread takes part in it.
  void restart() {
    for (std::size_t c = 0; c < lookers_.size(); ++c) waits_[c].store(lookers_[c], std::memory_order_relaxed);
  }
  /// Says that a chunk has been evaluated, from any thread. Returns whether it may move.
  bool evaluated(std::size_t chunk) {
    for (const std::uint32_t c : reached_[chunk]) waits_[c].fetch_sub(1, std::memory_order_release);
    return waits_[chunk].load(std::memory_order_acquire) == 0;
  }

 private:
  std::vector<std::vector<std::uint32_t>> reached_;
  std::vector<std::uint32_t> lookers_;                   // by chunk: how many reach it
  std::unique_ptr<std::atomic<std::uint32_t>[]> waits_;  // how many of them are not evaluated yet
};

}  // namespace grit
