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

  /// The way from 0 to `way` [m].
  struct Line {
    explicit Line(const Vec3& way) : length(way.norm()), direction(length > 0 ? Vec3(way / length) : Vec3::Zero()) {}
    double length;
    Vec3 direction;  ///< zero where there is no way to go
  };
  /// ∫ φ(|point − s way|) ds over 0 < s < 1, exact up to round-off, which counts c / |way| times [1/m³].
  double along(const Vec3& point, const Line& line) const {
    if (line.length == 0) return (*this)(point.norm());
    const double nearest = point.dot(line.direction);  // where the line passes the point, along it
    const double off2 = (point - nearest * line.direction).squaredNorm(), inside2 = cutoff_ * cutoff_ - off2;
    if (!(inside2 > 0)) return 0;
    const double half = std::sqrt(inside2);
    const double from = std::max(-nearest, -half), to = std::min(line.length - nearest, half);
    return to > from ? integral(from, to, off2) / line.length : 0;
  }
  double along(const Vec3& point, const Vec3& way) const { return along(point, Line(way)); }

 private:
  /// Of φ from one place to another along a line that passes the middle at the distance √off2, all in m.
  double integral(double from, double to, double off2) const {
    const double per = 1 / cutoff_, per2 = per * per, r_from = std::sqrt(off2 + from * from),
                 r_to = std::sqrt(off2 + to * to);
    const auto polynomial = [&](double u, double r) {
      const double u2 = u * u, r2 = off2 + u2;
      const double second = off2 + u2 * (1.0 / 3), fourth = off2 * off2 + u2 * (2.0 / 3 * off2 + 0.2 * u2);
      return u * (1 + per2 * (per * r * (2 * r2 + 3 * off2) - 6 * second - 3 * per2 * fourth));
    };
    // The difference of asinh(u / off) by one logarithm of (u + r) / off, which below 0 is off / (r − u).
    const auto end = [off2](double u, double r) { return u < 0 ? off2 / (r - u) : u + r; };
    const double turn =
        off2 * per2 > 1e-32 ? 3 * off2 * off2 * std::log(end(to, r_to) / end(from, r_from)) * (per2 * per) : 0;
    return scale_ * (polynomial(to, r_to) - polynomial(from, r_from) + turn);
  }

  double cutoff_, scale_;
};

}  // namespace grit
