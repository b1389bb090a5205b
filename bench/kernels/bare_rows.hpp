// Vectors for bare.cpp, independent of grit.
#pragma once

#include <cstddef>

namespace grit::bench {

struct Triple {
  double x, y, z;
};
inline Triple operator+(Triple a, Triple b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Triple operator-(Triple a, Triple b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Triple operator*(double s, Triple a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Triple a, Triple b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Triple cross(Triple a, Triple b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A row of one body or contact, held in a register.
using Four = double __attribute__((vector_size(32)));
inline Triple three(const Four& f) { return {f[0], f[1], f[2]}; }

/// The numbers of `size` rows, in separate arrays.
template <std::size_t size>
struct Columns {
  alignas(64) double x[size], y[size], z[size], w[size];

  Triple at(std::size_t k) const { return {x[k], y[k], z[k]}; }
  void set(std::size_t k, Triple t) { x[k] = t.x, y[k] = t.y, z[k] = t.z; }
  /// Rows k … k + 3, and back.
  void put(std::size_t k, const Four (&rows)[4]) {
    Four columns[4];
    transpose(rows, columns);
    double* const to[4] = {x, y, z, w};
    for (int c = 0; c < 4; ++c) reinterpret_cast<Four&>(to[c][k]) = columns[c];
  }
  void take(std::size_t k, Four (&rows)[4]) const {
    const double* const from[4] = {x, y, z, w};
    Four columns[4];
    for (int c = 0; c < 4; ++c) columns[c] = reinterpret_cast<const Four&>(from[c][k]);
    transpose(columns, rows);
  }
  static void transpose(const Four (&r)[4], Four (&c)[4]) {
    const Four p = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6), q = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
    const Four u = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6), v = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
    c[0] = __builtin_shufflevector(p, u, 0, 1, 4, 5), c[1] = __builtin_shufflevector(q, v, 0, 1, 4, 5);
    c[2] = __builtin_shufflevector(p, u, 2, 3, 6, 7), c[3] = __builtin_shufflevector(q, v, 2, 3, 6, 7);
  }
};

}  // namespace grit::bench
