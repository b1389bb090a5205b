// Grains that nothing stops.
#pragma once

#include <cstddef>

#include "grit/world.hpp"

namespace grit {

/// Spheres and clumps that touch nothing while forces accelerate them, among all that are not held.
struct Falling {
  std::size_t grains = 0, all = 0;
  double speed = 0;  ///< the largest of theirs [m/s]
};
Falling falling_grains(const World& world);

}  // namespace grit
