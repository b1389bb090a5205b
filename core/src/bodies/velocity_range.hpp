// Bounds of the velocities of several bodies.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace grit {

using Velocity = std::array<double, 3>;  // m/s

/// A box of velocities, by component.
struct VelocityRange {
  Velocity low{}, high{};

  Velocity middle() const { return {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])}; }
  /// The largest difference from a velocity [m/s].
  double furthest_from(const Velocity& from) const {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double most = std::max(high[k] - from[k], from[k] - low[k]);
      square += most * most;
    }
    return std::sqrt(square);
  }
  double largest_speed() const { return furthest_from({}); }
};

inline double difference(const Velocity& a, const Velocity& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace grit
