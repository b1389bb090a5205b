// Numbers of bodies that are computed as real numbers.
#pragma once

#include <algorithm>
#include <cstddef>

namespace grit {

/// Rounded down, and at most 1e15: a description may ask for more bodies than an integer holds.
inline std::size_t whole_count(double bodies) { return static_cast<std::size_t>(std::min(bodies, 1e15)); }

}  // namespace grit
