// Stress of a periodic cell, and the strain rates that keep it.
#pragma once

#include <string>

#include "grit/archive.hpp"
#include "kernel/passes.hpp"
#include "kernel/state.hpp"

namespace grit {

class CellServo {
 public:
  /// Whether the strain rate is set before the next motion; forces must then be known.
  static bool due(const State& state);
  /// The strain rate of the next steps [1/s]. In an interval it changes each stress by the missing one, if bodies move
  /// with the mean flow. They give way to forces instead, so that a packing is softer and this is stable.
  Vec3 strain_rate(const State& state, Passes& passes);

  void serialize(Archive& archive) { archive(habit_); }

 private:
  /// Strain rate averaged over the last evaluations [1/s]; it keeps the stress in steady deformation without an error.
  Vec3 habit_ = Vec3::Zero();
};

/// Strain rate of the description [1/s], and the present one where the servo sets it.
Vec3 prescribed_strain_rate(const State& state);
/// Sets the strain rate of the cell, and adds the change of the mean flow to the velocities of bodies.
void change_strain_rate(State& state, const Vec3& rate);
/// Message for each stress that misses its target by more than a twentieth at the maximum strain rate; empty if there
/// is none. Uses the present forces.
std::string cell_servo_behind(const State& state, Passes& passes);

}  // namespace grit
