// Simulations with an energy balance from the start, and relative errors of its terms.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/packing.hpp"

namespace grit::test::energy_balance_tests {

inline constexpr double radius = 1e-3, density = 2500, safety = 0.02;
inline const double mass = density * 4.0 / 3 * std::numbers::pi * radius * radius * radius;

inline Description grains(const std::string& law, const Description& more, const std::vector<Grain>& list) {
  Description material = more;
  material["density"] = density;
  Description d = description(law, material, list);
  d["time_step"]["safety"] = safety;
  return d;
}

/// Far below the critical step [s], so that a fall without contacts is not refused because of possible contacts.
inline constexpr double fall_step = 1e-6;

/// A simulation with an energy balance from the start.
struct Kept : Trial {
  explicit Kept(const Description& d) : Trial(d, 1, BodyState::energy) { world().energies(); }
};

inline double kinetic_at(double speed) { return 0.5 * mass * speed * speed; }

inline Description periodic(const std::string& law, const Description& material, const std::vector<Grain>& list,
                            const Vec3& size, const Vec3& strain_rate) {
  Description d = grains(law, material, list);
  d["domain"] = {{"low", {0, 0, 0}},
                 {"high", vector(size)},
                 {"periodic", {true, true, true}},
                 {"strain_rate", vector(strain_rate)}};
  return d;
}

inline double turnover(const Energies& now) {
  return std::abs(now.walls) + std::abs(now.cell) + std::abs(now.engines) + now.dissipated() + now.elastic();
}
inline double closure_fraction(const Energies& now) { return std::abs(now.closure_error) / turnover(now); }

}  // namespace grit::test::energy_balance_tests
