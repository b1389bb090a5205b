// Which bodies are so far from all others that a picture which shows them shows nothing else.
#pragma once

#include <array>
#include <vector>

#include "output/read_frames.hpp"

namespace grit {

/// How far from the middle half of all positions along an axis, in its widths, and more than that, in mean diameters:
/// a layer of no height has room by these.
struct Far {
  double widths, diameters;
};

/// What is beyond is out of sight at first. 3 widths are Tukey's outer fence (Exploratory Data Analysis, 1977, 2D).
inline constexpr Far far_to_see{3, 5};
/// What is beyond is left out of pictures, in which nobody can look for it: all others would be less than a twentieth
/// of one. Among far smaller ones a large body may well lie where it is out of sight at first.
inline constexpr Far far_to_draw{10, 100};
/// What is beyond would leave the others too few of the 65 536 places of an axis: two of them are a thousandth of the
/// middle half and a sixtieth of a diameter apart at most.
inline constexpr Far far_to_keep{30, 500};

/// The one in the middle, of those that are drawable(); 0 without any.
double median(std::vector<double> numbers);

/// Two on each axis, with what is not far between them.
class Fences {
 public:
  /// `positions` has x, y, z of one body after another [m]; what is not drawable() counts for nothing. `diameter`: the
  /// mean one [m].
  Fences(const std::vector<double>& positions, double diameter, const Far& far);
  /// About the bodies of a frame.
  Fences(const Frame& frame, const Far& far);

  /// Whether the range is between them, of what has a size along an axis [m].
  bool hold(std::size_t axis, double low, double high) const { return low >= low_[axis] && high <= high_[axis]; }
  /// Whether the body at this place of the list is between them. It is not where its position is not finite.
  bool hold(const std::vector<double>& positions, std::size_t body) const;

 private:
  std::array<double, 3> low_, high_;  ///< m
};

}  // namespace grit
