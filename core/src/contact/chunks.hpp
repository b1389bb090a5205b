// Chunks of bodies, the portions in which threads take work.
#pragma once

#include <cstddef>

namespace grit {

/// Bodies of one chunk; passes over bodies and their contacts go chunk by chunk, whatever the number of threads.
inline constexpr std::size_t chunk_bodies = 256;
inline std::size_t chunks_of(std::size_t bodies) { return (bodies + chunk_bodies - 1) / chunk_bodies; }

}  // namespace grit
