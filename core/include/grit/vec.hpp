// Vectors: Vec3 outside the contact loop, Vec<L> of SIMD lanes inside it, Row for four numbers of one body.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error "grit: compile without -ffast-math and its parts: results must have the same bits, and NaN is tested for"
#endif

namespace grit {

/// A signed index, as those of vectors are, as one of an array.
constexpr std::size_t as_index(std::ptrdiff_t index) { return static_cast<std::size_t>(index); }

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
static_assert(sizeof(Vec3) == 3 * sizeof(double) && alignof(Vec3) == alignof(double));

/// Four numbers of one body, such as a vector and a scalar; loaded by one instruction.
struct alignas(32) Row {
  double x = 0, y = 0, z = 0, w = 0;
};

/// The same four numbers in a register. Use load() and store() only: a Row copied as a struct passes through memory
/// number by number, which was measured to double the time of a step.
using Quad = double __attribute__((vector_size(32), may_alias));
[[gnu::always_inline]] inline Quad load(const Row& row) { return reinterpret_cast<const Quad&>(row); }
[[gnu::always_inline]] inline void store(const Quad& quad, Row& row) { reinterpret_cast<Quad&>(row) = quad; }
[[gnu::always_inline]] inline void operator+=(Row& sum, const Quad& q) { store(load(sum) + q, sum); }
[[gnu::always_inline]] inline void operator-=(Row& sum, const Quad& q) { store(load(sum) - q, sum); }
inline void operator+=(Row& sum, const Row& row) { sum += load(row); }

inline Vec3 xyz(const Row& row) { return {row.x, row.y, row.z}; }

/// A vector whose components are lanes: `double` in the scalar reference, a SIMD type in the contact loop.
template <class L>
struct Vec {
  L x, y, z;

  [[gnu::always_inline]] constexpr friend Vec operator+(const Vec& a, const Vec& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[gnu::always_inline]] constexpr friend Vec operator-(const Vec& a, const Vec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[gnu::always_inline]] constexpr friend Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
  [[gnu::always_inline]] constexpr friend Vec operator*(const L& s, const Vec& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
  [[gnu::always_inline]] constexpr friend Vec operator*(const Vec& a, const L& s) {
    return {s * a.x, s * a.y, s * a.z};
  }
};

template <class L>
[[gnu::always_inline]] constexpr L dot(const Vec<L>& a, const Vec<L>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class L>
[[gnu::always_inline]] constexpr Vec<L> cross(const Vec<L>& a, const Vec<L>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace grit
