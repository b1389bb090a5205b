// Random numbers, identical on every machine for a given seed.
#pragma once

#include <array>
#include <cstdint>
#include <ranges>
#include <utility>

namespace grit {

/// The generator xoshiro256** 1.0 of D. Blackman and S. Vigna, "Scrambled linear pseudorandom number generators", ACM
/// Trans. Math. Software 47 (2021) 36, doi:10.1145/3460772. Period 2^256 − 1.
class Random {
 public:
  /// State filled by splitmix64 (G. Steele, D. Lea, C. Flood, OOPSLA 2014, doi:10.1145/2660193.2660195), as its authors
  /// recommend; all seeds are equally good.
  explicit Random(std::uint64_t seed);
  /// Not all zero.
  explicit Random(const std::array<std::uint64_t, 4>& state) : state_(state) {}

  std::uint64_t bits();
  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// Uniform in 0 … n − 1; n > 0. D. Lemire, ACM Trans. Model. Comput. Simul. 29 (2019) 3,
  /// doi:10.1145/3230636.
  std::uint64_t below(std::uint64_t n);
  /// Standard normal, by inversion; within ±8.3.
  double normal();

  /// Whether the state is not all zero, from which all numbers would be zero.
  bool is_valid() const { return state_ != std::array<std::uint64_t, 4>{}; }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(state_);
  }

  /// Shuffles items; all orders are equally likely.
  template <std::ranges::random_access_range Items>
  void shuffle(Items& items) {
    using std::swap;
    for (std::size_t left = std::ranges::size(items); left > 1; --left) swap(items[left - 1], items[below(left)]);
  }

 private:
  std::array<std::uint64_t, 4> state_;
};

/// The next number of splitmix64; `state` is its seed at first.
std::uint64_t split_mix(std::uint64_t& state);

}  // namespace grit
