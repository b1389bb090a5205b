// Bounds that limit the time step.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grit/archive.hpp"

namespace grit {

/// Upper bounds for the critical time step: Q of springs [1/s²] and D of dashpots [1/s].
struct Demand {
  double spring = 0, dashpot = 0;
  /// (π / duration)² of the shortest impact of two isolated bodies, or of one on facets of a mesh [1/s²]; 0 if they
  /// separate softly.
  double impact = 0;

  /// Critical time step of the leap-frog scheme, whose dashpots use the velocities of half a step ago [s]: the solution
  /// of 2 dt D + dt² Q = 4. Infinite without contacts.
  double critical_time_step() const { return 4 / (dashpot + std::sqrt(dashpot * dashpot + 4 * spring)); }
  /// Step [s] at which the shortest impact takes `steps` steps. Infinite if there is none.
  double step_of_impact(double steps) const { return std::numbers::pi / (steps * std::sqrt(impact)); }
  /// The fraction of what a critical step of `dt` [s] allows.
  double share(double dt) const { return 0.5 * dt * dashpot + 0.25 * dt * dt * spring; }
  bool more_than(const Demand& other) const { return spring > other.spring || dashpot > other.dashpot; }
};

inline Demand larger(const Demand& a, const Demand& b) {
  return {std::max(a.spring, b.spring), std::max(a.dashpot, b.dashpot), std::max(a.impact, b.impact)};
}

template <>
inline constexpr bool plain_numbers<Demand> = true;

}  // namespace grit
