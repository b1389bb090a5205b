// Checks of lengths in scenarios, and values for their messages.
#pragma once

#include <algorithm>
#include <sstream>
#include <string>

#include "grit/parameters.hpp"

namespace grit {

/// A value with enough digits that different values look different.
inline std::string quantity(double value, const std::string& unit) {
  std::ostringstream text;
  text.precision(12);
  text << value << ' ' << unit;
  return text.str();
}
inline std::string metres(double length) { return quantity(length, "m"); }

/// Complains about the side `key` [m] of a specimen or silo that is shorter than `grains` diameters of the largest
/// grains.
inline void check_side(const Complain& complain, const std::string& key, double side, int grains,
                       double largest_diameter) {
  if (side >= grains * largest_diameter) return;
  complain(key, metres(side),
           "at least " + std::to_string(grains) + " of the largest grains, " + metres(grains * largest_diameter));
}

/// Complains about grooves with a spacing below their width [m] (a spacing of 0 stands for the width), and about a wall
/// too short for one groove. The tolerance is that of the geometry saw-tooth.
inline void check_groove_spacing(const Complain& complain, double spacing, double width, double length) {
  constexpr double same_length = 1e-9;
  if (spacing > 0 && spacing < (1 - same_length) * width)
    complain("groove_spacing", metres(spacing), "at least the width of a groove, " + metres(width) + "; or omit it");
  if (const double period = std::max(spacing, width); period > (1 + same_length) * length)
    complain(spacing > width ? "groove_spacing" : "roughness", "grooves " + metres(period) + " apart",
             "at most the length of the wall, " + metres(length));
}

}  // namespace grit
