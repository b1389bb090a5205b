// Lanes: what a contact law computes with. `double` in the reference twin, the machine's widest SIMD type in the loop.
// Lanes have to stay in registers, so that all functions on them are inlined by force: compilers were seen to leave
// calls in a loop as large as a law, which pass lanes through memory and cost a factor of three.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <experimental/simd>

#include "grit/contact/batch.hpp"
#include "grit/vec.hpp"

namespace grit {

namespace stdx = std::experimental;

/// As many doubles as a register holds.
using Lane = stdx::native_simd<double>;

template <class L>
struct LaneTraits {
  static constexpr std::size_t width = L::size();
  using Mask = typename L::mask_type;
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
template <class T, class Abi>
[[gnu::always_inline]] inline stdx::simd<T, Abi> select(const stdx::simd_mask<T, Abi>& condition,
                                                        stdx::simd<T, Abi> yes, const stdx::simd<T, Abi>& no) {
  stdx::where(!condition, yes) = no;
  return yes;
}
template <class L>
[[gnu::always_inline]] inline Vec<L> select(const typename LaneTraits<L>::Mask& condition, const Vec<L>& yes,
                                            const Vec<L>& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}

// For SIMD lanes the standard library has these already, found by their argument.
[[gnu::always_inline]] inline double sqrt(double a) { return std::sqrt(a); }
[[gnu::always_inline]] inline double abs(double a) { return std::abs(a); }
[[gnu::always_inline]] inline double min(double a, double b) { return b < a ? b : a; }
[[gnu::always_inline]] inline double max(double a, double b) { return a < b ? b : a; }

namespace detail {

[[gnu::always_inline]] inline std::uint32_t bits(bool mask) { return mask; }
template <class T, class Abi>
[[gnu::always_inline]] inline std::uint32_t bits(const stdx::simd_mask<T, Abi>& mask) {
  return static_cast<std::uint32_t>(mask.__to_bitset().to_ulong());
}

[[gnu::always_inline]] inline void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Quad cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5), b = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7), d = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
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
  if constexpr (width == 1) {
    const Row& row = base[index(0)];
    return {row.x, row.y, row.z, row.w};
  } else if constexpr (width % 4 == 0) {
    constexpr std::size_t quads = width / 4;
    struct Column {
      Quad quad[quads];
    };
    Column x, y, z, w;
    for (std::size_t q = 0; q < quads; ++q) {
      Quad r0 = load(base[index(4 * q)]);
      Quad r1 = load(base[index(4 * q + 1)]);
      Quad r2 = load(base[index(4 * q + 2)]);
      Quad r3 = load(base[index(4 * q + 3)]);
      detail::transpose(r0, r1, r2, r3);
      x.quad[q] = r0, y.quad[q] = r1, z.quad[q] = r2, w.quad[q] = r3;
    }
    return {std::bit_cast<L>(x), std::bit_cast<L>(y), std::bit_cast<L>(z), std::bit_cast<L>(w)};
  } else {
    const auto column = [&](double Row::*member) { return L([&](auto k) { return base[index(k)].*member; }); };
    return {column(&Row::x), column(&Row::y), column(&Row::z), column(&Row::w)};
  }
}

/// The reverse of load_rows: hands the numbers of row k to `store(k, quad)`.
template <class L, class Store>
[[gnu::always_inline]] inline void store_rows(const L& x, const L& y, const L& z, const L& w, Store store) {
  constexpr std::size_t width = lane_width<L>;
  if constexpr (width == 1) {
    store(0, Quad{x, y, z, w});
  } else if constexpr (width % 4 == 0) {
    constexpr std::size_t quads = width / 4;
    struct Column {
      Quad quad[quads];
    };
    const Column cx = std::bit_cast<Column>(x), cy = std::bit_cast<Column>(y), cz = std::bit_cast<Column>(z),
                 cw = std::bit_cast<Column>(w);
    for (std::size_t q = 0; q < quads; ++q) {
      Quad r0 = cx.quad[q], r1 = cy.quad[q], r2 = cz.quad[q], r3 = cw.quad[q];
      detail::transpose(r0, r1, r2, r3);
      store(4 * q, r0), store(4 * q + 1, r1), store(4 * q + 2, r2), store(4 * q + 3, r3);
    }
  } else {
    for (std::size_t k = 0; k < width; ++k) store(k, Quad{x[k], y[k], z[k], w[k]});
  }
}

}  // namespace grit
