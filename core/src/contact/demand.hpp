// What limits the time step.
#pragma once

#include <cmath>
#include <numbers>

#include "grit/memory.hpp"

namespace grit {

/// Upper bounds of what springs and dashpots ask of the step: Q [1/s²] and D [1/s].
struct Demand {
  double spring = 0, dashpot = 0;
  double impact = 0;  ///< (π / time)² of the shortest impact between two bodies that touch nobody else [1/s²]; 0 where
                      ///< they part softly

  /// The leap-frog, whose dashpots see the velocities of half a step ago, is stable below this step [s]: 2 dt D + dt² Q
  /// = 4. Infinite where nothing asks.
  double critical_time_step() const { return 4 / (dashpot + std::sqrt(dashpot * dashpot + 4 * spring)); }
  /// Step [s] of which such an impact takes `steps`. Infinite where there is none.
  double step_of_impact(double steps) const { return std::numbers::pi / (steps * std::sqrt(impact)); }
  bool more_than(const Demand& other) const { return spring > other.spring || dashpot > other.dashpot; }
};

template <>
inline constexpr bool plain_numbers<Demand> = true;

}  // namespace grit
