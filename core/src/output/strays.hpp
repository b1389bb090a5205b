// Detection of outliers: bodies so far from the others that a picture including them would show little else.
#pragma once

#include <array>
#include <vector>

#include "output/read_frames.hpp"

namespace grit {

/// Distance from the middle half of all positions along an axis: multiples of its width plus multiples of the mean
/// diameter, which count for a layer of zero height.
struct Far {
  double widths, diameters;
};

/// Beyond this, bodies are outside the initial view. 3 widths are Tukey's outer fence (Exploratory Data Analysis, 1977,
/// 2D).
inline constexpr Far far_to_see{3, 5};
/// Beyond this, bodies are omitted from pictures, as all others would be less than a twentieth of one. It is wider than
/// far_to_see, as pictures cannot be zoomed out, and a large body among small ones may lie far outside.
inline constexpr Far far_to_draw{10, 100};
/// Beyond this, bodies would leave too few of the 65 536 positions of an axis to the others: within it, their spacing
/// is at most a thousandth of the middle half plus a sixtieth of a diameter.
inline constexpr Far far_to_keep{30, 500};

/// Median of the drawable() numbers; 0 if there are none.
double median(std::vector<double> numbers);

/// Limits on each axis between which bodies are not outliers.
class Fences {
 public:
  /// `positions`: x, y, z of each body [m]; ignores values that are not drawable(). `diameter`: mean diameter [m].
  Fences(const std::vector<double>& positions, double diameter, const Far& far);
  /// Limits for the bodies of a frame.
  Fences(const Frame& frame, const Far& far);

  /// Whether a range along an axis lies within the limits [m].
  bool hold(std::size_t axis, double low, double high) const { return low >= low_[axis] && high <= high_[axis]; }
  /// Whether the body of this index lies within the limits; false if its position is not finite.
  bool hold(const std::vector<double>& positions, std::size_t body) const;

 private:
  std::array<double, 3> low_, high_;  ///< m
};

}  // namespace grit
