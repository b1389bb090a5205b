// Walls and vectors as scenarios write them into descriptions.
#pragma once

#include <string>

#include "grit/description.hpp"

namespace grit {

inline Description vector(double x, double y, double z) { return Description::array({x, y, z}); }

inline Description plane(const Description& point, const Description& normal, const std::string& material) {
  return {{"type", "plane"}, {"point", point}, {"normal", normal}, {"material", material}};
}

/// One-sided: bodies are on the side to which edge_a × edge_b points.
inline Description rectangle(const Description& corner, const Description& edge_a, const Description& edge_b,
                             const std::string& material) {
  return {{"type", "rectangle"}, {"corner", corner},   {"edge_a", edge_a},
          {"edge_b", edge_b},    {"two_sided", false}, {"material", material}};
}

/// A solid block with bodies outside.
inline Description block(const Description& low, const Description& high, const std::string& material) {
  return {{"type", "box"}, {"low", low}, {"high", high}, {"inside", false}, {"material", material}};
}

}  // namespace grit
