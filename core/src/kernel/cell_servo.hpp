// Stress of a periodic cell, and the rates of deformation that keep it.
#pragma once

#include <string>

#include "grit/archive.hpp"
#include "kernel/passes.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Components xx, yy, zz, xy, xz, yz: strain rates, then shear rates [1/s].
using CellRates = Eigen::Matrix<double, 6, 1>;

class CellServo {
 public:
  /// Whether rates are set before the next motion; forces must then be known.
  static bool due(const State& state);
  /// The rates of the next steps. In an interval they change each stress by the missing one, if bodies move with the
  /// mean flow. They give way to forces instead, so that a packing is softer and this is stable.
  CellRates rates(const State& state, Passes& passes);

  void serialize(Archive& archive) {
    for (double& rate : habit_) archive(rate);
  }

 private:
  /// Rates averaged over the last evaluations; they keep stresses in steady deformation without an error.
  CellRates habit_ = CellRates::Zero();
};

/// Rates of the description, and the present ones where the servo sets them.
CellRates prescribed_rates(const State& state);
/// Sets the rates of the cell, and adds the change of the mean flow to the velocities of bodies.
void change_rates(State& state, const CellRates& rates);
/// Message for each stress that misses its target by more than a twentieth at the maximum strain rate; empty if there
/// is none. Uses the present forces.
std::string cell_servo_behind(const State& state, Passes& passes);

}  // namespace grit
