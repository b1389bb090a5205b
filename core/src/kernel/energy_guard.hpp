// Stops a simulation in which energy is created.
#pragma once

#include <cstdint>

#include "kernel/energy_balance.hpp"

namespace grit {

/// Only gains trip the guard. It uses the energy balance if there is one, otherwise the stored energy, where
/// dissipation hides gains. Without a balance it does not check if work is done that is not summed up in each step.
class EnergyGuard {
 public:
  /// Restarts with the next forces, after a change of settings.
  void restart() { *this = {}; }
  /// Whether this step is checked.
  bool due(std::uint64_t step) const;
  /// Throws NumericsError if more energy appeared than /guards/energy allows.
  void check(const State& state, EnergyBalance& balance);
  void add_work_of_walls(double work) { work_ += work; }
  /// A body with this kinetic and potential energy [J] has left.
  void discharged(double energy) { stored_at_start_ -= energy; }

  /// The same of bodies that have entered.
  void entered(double energy) { stored_at_start_ += energy; }

  void serialize(Archive& archive) {
    archive(begins_, first_, stored_at_start_, work_, largest_, closure_at_start_, dissipated_at_start_);
  }

 private:
  bool begins_ = true;
  std::uint64_t first_ = 0;     // step at which it started
  double stored_at_start_ = 0;  // kinetic, elastic and gravitational [J]
  double work_ = 0;             // by walls since then, without half of the last step [J]
  double largest_ = 0;          // kinetic energy plus amount of elastic energy since then [J]
  double closure_at_start_ = 0, dissipated_at_start_ = 0;  // of the balance [J]
};

}  // namespace grit
