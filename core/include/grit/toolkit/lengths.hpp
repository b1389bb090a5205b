// Lengths that scenarios refuse, and values as they tell them.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>

#include "grit/parameters.hpp"

namespace grit {

/// A value with so many digits that values which are not the same are told apart.
inline std::string quantity(double value, const std::string& unit) {
  std::ostringstream text;
  text.precision(12);
  text << value << ' ' << unit;
  return text.str();
}
inline std::string metres(double length) { return quantity(length, "m"); }

/// Complains of the side `key` of a specimen or silo [m] that is shorter than so many of the largest grains.
inline void check_side(const Complain& complain, const std::string& key, double side, int grains,
                       double largest_diameter) {
  if (side >= grains * largest_diameter) return;
  complain(key, metres(side),
           "at least " + std::to_string(grains) + " of the largest grains, " + metres(grains * largest_diameter));
}

/// Complains of grooves that follow one another closer than they are wide [m]; a spacing of 0 is as close as they can.
/// Geometry saw-tooth takes as much for the same length. And of those of which a wall of some `length` [m] has none.
inline void check_groove_spacing(const Complain& complain, double spacing, double width, double length) {
  constexpr double same_length = 1e-9;
  if (spacing > 0 && spacing < (1 - same_length) * width)
    complain("groove_spacing", metres(spacing), "at least the width of a groove, " + metres(width) + "; or left out");
  if (const double from_groove_to_groove = std::max(spacing, width); from_groove_to_groove > (1 + same_length) * length)
    complain(spacing > width ? "groove_spacing" : "roughness", "grooves " + metres(from_groove_to_groove) + " apart",
             "at least one on the wall, of " + metres(length));
}

}  // namespace grit
