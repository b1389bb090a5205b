// Clumps for tests.
#pragma once

#include "support/scene.hpp"

namespace grit::test {

inline Description ball(const Vec3& position, double radius) {
  return {{"position", vector(position)}, {"radius", radius}};
}
inline Description listed(const std::vector<Description>& spheres) { return {{"type", "list"}, {"spheres", spheres}}; }

/// Three spheres of different sizes, no two moments of inertia alike.
inline Description boomerang() {
  return listed({ball({0, 0, 0}, 1.0), ball({1.1, 0.2, 0}, 0.8), ball({-0.3, 0.9, 0.1}, 0.6)});
}

/// Grains of a description become clumps of this shape.
inline void make_clumps(Description& d, const Description& shape) {
  d["bodies"]["grains"]["type"] = "clump";
  d["bodies"]["grains"]["shape"] = shape;
}

}  // namespace grit::test
