// Lanes: the numbers that a contact law computes with. A lane is one number in the scalar reference and a SIMD register
// in the contact loop; doubles, or floats in single precision.
// Lanes must stay in registers. Therefore all functions on them are always_inline: compilers otherwise left calls in
// the loop of a law, which pass lanes through memory; this was measured to cost a factor of three.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
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

/// A register of N numbers, N a power of two. It holds the vector type of the compiler directly: wrapped any deeper, as
/// in std::experimental::simd, the compiler copied it through memory.
template <std::size_t N, class Real = double>
struct Pack {
  using Numbers = typename detail::Register<Real, N * sizeof(Real)>::type;
  using Bit = std::conditional_t<sizeof(Real) == sizeof(int), int, long long>;
  using Bits = typename detail::Register<Bit, N * sizeof(Real)>::type;

  /// All bits of a lane set, or none.
  struct Mask {
    Bits bits;
    [[gnu::always_inline]] constexpr friend Mask operator!(const Mask& m) { return {~m.bits}; }
    [[gnu::always_inline]] constexpr friend Mask operator&&(const Mask& a, const Mask& b) { return {a.bits & b.bits}; }
    [[gnu::always_inline]] constexpr friend Mask operator||(const Mask& a, const Mask& b) { return {a.bits | b.bits}; }
  };

  Numbers numbers;

  Pack() = default;
  [[gnu::always_inline]] constexpr Pack(double all)
      : numbers(static_cast<Real>(all) - Numbers{}) {}  // x - 0 broadcasts x and is optimised away
  [[gnu::always_inline]] constexpr explicit Pack(Numbers all) : numbers(all) {}
  /// Lane k is number(k).
  template <class Number>
  requires requires(Number number) { number(std::size_t{}); }
  [[gnu::always_inline]] constexpr explicit Pack(Number number) {
    for (std::size_t k = 0; k < N; ++k) numbers[k] = static_cast<Real>(number(k));
  }

  static constexpr std::size_t size() { return N; }
  [[gnu::always_inline]] constexpr Real operator[](std::size_t k) const { return numbers[k]; }

  [[gnu::always_inline]] constexpr friend Pack operator-(const Pack& a) { return Pack(-a.numbers); }
  [[gnu::always_inline]] constexpr friend Pack operator+(const Pack& a, const Pack& b) {
    return Pack(a.numbers + b.numbers);
  }
  [[gnu::always_inline]] constexpr friend Pack operator-(const Pack& a, const Pack& b) {
    return Pack(a.numbers - b.numbers);
  }
  [[gnu::always_inline]] constexpr friend Pack operator*(const Pack& a, const Pack& b) {
    return Pack(a.numbers * b.numbers);
  }
  [[gnu::always_inline]] constexpr friend Pack operator/(const Pack& a, const Pack& b) {
    return Pack(a.numbers / b.numbers);
  }
  [[gnu::always_inline]] constexpr friend Mask operator<(const Pack& a, const Pack& b) {
    return {a.numbers < b.numbers};
  }
  [[gnu::always_inline]] constexpr friend Mask operator>(const Pack& a, const Pack& b) {
    return {a.numbers > b.numbers};
  }
  [[gnu::always_inline]] constexpr friend Mask operator<=(const Pack& a, const Pack& b) {
    return {a.numbers <= b.numbers};
  }
  [[gnu::always_inline]] constexpr friend Mask operator>=(const Pack& a, const Pack& b) {
    return {a.numbers >= b.numbers};
  }
  [[gnu::always_inline]] constexpr friend Mask operator==(const Pack& a, const Pack& b) {
    return {a.numbers == b.numbers};
  }
};

/// As many doubles as a register holds.
#if defined(__AVX512F__)
using Lane = Pack<8>;
#elif defined(__AVX__)
using Lane = Pack<4>;
#else
using Lane = Pack<2>;
#endif
/// The same in single precision, but at most block_size.
#if defined(__AVX__)
using SingleLane = Pack<8, float>;
#else
using SingleLane = Pack<4, float>;
#endif

template <class L>
struct LaneTraits;
/// Of a register.
template <std::size_t N, class Real>
struct LaneTraits<Pack<N, Real>> {
  static constexpr std::size_t width = N;
  using Number = Real;
  using Mask = typename Pack<N, Real>::Mask;
  using Wide = Pack<N, double>;
};
/// Of a single number.
template <class Real>
requires std::is_floating_point_v<Real>
struct LaneTraits<Real> {
  static constexpr std::size_t width = 1;
  using Number = Real;
  using Mask = bool;
  using Wide = double;
};
template <class L>
inline constexpr std::size_t lane_width = LaneTraits<L>::width;
/// The same number of lanes in double precision.
template <class L>
using Wide = typename LaneTraits<L>::Wide;
template <class L>
inline constexpr bool is_single = std::is_same_v<typename LaneTraits<L>::Number, float>;

/// Lower limit of divisors, in place of zero: smaller than any force, length, stiffness or inverse mass of a run.
template <class L>
inline constexpr double tiny = is_single<L> ? 1e-30 : 1e-300;
/// Relative difference well above the rounding error of some tens of operations.
template <class L>
inline constexpr double beyond_rounding = is_single<L> ? 1e-5 : 1e-12;

static_assert(block_size % lane_width<Lane> == 0 && block_size % lane_width<SingleLane> == 0);

// Branch of a law, lane by lane. Both sides are evaluated.
[[gnu::always_inline]] constexpr double select(bool condition, double yes, double no) { return condition ? yes : no; }
[[gnu::always_inline]] constexpr float select(bool condition, float yes, float no) { return condition ? yes : no; }
template <std::size_t N, class Real>
[[gnu::always_inline]] constexpr Pack<N, Real> select(const typename LaneTraits<Pack<N, Real>>::Mask& condition,
                                                      const Pack<N, Real>& yes, const Pack<N, Real>& no) {
  return Pack<N, Real>(condition.bits ? yes.numbers : no.numbers);
}
template <class L>
[[gnu::always_inline]] constexpr Vec<L> select(const typename LaneTraits<L>::Mask& condition, const Vec<L>& yes,
                                               const Vec<L>& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}

[[gnu::always_inline]] constexpr double sqrt(double a) { return std::sqrt(a); }
[[gnu::always_inline]] constexpr double abs(double a) { return std::abs(a); }
[[gnu::always_inline]] constexpr double min(double a, double b) { return b < a ? b : a; }
[[gnu::always_inline]] constexpr double max(double a, double b) { return a < b ? b : a; }
[[gnu::always_inline]] constexpr float sqrt(float a) { return std::sqrt(a); }
[[gnu::always_inline]] constexpr float abs(float a) { return std::abs(a); }
[[gnu::always_inline]] constexpr float min(float a, float b) { return b < a ? b : a; }
[[gnu::always_inline]] constexpr float max(float a, float b) { return a < b ? b : a; }

template <std::size_t N, class Real>
[[gnu::always_inline]] constexpr Pack<N, Real> sqrt(const Pack<N, Real>& a) {
  using P = Pack<N, Real>;
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<P, Pack<8>>) return P(_mm512_sqrt_pd(a.numbers));
  if constexpr (std::is_same_v<P, Pack<16, float>>) return P(_mm512_sqrt_ps(a.numbers));
#endif
#if defined(__AVX__)
  if constexpr (std::is_same_v<P, Pack<4>>) return P(_mm256_sqrt_pd(a.numbers));
  if constexpr (std::is_same_v<P, Pack<8, float>>) return P(_mm256_sqrt_ps(a.numbers));
#endif
#if defined(__SSE2__)
  if constexpr (std::is_same_v<P, Pack<2>>) return P(_mm_sqrt_pd(a.numbers));
  if constexpr (std::is_same_v<P, Pack<4, float>>) return P(_mm_sqrt_ps(a.numbers));
#endif
  return P([&](std::size_t k) { return std::sqrt(a.numbers[k]); });
}
template <std::size_t N, class Real>
[[gnu::always_inline]] constexpr Pack<N, Real> abs(const Pack<N, Real>& a) {
  using Bits = typename Pack<N, Real>::Bits;
  constexpr auto all_but_sign = std::numeric_limits<typename Pack<N, Real>::Bit>::max();
  return Pack<N, Real>((typename Pack<N, Real>::Numbers)((Bits)a.numbers & (all_but_sign - Bits{})));
}
template <std::size_t N, class Real>
[[gnu::always_inline]] constexpr Pack<N, Real> min(const Pack<N, Real>& a, const Pack<N, Real>& b) {
  using P = Pack<N, Real>;
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<P, Pack<8>>) return P(_mm512_min_pd(b.numbers, a.numbers));
#endif
#if defined(__AVX__)
  if constexpr (std::is_same_v<P, Pack<4>>) return P(_mm256_min_pd(b.numbers, a.numbers));
  if constexpr (std::is_same_v<P, Pack<8, float>>) return P(_mm256_min_ps(b.numbers, a.numbers));
#endif
#if defined(__SSE2__)
  if constexpr (std::is_same_v<P, Pack<2>>) return P(_mm_min_pd(b.numbers, a.numbers));
  if constexpr (std::is_same_v<P, Pack<4, float>>) return P(_mm_min_ps(b.numbers, a.numbers));
#endif
  return P(b.numbers < a.numbers ? b.numbers : a.numbers);
}
template <std::size_t N, class Real>
[[gnu::always_inline]] constexpr Pack<N, Real> max(const Pack<N, Real>& a, const Pack<N, Real>& b) {
  using P = Pack<N, Real>;
#if defined(__AVX512F__)
  if constexpr (std::is_same_v<P, Pack<8>>) return P(_mm512_max_pd(b.numbers, a.numbers));
#endif
#if defined(__AVX__)
  if constexpr (std::is_same_v<P, Pack<4>>) return P(_mm256_max_pd(b.numbers, a.numbers));
  if constexpr (std::is_same_v<P, Pack<8, float>>) return P(_mm256_max_ps(b.numbers, a.numbers));
#endif
#if defined(__SSE2__)
  if constexpr (std::is_same_v<P, Pack<2>>) return P(_mm_max_pd(b.numbers, a.numbers));
  if constexpr (std::is_same_v<P, Pack<4, float>>) return P(_mm_max_ps(b.numbers, a.numbers));
#endif
  return P(a.numbers < b.numbers ? b.numbers : a.numbers);
}

/// a b + c, fused where the processor can. Use it only for energies: sums of products in forces are rounded term by
/// term.
[[gnu::always_inline]] constexpr double multiply_add(double a, double b, double c) { return a * b + c; }
[[gnu::always_inline]] constexpr float multiply_add(float a, float b, float c) { return a * b + c; }
template <std::size_t N, class Real>
[[gnu::always_inline]] constexpr Pack<N, Real> multiply_add(const Pack<N, Real>& a, const Pack<N, Real>& b,
                                                            const Pack<N, Real>& c) {
  return Pack<N, Real>(a.numbers * b.numbers + c.numbers);
}

/// The same lanes in the precision of L, rounded to nearest if that is lower.
template <class L>
[[gnu::always_inline]] constexpr L in_precision(const Wide<L>& lanes) {
  if constexpr (std::is_same_v<L, Wide<L>>) return lanes;
  else if constexpr (lane_width<L> == 1) return static_cast<L>(lanes);
  else return L(__builtin_convertvector(lanes.numbers, typename L::Numbers));
}
template <class L>
[[gnu::always_inline]] constexpr Vec<L> in_precision(const Vec<Wide<L>>& v) {
  return {in_precision<L>(v.x), in_precision<L>(v.y), in_precision<L>(v.z)};
}
template <class L>
[[gnu::always_inline]] constexpr auto mask_in_precision(const typename LaneTraits<Wide<L>>::Mask& mask) {
  if constexpr (std::is_same_v<L, Wide<L>> || lane_width<L> == 1) return mask;
  else return typename L::Mask{__builtin_convertvector(mask.bits, typename L::Bits)};
}
/// The same lanes in double precision, exactly.
template <class L>
[[gnu::always_inline]] constexpr Wide<L> widened(const L& lanes) {
  if constexpr (std::is_same_v<L, Wide<L>> || lane_width<L> == 1) return lanes;
  else return Wide<L>(__builtin_convertvector(lanes.numbers, typename Wide<L>::Numbers));
}

namespace detail {

[[gnu::always_inline]] constexpr std::uint32_t bits(bool mask) { return mask; }
template <class Mask>
[[gnu::always_inline]] constexpr std::uint32_t bits(const Mask& mask) {
  constexpr std::size_t lane_bytes = sizeof mask.bits[0], width = sizeof mask.bits / lane_bytes;
#if defined(__AVX512DQ__)
  if constexpr (lane_bytes == 8 && width == 8) return _mm512_movepi64_mask((__m512i)mask.bits);
  if constexpr (lane_bytes == 4 && width == 16) return _mm512_movepi32_mask((__m512i)mask.bits);
#endif
#if defined(__AVX__)
  if constexpr (lane_bytes == 8 && width == 4)
    return static_cast<std::uint32_t>(_mm256_movemask_pd((__m256d)mask.bits));
  if constexpr (lane_bytes == 4 && width == 8) return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)mask.bits));
#endif
#if defined(__SSE2__)
  if constexpr (lane_bytes == 8 && width == 2) return static_cast<std::uint32_t>(_mm_movemask_pd((__m128d)mask.bits));
  if constexpr (lane_bytes == 4 && width == 4) return static_cast<std::uint32_t>(_mm_movemask_ps((__m128)mask.bits));
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

/// The even, or odd, lanes of two registers of eight numbers, in turn.
template <class Numbers>
[[gnu::always_inline]] constexpr Numbers even_lanes(const Numbers& a, const Numbers& b) {
  return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
}
template <class Numbers>
[[gnu::always_inline]] constexpr Numbers odd_lanes(const Numbers& a, const Numbers& b) {
  return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
}

/// Loads lanes in the precision of L from doubles in memory, and stores them.
template <class L>
[[gnu::always_inline]] constexpr L load_lanes(const double* from) {
  if constexpr (lane_width<L> == 1) return static_cast<L>(*from);
  else {
    typename Wide<L>::Numbers numbers;
    std::memcpy(&numbers, from, sizeof numbers);
    return in_precision<L>(Wide<L>(numbers));
  }
}
template <class L>
[[gnu::always_inline]] constexpr void store_lanes(const L& value, double* to) {
  const Wide<L> wide = widened(value);
  std::memcpy(to, &wide, sizeof wide);
}

/// Lane k is number(k).
template <class L, class Number>
[[gnu::always_inline]] constexpr L gather_lanes(Number number) {
  if constexpr (lane_width<L> == 1) return static_cast<L>(number(0));
  else return L([&](std::size_t k) { return number(k); });
}
template <class L>
[[gnu::always_inline]] constexpr double lane(const L& lanes, std::size_t k) {
  if constexpr (lane_width<L> == 1) return lanes;
  else return lanes[k];
}
template <class L>
[[gnu::always_inline]] constexpr double largest(const L& lanes) {
  if constexpr (lane_width<L> == 1) return lanes;
  else {
    L most = lanes;
    for (std::size_t step = lane_width<L> / 2; step > 0; step /= 2)
      most = max(most, L([&](std::size_t k) { return most[(k + step) % lane_width<L>]; }));
    return most[0];
  }
}
template <class L>
[[gnu::always_inline]] constexpr double total(const L& lanes) {
  if constexpr (lane_width<L> == 1) return lanes;
  else {
    L sum = lanes;
    for (std::size_t step = lane_width<L> / 2; step > 0; step /= 2)
      sum = sum + L([&](std::size_t k) { return sum[(k + step) % lane_width<L>]; });
    return sum[0];
  }
}

template <class L>
[[gnu::always_inline]] constexpr double smallest(const L& lanes) {
  return -largest(L(-lanes));
}

}  // namespace detail

/// Four lanes, one per component of a Row.
template <class L>
struct RowLanes {
  L x, y, z, w;
  [[gnu::always_inline]] constexpr Vec<L> xyz() const { return {x, y, z}; }
};

/// Loads four numbers from each `address(k)`, k = 0 … width − 1, one row per lane.
template <class L, class Address>
[[gnu::always_inline]] constexpr RowLanes<L> load_fours(Address address) {
  constexpr std::size_t width = lane_width<L>;
  const auto load = [&](std::size_t k) {
    Quad quad;
    std::memcpy(&quad, address(k), sizeof quad);
    return quad;
  };
  const auto quads = [&](std::size_t first) {
    struct Columns {
      Quad x, y, z, w;
    } rows{load(first), load(first + 1), load(first + 2), load(first + 3)};
    detail::transpose(rows.x, rows.y, rows.z, rows.w);
    return rows;
  };
  if constexpr (width == 1) {
    const double* const row = address(0);
    return {static_cast<L>(row[0]), static_cast<L>(row[1]), static_cast<L>(row[2]), static_cast<L>(row[3])};
  } else if constexpr (width == 4) {
    const auto q = quads(0);
    return {L(q.x), L(q.y), L(q.z), L(q.w)};
  } else if constexpr (width == 8) {
    // Rows 0 and 2 share a register, so that two shuffles a column, not five, transpose all eight.
    const auto pair = [&](std::size_t k) __attribute__((always_inline)) {
      return __builtin_shufflevector(load(k), load(k + 2), 0, 1, 2, 3, 4, 5, 6, 7);
    };
    const auto r02 = pair(0), r13 = pair(1), r46 = pair(4), r57 = pair(5);
    const auto xz = detail::even_lanes(r02, r13), yw = detail::odd_lanes(r02, r13);
    const auto more_xz = detail::even_lanes(r46, r57), more_yw = detail::odd_lanes(r46, r57);
    using Numbers = typename L::Numbers;
    return {L(Numbers(__builtin_shufflevector(xz, more_xz, 0, 1, 4, 5, 8, 9, 12, 13))),
            L(Numbers(__builtin_shufflevector(yw, more_yw, 0, 1, 4, 5, 8, 9, 12, 13))),
            L(Numbers(__builtin_shufflevector(xz, more_xz, 2, 3, 6, 7, 10, 11, 14, 15))),
            L(Numbers(__builtin_shufflevector(yw, more_yw, 2, 3, 6, 7, 10, 11, 14, 15)))};
  } else {
    const auto column = [&](std::size_t c) { return L([&](std::size_t k) { return address(k)[c]; }); };
    return {column(0), column(1), column(2), column(3)};
  }
}

/// Loads the rows `base[index(k)]`.
template <class L, class Index>
[[gnu::always_inline]] constexpr RowLanes<L> load_rows(const Row* base, Index index) {
  return load_fours<L>([&](std::size_t k) { return &base[index(k)].x; });
}

/// The inverse of load_rows: calls `store(k, quad)` with the numbers of row k.
template <class L, class Store>
[[gnu::always_inline]] constexpr void store_rows(const L& x, const L& y, const L& z, const L& w, Store store) {
  constexpr std::size_t width = lane_width<L>;
  const auto four = [&](std::size_t first, Quad r0, Quad r1, Quad r2, Quad r3) __attribute__((always_inline)) {
    detail::transpose(r0, r1, r2, r3);
    store(first, r0), store(first + 1, r1), store(first + 2, r2), store(first + 3, r3);
  };
  if constexpr (width == 1) {
    store(0, Quad{x, y, z, w});
  } else if constexpr (width == 4) {
    four(0, x.numbers, y.numbers, z.numbers, w.numbers);
  } else if constexpr (width == 8) {
    const auto xy = detail::even_lanes(x.numbers, y.numbers), more_xy = detail::odd_lanes(x.numbers, y.numbers);
    const auto zw = detail::even_lanes(z.numbers, w.numbers), more_zw = detail::odd_lanes(z.numbers, w.numbers);
    const auto four_rows = [&](std::size_t first, auto even, auto odd) __attribute__((always_inline)) {
      store(first, Quad(__builtin_shufflevector(even, even, 0, 1, 2, 3)));
      store(first + 1, Quad(__builtin_shufflevector(odd, odd, 0, 1, 2, 3)));
      store(first + 2, Quad(__builtin_shufflevector(even, even, 4, 5, 6, 7)));
      store(first + 3, Quad(__builtin_shufflevector(odd, odd, 4, 5, 6, 7)));
    };
    four_rows(0, __builtin_shufflevector(xy, zw, 0, 1, 8, 9, 2, 3, 10, 11),
              __builtin_shufflevector(more_xy, more_zw, 0, 1, 8, 9, 2, 3, 10, 11));
    four_rows(4, __builtin_shufflevector(xy, zw, 4, 5, 12, 13, 6, 7, 14, 15),
              __builtin_shufflevector(more_xy, more_zw, 4, 5, 12, 13, 6, 7, 14, 15));
  } else {
    for (std::size_t k = 0; k < width; ++k) store(k, Quad{x[k], y[k], z[k], w[k]});
  }
}

}  // namespace grit
