// Lengths that scenarios refuse.
#pragma once

#include <sstream>
#include <string>

#include "grit/parameters.hpp"

namespace grit {

/// A length [m] with so many digits that lengths which are not the same are told apart.
inline std::string metres(double length) {
  std::ostringstream text;
  text.precision(12);
  text << length << " m";
  return text.str();
}

/// Complains of the side `key` of a specimen or silo [m] that is shorter than so many of the largest grains.
inline void check_side(const Complain& complain, const std::string& key, double side, int grains,
                       double largest_diameter) {
  if (side >= grains * largest_diameter) return;
  complain(key, metres(side),
           "at least " + std::to_string(grains) + " of the largest grains, " + metres(grains * largest_diameter));
}

/// Complains of grooves that follow one another closer than they are wide [m]; a spacing of 0 is as close as they can.
/// Geometry saw-tooth takes as much for the same length.
inline void check_groove_spacing(const Complain& complain, double spacing, double width) {
  constexpr double same_length = 1e-9;
  if (!(spacing > 0 && spacing < (1 - same_length) * width)) return;
  complain("groove_spacing", metres(spacing), "at least the width of a groove, " + metres(width) + "; or left out");
}

}  // namespace grit
