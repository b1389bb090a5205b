// Kinetic energy; velocities and forces are not at the same instant.
#pragma once

#include <cstddef>

#include "grit/world.hpp"

namespace grit {

/// Constraints on accelerations that forces do not include.
struct Accelerating {
  Vec3 free_translation = Vec3::Ones(), free_rotation = Vec3::Ones();  ///< 0 along (or about) held axes
  Vec3 strain_rate = Vec3::Zero();  ///< of a cell with whose mean flow bodies move [1/s]
  Vec3 shear_rate = Vec3::Zero();   ///< the same, see Cell
};

/// Kinetic energy of translation and rotation [J], with velocities advanced by `half_step` [s] with the present
/// accelerations. For the bodies and clumps with indices from `first` to `last`; by default for all.
double kinetic_energy(const World& world, double half_step, const Accelerating& how = {}, std::size_t first = 0,
                      std::size_t last = ~std::size_t{0});

}  // namespace grit
