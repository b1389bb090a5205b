// Damping ratio of a dashpot from a coefficient of restitution, for contacts without tension: a collision ends when the
// total force of spring and dashpot falls to zero, before the overlap does. Called when materials are mixed, not in the
// contact loop.
#pragma once

#include <cmath>

namespace grit {

/// Minimum coefficient of restitution. Without tension, 0 would need infinite damping.
inline constexpr double least_restitution = 0.01;

/// Restitution of a linear spring and dashpot, ζ = `ratio` ≥ 0 of critical, in closed form:
/// e = exp(−2ζ acos ζ / √(1 − ζ²)), with acosh ζ / √(ζ² − 1) above critical, exp(−2) at ζ = 1.
/// Schwager & Pöschel (2007), doi 10.1007/s10035-007-0065-z; their two branches below critical are one.
///
/// It holds for a Hertz spring as well, with the dashpot F = 2ζ √(5/6) √(S m*) δ̇, S = 2 E* √(R* δ) (Tsuji, Tanaka &
/// Ishida 1992, doi 10.1016/0032-5910(92)88030-L): in y = δ^(5/4) and the time ∫ δ^(1/4) dt that collision is the
/// linear one (Antypov & Elliott 2011, doi 10.1209/0295-5075/94/50004), and it ends at the same instant.
inline double restitution_of_damping(double ratio) {
  const double rest = 1 - ratio * ratio;
  if (std::abs(rest) < 1e-9) return std::exp(-2 * ratio);
  const double angle = rest > 0 ? std::acos(ratio) : std::acosh(ratio);
  return std::exp(-2 * ratio * angle / std::sqrt(std::abs(rest)));
}

/// The inverse, by bisection: the ratio of critical damping that gives `restitution` in [least_restitution, 1].
inline double damping_of_restitution(double restitution) {
  if (restitution >= 1) return 0;
  double low = 0, high = 8;  // restitution 1 and 0.004
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (restitution_of_damping(middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace grit
