// Energy of motion, whose velocities and forces are not of the same instant.
#pragma once

#include <cstddef>

#include "grit/world.hpp"

namespace grit {

/// What forces do not say of accelerations.
struct Accelerating {
  Vec3 free_translation = Vec3::Ones(), free_rotation = Vec3::Ones();  ///< 0 along, or about, axes that are held
  Vec3 strain_rate = Vec3::Zero();  ///< of a cell whose mean flow bodies go with [1/s]
};

/// Translation and rotation [J], velocities brought on by `half_step` [s] with the accelerations that act now. Of the
/// bodies from `first` to `last`, as they are listed, and of as many clumps; of all unless these are given.
double kinetic_energy(const World& world, double half_step, const Accelerating& how = {}, std::size_t first = 0,
                      std::size_t last = ~std::size_t{0});

}  // namespace grit
