// Kinetic energy; velocities and forces are not at the same instant.
#pragma once

#include <cstddef>

#include "grit/world.hpp"

namespace grit {

/// Velocity gradient of a cell with whose mean flow bodies move.
struct MeanFlow {
  Vec3 strain_rate = Vec3::Zero();  ///< 1/s
  Vec3 shear_rate = Vec3::Zero();   ///< 1/s, see Cell
};

/// Kinetic energy of translation and rotation [J], with velocities advanced by `half_step` [s] with the present
/// accelerations. `flow`: of a cell. For the bodies and clumps with
/// indices from `first` to `last`; by default for all.
double kinetic_energy(const World& world, double half_step, const MeanFlow& flow = {}, std::size_t first = 0,
                      std::size_t last = ~std::size_t{0});

}  // namespace grit
