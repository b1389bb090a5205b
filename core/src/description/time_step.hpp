// The time step, and the guards that limit what may happen in it.
#pragma once

#include <optional>

#include "grit/parameters.hpp"

namespace grit {

struct TimeStepDescription {
  double safety = 0.8;
  double steps_per_impact = 7;  ///< (π/7)²/4: such an impact gains at most 5 % energy, the limit of the energy guard
  std::optional<double> max_displacement;  ///< of a body or wall per step, over the radius
  std::optional<double> value;
  bool allow_unstable = false;
  void declare(Parameters& p);
};
struct GuardsDescription {
  double overlap = 0.2;  ///< of the smaller radius
  double travel = 0.05;  ///< of the radius, per step
  double energy = 0.05;  ///< spurious gain, fraction of the energy
  void declare(Parameters& p);
};
/// The displacement per step to which the time step is limited, over the radius.
double max_displacement(const TimeStepDescription& time_step, const GuardsDescription& guards);

}  // namespace grit
