#include "bodies/random.hpp"

#include <bit>

#include "bodies/normal.hpp"

namespace grit {

std::uint64_t split_mix(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

Random::Random(std::uint64_t seed) {
  for (auto& word : state_) word = split_mix(seed);
}

std::uint64_t Random::bits() {
  auto& [a, b, c, d] = state_;
  const std::uint64_t result = std::rotl(b * 5, 7) * 9, shifted = b << 17;
  c ^= a, d ^= b, b ^= c, a ^= d, c ^= shifted;
  d = std::rotl(d, 45);
  return result;
}

std::uint64_t Random::below(std::uint64_t n) {
  __extension__ using Wide = unsigned __int128;
  Wide product = Wide{bits()} * n;
  if (static_cast<std::uint64_t>(product) < n) {
    const std::uint64_t excess = -n % n;  // 2^64 mod n
    while (static_cast<std::uint64_t>(product) < excess) product = Wide{bits()} * n;
  }
  return static_cast<std::uint64_t>(product >> 64);
}

double Random::normal() {
  // The half excludes 0 and 1; 52 bits and a half are exact.
  return normal_quantile((static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52);
}

}  // namespace grit
