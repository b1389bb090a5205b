// Kinetic energy; velocities and forces are not at the same instant.
#pragma once

#include <cstddef>

#include "grit/world.hpp"

namespace grit {

/// Velocity gradient of a cell with whose mean flow bodies move.
struct MeanFlow {
  Vec3 strain_rate = Vec3::Zero();  ///< 1/s
  Vec3 shear_rate = Vec3::Zero();   ///< 1/s, see Cell

  /// Rate of change of a vector by the shear of the flow.
  Vec3 shear(const Vec3& v) const { return {shear_rate[0] * v.y() + shear_rate[1] * v.z(), shear_rate[2] * v.z(), 0}; }
  /// A velocity [m/s] after it has been carried with the flow for `duration` [s], without forces.
  Vec3 carried(const Vec3& v, double duration) const {
    const Vec3 stretched = (Vec3::Ones() + duration * strain_rate).cwiseProduct(v);
    return shear_rate.isZero(0.0) ? stretched : Vec3(stretched + duration * shear(v));
  }
};

/// Kinetic energy of translation and rotation [J], with velocities advanced by `half_step` [s] with the present
/// accelerations. `flow`: of a cell. For the bodies and clumps with indices from `first` to `last`; by default for all.
double kinetic_energy(const World& world, double half_step, const MeanFlow& flow = {}, std::size_t first = 0,
                      std::size_t last = ~std::size_t{0});

}  // namespace grit
