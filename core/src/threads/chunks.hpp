// Chunks of bodies: the units of work of threads.
#pragma once

#include <algorithm>
#include <cstddef>

namespace grit {

/// Number of bodies in a chunk. Passes over bodies and contacts go chunk by chunk, for any number of threads.
inline constexpr std::size_t chunk_bodies = 256;
inline std::size_t chunks_of(std::size_t bodies) { return (bodies + chunk_bodies - 1) / chunk_bodies; }

/// First body of a chunk, and one past its last.
struct ChunkRange {
  std::size_t first, last;
  ChunkRange(std::size_t chunk, std::size_t count)
      : first(std::min(count, chunk * chunk_bodies)), last(std::min(count, first + chunk_bodies)) {}
};

}  // namespace grit
