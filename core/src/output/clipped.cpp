#include "output/clipped.hpp"

#include <algorithm>

#include "output/scale.hpp"

namespace grit {

std::optional<Segment> clipped(const Segment& segment, double low_x, double high_x, double low_y, double high_y) {
  Segment part = segment;
  auto& [x1, y1, x2, y2] = part;
  if (!(drawable(x1) && drawable(y1) && drawable(x2) && drawable(y2))) return std::nullopt;
  // Cut ends are set to the limit exactly: computing them would lose all precision for very long segments.
  const auto cut = [](double& a1, double& b1, double& a2, double& b2, double low, double high) {
    if (std::max(a1, a2) < low || std::min(a1, a2) > high) return false;
    const double slope = a1 == a2 ? 0 : (b2 - b1) / (a2 - a1);
    const auto end = [&](double& a, double& b) {
      const double within = std::clamp(a, low, high);
      b += (within - a) * slope, a = within;
    };
    end(a1, b1), end(a2, b2);
    return true;
  };
  if (!cut(x1, y1, x2, y2, low_x, high_x) || !cut(y1, x1, y2, x2, low_y, high_y)) return std::nullopt;
  x1 = std::clamp(x1, low_x, high_x), x2 = std::clamp(x2, low_x, high_x);
  return part;
}

}  // namespace grit
