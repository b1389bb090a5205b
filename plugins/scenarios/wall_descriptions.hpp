// Walls and vectors as scenarios write them into descriptions.
#pragma once

#include <sstream>
#include <string>

#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

inline Description vector(double x, double y, double z) { return Description::array({x, y, z}); }

inline Description plane(const Description& point, const Description& normal, const std::string& material) {
  return {{"type", "plane"}, {"point", point}, {"normal", normal}, {"material", material}};
}

/// One-sided: bodies are where edge_a × edge_b points.
inline Description rectangle(const Description& corner, const Description& edge_a, const Description& edge_b,
                             const std::string& material) {
  return {{"type", "rectangle"}, {"corner", corner},   {"edge_a", edge_a},
          {"edge_b", edge_b},    {"two_sided", false}, {"material", material}};
}

/// A solid block: bodies are outside.
inline Description block(const Description& low, const Description& high, const std::string& material) {
  return {{"type", "box"}, {"low", low}, {"high", high}, {"inside", false}, {"material", material}};
}

/// Complains of grooves that follow one another closer than they are wide [m]; a spacing of 0 is as close as they can.
/// Geometry saw-tooth takes as much for the same length.
inline void check_groove_spacing(const Complain& complain, double spacing, double width) {
  constexpr double same_length = 1e-9;
  if (!(spacing > 0 && spacing < (1 - same_length) * width)) return;
  const auto metres = [](double length) {
    std::ostringstream text;
    text.precision(12);  // tells lengths apart that are not the same
    text << length << " m";
    return text.str();
  };
  complain("groove_spacing", metres(spacing), "at least the width of a groove, " + metres(width) + "; or left out");
}

}  // namespace grit
