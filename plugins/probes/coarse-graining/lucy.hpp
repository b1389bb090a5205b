// Lucy's kernel and its integral along a line.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grit/vec.hpp"

namespace grit {

/// φ(r) = 105 / (16 π c³) · (1 + 3 r/c) (1 − r/c)³ for r < c, 0 beyond: its integral over space is 1 (Lucy 1977,
/// doi:10.1086/112164).
class Lucy {
 public:
  explicit Lucy(double cutoff) : cutoff_(cutoff), scale_(105 / (16 * std::numbers::pi * cutoff * cutoff * cutoff)) {}

  double cutoff() const { return cutoff_; }  ///< c [m]

  /// At a distance from the middle [1/m³].
  double operator()(double r) const {
    const double q = r / cutoff_;
    return q < 1 ? scale_ * (1 + 3 * q) * (1 - q) * (1 - q) * (1 - q) : 0;
  }

  /// ∫ φ(|point − s way|) ds over 0 < s < 1, exact up to round-off, which counts c / |way| times [1/m³].
  double along(const Vec3& point, const Vec3& way) const {
    const double length = way.norm();
    if (length == 0) return (*this)(point.norm());
    const Vec3 direction = way / length;
    const double nearest = point.dot(direction);  // where the line passes the point, along it
    const double off2 = (point - nearest * direction).squaredNorm(), inside2 = cutoff_ * cutoff_ - off2;
    if (!(inside2 > 0)) return 0;
    const double half = std::sqrt(inside2);
    const double from = std::max(-nearest, -half), to = std::min(length - nearest, half);
    return to > from ? (integral(to, off2) - integral(from, off2)) / length : 0;
  }

 private:
  /// Of φ over 0 … u along a line that passes the middle at the distance √off2, all in m.
  double integral(double u, double off2) const {
    const double r2 = off2 + u * u, r = std::sqrt(r2), off = std::sqrt(off2), c2 = cutoff_ * cutoff_;
    const double second = u * (off2 + u * u / 3), fourth = u * (off2 * off2 + u * u * (2 * off2 / 3 + u * u / 5));
    const double third = u * r * (2 * r2 + 3 * off2) / 8 + (off > 0 ? 3 * off2 * off2 / 8 * std::asinh(u / off) : 0);
    return scale_ * (u - 6 * second / c2 + 8 * third / (c2 * cutoff_) - 3 * fourth / (c2 * c2));
  }

  double cutoff_, scale_;
};

}  // namespace grit
