// Kinetic energy; velocities and forces are not at the same instant.
#pragma once

#include <cstddef>

#include "grit/world.hpp"

namespace grit {

/// Kinetic energy of translation and rotation [J], with velocities advanced by `half_step` [s] with the present
/// accelerations. `strain_rate`: of a cell with whose mean flow bodies move [1/s]. For the bodies and clumps with
/// indices from `first` to `last`; by default for all.
double kinetic_energy(const World& world, double half_step, const Vec3& strain_rate = Vec3::Zero(),
                      std::size_t first = 0, std::size_t last = ~std::size_t{0});

}  // namespace grit
