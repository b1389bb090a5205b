// Energy of motion, whose velocities and forces are not of the same instant.
#pragma once

#include "grit/world.hpp"

namespace grit {

/// Translation and rotation [J], velocities brought on by `half_step` [s] with the accelerations that act now.
double kinetic_energy(const World& world, double half_step);

}  // namespace grit
