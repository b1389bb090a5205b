// Closed forms that scenarios put beside their runs: silos, sand at failure, friction of walls, discharge. Pure
// functions, in SI; silo.md says where they hold.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grit::closed_forms {

inline constexpr double gravity = 9.81;  ///< m/s²

/// Janssen's balance of a plane silo: Janssen (1895), Z. Ver. Dtsch. Ing. 39, 1045; for two walls Nedderman (1992),
/// doi:10.1017/CBO9780511600043, and EN 1991-4:2006. All lengths above 0.
struct PlaneSilo {
  double width, height, depth;  ///< m, between the walls, of the filling, between the panes
  double unit_weight;           ///< of the bulk, N/m³
  double stress_ratio;          ///< K: horizontal over vertical stress, ≥ 0
  double wall_friction;         ///< tan φ_w, ≥ 0
  double rubbing_walls = 2;     ///< s; 1 in the form after Drescher, which leaves one wall's friction out

  /// a = s K tan φ_w h / b; 0: as a liquid.
  double exponent() const { return rubbing_walls * stress_ratio * wall_friction * height / width; }
  /// Vertical stress so far under the surface [Pa].
  double vertical_stress(double below_surface) const {
    return unit_weight * below_surface * relieved(exponent() * below_surface / height);
  }
  /// Horizontal stress on the walls, so far under the surface [Pa].
  double horizontal_stress(double below_surface) const { return stress_ratio * vertical_stress(below_surface); }
  double weight() const { return unit_weight * width * height * depth; }  ///< G [N]
  double bottom_force() const { return bottom_share() * weight(); }       ///< P [N]
  double bottom_share() const { return relieved(exponent()); }            ///< P/G
  /// T/G of one wall.
  double wall_shear_share() const { return (1 - bottom_share()) / rubbing_walls; }
  /// N/G of one wall; that of a smooth one too.
  double wall_normal_share() const {
    const double a = exponent();
    const double mean_depth = a < 1e-4 ? 0.5 - a / 6 : (1 - relieved(a)) / a;  // below, the difference is rounding
    return stress_ratio * height / width * mean_depth;
  }

 private:
  /// (1 − e⁻ᵃ) / a
  static double relieved(double a) { return a > 0 ? -std::expm1(-a) / a : 1; }
};

/// Horizontal over vertical stress of sand about to fail by spreading, tan²(45° − φ/2): Rankine (1857),
/// doi:10.1098/rstl.1857.0003. Friction angle in rad, 0 … π/2.
inline double rankine_active(double friction_angle) {
  return std::pow(std::tan(0.25 * std::numbers::pi - 0.5 * friction_angle), 2);
}
/// The same of sand about to fail by being pressed together, tan²(45° + φ/2); major over minor stress at failure.
inline double rankine_passive(double friction_angle) {
  return std::pow(std::tan(0.25 * std::numbers::pi + 0.5 * friction_angle), 2);
}

/// Horizontal over vertical stress in a silo, 1.1 (1 − sin φ_i): EN 1991-4:2006. Internal friction angle in rad.
inline double stored_stress_ratio(double internal_friction_angle) {
  return 1.1 * (1 - std::sin(internal_friction_angle));
}

/// a_w of a wall with grooves or waves that deep, in m: 0.2 of corrugated walls in EN 1991-4:2006, D.2; 1 where they
/// are shallower than a tenth of a grain, so that sand slides on them as on a flat wall.
inline double usual_wall_contact_factor(double groove_depth, double mean_diameter) {
  return groove_depth < 0.1 * mean_diameter ? 1 : 0.2;
}

/// Where sand slides on a share a_w of a wall and shears in itself along the rest, μ_eff = a_w μ_w + (1 − a_w) tan φ_i:
/// EN 1991-4:2006, D.2.
inline double effective_wall_friction(double contact_factor, double wall_friction, double internal_friction_angle) {
  return contact_factor * wall_friction + (1 - contact_factor) * std::tan(internal_friction_angle);
}
/// The same solved for a_w; infinite or no number where μ_w is tan φ_i.
inline double wall_contact_factor(double effective_friction, double wall_friction, double internal_friction_angle) {
  const double internal = std::tan(internal_friction_angle);
  return (effective_friction - internal) / (wall_friction - internal);
}

/// Rate through a slot [kg/s], 1.03 ρ_b √g L (w − 1.4 d)^3/2, 0 where it is that narrow: Beverloo, Leniger, van de
/// Velde (1961), doi:10.1016/0009-2509(61)85030-6, for slots Nedderman (1992), doi:10.1017/CBO9780511600043. Bulk
/// density in kg/m³, lengths in m.
inline double beverloo_slot(double bulk_density, double length, double width, double mean_diameter) {
  const double open = std::max(width - 1.4 * mean_diameter, 0.0);
  return 1.03 * bulk_density * std::sqrt(gravity) * length * std::pow(open, 1.5);
}

}  // namespace grit::closed_forms
