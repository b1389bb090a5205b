// Which rank owns which chunks of bodies.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "threads/chunks.hpp"

namespace grit {

/// Each rank owns consecutive chunks, which are close in space, as bodies are in the order of a space-filling curve.
class Cuts {
 public:
  /// One rank owns all.
  explicit Cuts(std::size_t chunks = 0) : first_{0, chunks} {}
  /// Chunks of about equal weight for each rank. `weights`: of each chunk.
  Cuts(unsigned ranks, std::span<const double> weights) : first_(ranks + 1, weights.size()) {
    double total = 0, before = 0;
    for (const double weight : weights) total += weight;
    unsigned rank = 0;
    first_[0] = 0;
    for (std::size_t chunk = 0; chunk < weights.size(); ++chunk) {
      // A chunk goes to the rank in whose share its middle lies.
      const double share = total > 0 ? (before + 0.5 * weights[chunk]) / total
                                     : (static_cast<double>(chunk) + 0.5) / static_cast<double>(weights.size());
      while (rank + 1 < ranks && share * ranks >= rank + 1) first_[++rank] = chunk;
      before += weights[chunk];
    }
  }

  unsigned ranks() const { return static_cast<unsigned>(first_.size() - 1); }
  std::size_t chunks() const { return first_.back(); }
  /// The last rank takes what is added, or loses what is removed, until chunks are divided again.
  void resize(std::size_t chunks) {
    for (std::size_t& first : first_) first = std::min(first, chunks);
    first_.back() = chunks;
  }
  std::size_t first(unsigned rank) const { return first_[rank]; }
  std::size_t last(unsigned rank) const { return first_[rank + 1]; }
  bool owns(unsigned rank, std::size_t chunk) const { return chunk >= first(rank) && chunk < last(rank); }
  unsigned owner(std::size_t chunk) const {
    return static_cast<unsigned>(std::upper_bound(first_.begin(), first_.end() - 1, chunk) - first_.begin()) - 1;
  }
  unsigned owner_of_body(std::size_t body) const { return owner(body / chunk_bodies); }

 private:
  std::vector<std::size_t> first_;  // by rank, and the number of chunks
};

}  // namespace grit
