// Indices of fewer bits than a count may need.
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <string>

#include "grit/error.hpp"

namespace grit {

/// `index` in the bits of `To`. Throws Error, naming `what` ("materials of bodies"), for one that does not fit.
template <std::unsigned_integral To>
To narrow_index(std::size_t index, const char* what) {
  constexpr std::size_t most = std::numeric_limits<To>::max();
  if (index > most)
    throw Error("found " + std::string(what) + " with the index " + std::to_string(index) + "; allowed are up to " +
                std::to_string(most + 1) + " of them");
  return static_cast<To>(index);
}

}  // namespace grit
