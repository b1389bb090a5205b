// Lanes: what a contact law computes with. `double` in the reference twin, a register full of doubles in the loop.
// Lanes have to stay in registers, so that all functions on them are inlined by force: compilers were seen to leave
// calls in a loop as large as a law, which pass lanes through memory and cost a factor of three.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "grit/contact/batch.hpp"
#include "grit/vec.hpp"

namespace grit {

namespace detail {
template <class T, std::size_t Bytes>
struct Register {
  using type [[gnu::vector_size(Bytes)]] = T;
};
}  // namespace detail

/// N doubles that are worked on together, a power of two. The compiler's own vector type inside: wrapped any deeper, as
/// std::experimental::simd has it, it was seen to be copied through memory.
template <std::size_t N>
struct Pack {
  using Numbers = typename detail::Register<double, N * sizeof(double)>::type;
  using Bits = typename detail::Register<long long, N * sizeof(double)>::type;

  /// All bits of a lane set, or none.
  struct Mask {
    Bits bits;
    [[gnu::always_inline]] friend Mask operator!(const Mask& m) { return {~m.bits}; }
    [[gnu::always_inline]] friend Mask operator&&(const Mask& a, const Mask& b) { return {a.bits & b.bits}; }
    [[gnu::always_inline]] friend Mask operator||(const Mask& a, const Mask& b) { return {a.bits | b.bits}; }
  };

  Numbers numbers;

  Pack() = default;
  [[gnu::always_inline]] Pack(double all) : numbers(all - Numbers{}) {}  // x - 0 is x, and folds away
  [[gnu::always_inline]] explicit Pack(Numbers all) : numbers(all) {}
  /// Lane k is number(k).
  template <class Number>
  requires requires(Number number) { number(std::size_t{}); }
  [[gnu::always_inline]] explicit Pack(Number number) {
    for (std::size_t k = 0; k < N; ++k) numbers[k] = number(k);
  }

  static constexpr std::size_t size() { return N; }
  [[gnu::always_inline]] double operator[](std::size_t k) const { return numbers[k]; }

  [[gnu::always_inline]] friend Pack operator-(const Pack& a) { return Pack(-a.numbers); }
  [[gnu::always_inline]] friend Pack operator+(const Pack& a, const Pack& b) { return Pack(a.numbers + b.numbers); }
  [[gnu::always_inline]] friend Pack operator-(const Pack& a, const Pack& b) { return Pack(a.numbers - b.numbers); }
  [[gnu::always_inline]] friend Pack operator*(const Pack& a, const Pack& b) { return Pack(a.numbers * b.numbers); }
  [[gnu::always_inline]] friend Pack operator/(const Pack& a, const Pack& b) { return Pack(a.numbers / b.numbers); }
  [[gnu::always_inline]] friend Mask operator<(const Pack& a, const Pack& b) { return {a.numbers < b.numbers}; }
  [[gnu::always_inline]] friend Mask operator>(const Pack& a, const Pack& b) { return {a.numbers > b.numbers}; }
  [[gnu::always_inline]] friend Mask operator<=(const Pack& a, const Pack& b) { return {a.numbers <= b.numbers}; }
  [[gnu::always_inline]] friend Mask operator>=(const Pack& a, const Pack& b) { return {a.numbers >= b.numbers}; }
  [[gnu::always_inline]] friend Mask operator==(const Pack& a, const Pack& b) { return {a.numbers == b.numbers}; }
};

/// As many doubles as a register holds.
#if defined(__AVX512F__)
using Lane = Pack<8>;
#elif defined(__AVX__)
using Lane = Pack<4>;
#else
using Lane = Pack<2>;
#endif

template <class L>
struct LaneTraits {
  static constexpr std::size_t width = L::size();
  using Mask = typename L::Mask;
};
template <>
struct LaneTraits<double> {
  static constexpr std::size_t width = 1;
  using Mask = bool;
};
template <class L>
inline constexpr std::size_t lane_width = LaneTraits<L>::width;

static_assert(block_size % lane_width<Lane> == 0);

// The branch of a law. Both sides are evaluated.
[[gnu::always_inline]] inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
template <std::size_t N>
[[gnu::always_inline]] inline Pack<N> select(const typename LaneTraits<Pack<N>>::Mask& condition, const Pack<N>& yes,
                                             const Pack<N>& no) {
  return Pack<N>(condition.bits ? yes.numbers : no.numbers);
}
template <class L>
[[gnu::always_inline]] inline Vec<L> select(const typename LaneTraits<L>::Mask& condition, const Vec<L>& yes,
                                            const Vec<L>& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}

[[gnu::always_inline]] inline double sqrt(double a) { return std::sqrt(a); }
[[gnu::always_inline]] inline double abs(double a) { return std::abs(a); }
[[gnu::always_inline]] inline double min(double a, double b) { return b < a ? b : a; }
[[gnu::always_inline]] inline double max(double a, double b) { return a < b ? b : a; }

template <std::size_t N>
[[gnu::always_inline]] inline Pack<N> sqrt(const Pack<N>& a) {
#if defined(__AVX512F__)
  if constexpr (N == 8) return Pack<N>(_mm512_sqrt_pd(a.numbers));
#endif
#if defined(__AVX__)
  if constexpr (N == 4) return Pack<N>(_mm256_sqrt_pd(a.numbers));
#endif
#if defined(__SSE2__)
  if constexpr (N == 2) return Pack<N>(_mm_sqrt_pd(a.numbers));
#endif
  return Pack<N>([&](std::size_t k) { return std::sqrt(a.numbers[k]); });
}
template <std::size_t N>
[[gnu::always_inline]] inline Pack<N> abs(const Pack<N>& a) {
  using Bits = typename Pack<N>::Bits;
  return Pack<N>((typename Pack<N>::Numbers)((Bits)a.numbers & (0x7fffffffffffffff - Bits{})));
}
template <std::size_t N>
[[gnu::always_inline]] inline Pack<N> min(const Pack<N>& a, const Pack<N>& b) {
#if defined(__AVX512F__)
  if constexpr (N == 8) return Pack<N>(_mm512_min_pd(b.numbers, a.numbers));
#endif
#if defined(__AVX__)
  if constexpr (N == 4) return Pack<N>(_mm256_min_pd(b.numbers, a.numbers));
#endif
#if defined(__SSE2__)
  if constexpr (N == 2) return Pack<N>(_mm_min_pd(b.numbers, a.numbers));
#endif
  return Pack<N>(b.numbers < a.numbers ? b.numbers : a.numbers);
}
template <std::size_t N>
[[gnu::always_inline]] inline Pack<N> max(const Pack<N>& a, const Pack<N>& b) {
#if defined(__AVX512F__)
  if constexpr (N == 8) return Pack<N>(_mm512_max_pd(b.numbers, a.numbers));
#endif
#if defined(__AVX__)
  if constexpr (N == 4) return Pack<N>(_mm256_max_pd(b.numbers, a.numbers));
#endif
#if defined(__SSE2__)
  if constexpr (N == 2) return Pack<N>(_mm_max_pd(b.numbers, a.numbers));
#endif
  return Pack<N>(a.numbers < b.numbers ? b.numbers : a.numbers);
}

namespace detail {

[[gnu::always_inline]] inline std::uint32_t bits(bool mask) { return mask; }
template <class Mask>
[[gnu::always_inline]] inline std::uint32_t bits(const Mask& mask) {
  constexpr std::size_t width = sizeof mask.bits / sizeof(long long);
#if defined(__AVX512DQ__)
  if constexpr (width == 8) return _mm512_movepi64_mask((__m512i)mask.bits);
#endif
#if defined(__AVX__)
  if constexpr (width == 4) return static_cast<std::uint32_t>(_mm256_movemask_pd((__m256d)mask.bits));
#endif
#if defined(__SSE2__)
  if constexpr (width == 2) return static_cast<std::uint32_t>(_mm_movemask_pd((__m128d)mask.bits));
#endif
  std::uint32_t set = 0;
  for (std::size_t k = 0; k < width; ++k) set |= (mask.bits[k] != 0 ? 1u : 0u) << k;
  return set;
}

[[gnu::always_inline]] inline void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Quad cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5), b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7), d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
}

template <class L>
[[gnu::always_inline]] inline L load_lanes(const double* from) {
  if constexpr (lane_width<L> == 1) return *from;
  else {
    typename L::Numbers numbers;
    std::memcpy(&numbers, from, sizeof numbers);
    return L(numbers);
  }
}
template <class L>
[[gnu::always_inline]] inline void store_lanes(const L& value, double* to) {
  std::memcpy(to, &value, sizeof value);
}

/// Lane k is number(k).
template <class L, class Number>
[[gnu::always_inline]] inline L gather_lanes(Number number) {
  if constexpr (lane_width<L> == 1) return number(0);
  else return L([&](std::size_t k) { return number(k); });
}
[[gnu::always_inline]] inline double lane(double number, std::size_t) { return number; }
template <std::size_t N>
[[gnu::always_inline]] inline double lane(const Pack<N>& pack, std::size_t k) {
  return pack[k];
}
[[gnu::always_inline]] inline double largest(double lane) { return lane; }
template <std::size_t N>
[[gnu::always_inline]] inline double largest(const Pack<N>& lanes) {
  Pack<N> most = lanes;
  for (std::size_t step = N / 2; step > 0; step /= 2)
    most = max(most, Pack<N>([&](std::size_t k) { return most[(k + step) % N]; }));
  return most[0];
}

[[gnu::always_inline]] inline double smallest(double lane) { return lane; }
template <std::size_t N>
[[gnu::always_inline]] inline double smallest(const Pack<N>& lanes) {
  return -largest(-lanes);
}

}  // namespace detail

/// Four lanes, one a component.
template <class L>
struct RowLanes {
  L x, y, z, w;
  [[gnu::always_inline]] Vec<L> xyz() const { return {x, y, z}; }
};

/// Loads the rows `base[index(k)]`, k = 0 … width − 1, one a lane.
template <class L, class Index>
[[gnu::always_inline]] inline RowLanes<L> load_rows(const Row* base, Index index) {
  constexpr std::size_t width = lane_width<L>;
  const auto quads = [&](std::size_t first) {
    struct Columns {
      Quad x, y, z, w;
    } rows{load(base[index(first)]), load(base[index(first + 1)]), load(base[index(first + 2)]),
           load(base[index(first + 3)])};
    detail::transpose(rows.x, rows.y, rows.z, rows.w);
    return rows;
  };
  if constexpr (width == 1) {
    const Row& row = base[index(0)];
    return {row.x, row.y, row.z, row.w};
  } else if constexpr (width == 4) {
    const auto q = quads(0);
    return {L(q.x), L(q.y), L(q.z), L(q.w)};
  } else if constexpr (width == 8) {
    const auto p = quads(0), q = quads(4);
    const auto join = [](const Quad& low, const Quad& high) {
      return L(typename L::Numbers(__builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7)));
    };
    return {join(p.x, q.x), join(p.y, q.y), join(p.z, q.z), join(p.w, q.w)};
  } else {
    const auto column = [&](double Row::*member) { return L([&](std::size_t k) { return base[index(k)].*member; }); };
    return {column(&Row::x), column(&Row::y), column(&Row::z), column(&Row::w)};
  }
}

/// The reverse of load_rows: hands the numbers of row k to `store(k, quad)`.
template <class L, class Store>
[[gnu::always_inline]] inline void store_rows(const L& x, const L& y, const L& z, const L& w, Store store) {
  constexpr std::size_t width = lane_width<L>;
  const auto four = [&](std::size_t first, Quad r0, Quad r1, Quad r2, Quad r3) {
    detail::transpose(r0, r1, r2, r3);
    store(first, r0), store(first + 1, r1), store(first + 2, r2), store(first + 3, r3);
  };
  if constexpr (width == 1) {
    store(0, Quad{x, y, z, w});
  } else if constexpr (width == 4) {
    four(0, x.numbers, y.numbers, z.numbers, w.numbers);
  } else if constexpr (width == 8) {
    const auto low = [](const L& a) { return Quad(__builtin_shufflevector(a.numbers, a.numbers, 0, 1, 2, 3)); };
    const auto high = [](const L& a) { return Quad(__builtin_shufflevector(a.numbers, a.numbers, 4, 5, 6, 7)); };
    four(0, low(x), low(y), low(z), low(w));
    four(4, high(x), high(y), high(z), high(w));
  } else {
    for (std::size_t k = 0; k < width; ++k) store(k, Quad{x[k], y[k], z[k], w[k]});
  }
}

}  // namespace grit
