// Numbers of pixels, or of rays, side by side that are worked on together.
#pragma once

#include <cstring>

#include "grit/contact/lanes.hpp"

namespace grit {

#if defined(__AVX512F__)
inline constexpr std::size_t floats_at_once = 16;
#elif defined(__AVX__)
inline constexpr std::size_t floats_at_once = 8;
#else
inline constexpr std::size_t floats_at_once = 4;
#endif
using Floats = Pack<floats_at_once, float>;
using Ints = Floats::Bits;

inline Floats load(const float* from) {
  Floats lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline void store(const Floats& lanes, float* to) { std::memcpy(to, &lanes, sizeof lanes); }

}  // namespace grit
