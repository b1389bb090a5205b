// Damping and integration of bodies in one pass.
#pragma once

#include <cstdint>
#include <span>

#include "bodies/bodies.hpp"
#include "bodies/velocity_range.hpp"
#include "contact/search.hpp"
#include "grit/contact/batch.hpp"
#include "grit/engine.hpp"

namespace grit {

/// One step of the leap-frog scheme.
struct MotionStep {
  MotionSettings settings;
  double kick;         ///< from the last mid-step to the next, during which forces act [s]
  double drift;        ///< time step [s]
  double flowed;       ///< previous step, in which bodies moved with the mean flow [s]
  Vec3 strain_rate;    ///< of a deforming cell [1/s]; damping and displacements are relative to its mean flow
  Vec3 centre;         ///< point of zero mean flow [m]
  Vec3 period;         ///< of the cell after the step [m]; 0 along axes that are not periodic
  Vec3 period_growth;  ///< m/s
  bool energies;       ///< whether the energies of Motion are needed
  std::span<const MotionSettings> by_group{};  ///< instead of `settings`, by group; empty if all bodies have the same
  std::span<const std::uint16_t> group{};      ///< group of each body; may be empty without by_group
  Vec3 shear_rate = Vec3::Zero();              ///< see Cell
  Vec3 tilt = Vec3::Zero(), tilt_growth = Vec3::Zero();  ///< of the cell after the step [m, m/s]

  bool shears() const { return !shear_rate.isZero(0.0); }
  bool flows() const { return !strain_rate.isZero(0.0) || shears(); }
  const MotionSettings& of(std::size_t body) const { return by_group.empty() ? settings : by_group[group[body]]; }
  /// Whether any body is subject to gravity.
  bool falls() const;
};

/// Summary of the motion of a chunk's bodies.
struct Motion {
  VelocityRange velocities;  ///< relative to the mean flow
  bool finite = true;        ///< no velocity is inf or NaN
  double damped = 0;         ///< energy dissipated by local damping [J]
  double fallen = 0;         ///< work of gravity [J]
  double carried = 0;        ///< work of moving bodies with the mean flow of a deforming cell [J]
  double prescribed = 0;     ///< change of the kinetic energy of bodies whose motion is prescribed [J]
};

/// Moves the bodies of one chunk under the forces `sum`, by index; bodies of clumps have already been moved.
Motion move_bodies(std::size_t chunk, Bodies& bodies, const BodySum* sum, const MotionStep& step);

}  // namespace grit
