// Analytical solutions as references of scenarios: silos, sand at failure, wall friction, discharge. Pure functions in
// SI; range of validity: silo.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grit::analytical_solutions {

inline constexpr double gravity = 9.81;  ///< m/s²

/// Janssen's formula for a plane silo: Janssen (1895), Z. Ver. Dtsch. Ing. 39, 1045; for two walls Nedderman (1992),
/// doi:10.1017/CBO9780511600043, and EN 1991-4:2006. All lengths must be above 0.
struct PlaneSilo {
  double width, height, depth;     ///< between the walls, of the filling, between front and back pane [m]
  double unit_weight;              ///< of the bulk [N/m³]
  double stress_ratio;             ///< K: horizontal over vertical stress, ≥ 0
  double wall_friction;            ///< tan φ_w, ≥ 0
  double walls_with_friction = 2;  ///< s, number of walls with friction; 1 in Drescher's form

  /// a = s K tan φ_w h / b; 0 for a liquid.
  double exponent() const { return walls_with_friction * stress_ratio * wall_friction * height / width; }
  /// Vertical stress [Pa] at a depth below the surface [m].
  double vertical_stress(double below_surface) const {
    return unit_weight * below_surface * relieved(exponent() * below_surface / height);
  }
  /// Horizontal stress on the walls [Pa] at a depth below the surface [m].
  double horizontal_stress(double below_surface) const { return stress_ratio * vertical_stress(below_surface); }
  double weight() const { return unit_weight * width * height * depth; }  ///< G [N]
  double bottom_force() const { return bottom_fraction() * weight(); }    ///< P [N]
  double bottom_fraction() const { return relieved(exponent()); }         ///< P/G
  /// T/G of one wall.
  double wall_shear_fraction() const { return (1 - bottom_fraction()) / walls_with_friction; }
  /// N/G of one wall, also of a smooth one.
  double wall_normal_fraction() const {
    const double a = exponent();
    const double mean_depth =
        a < 1e-4 ? 0.5 - a / 6 : (1 - relieved(a)) / a;  // series: the difference would be lost to rounding
    return stress_ratio * height / width * mean_depth;
  }

 private:
  /// (1 − e⁻ᵃ) / a
  static double relieved(double a) { return a > 0 ? -std::expm1(-a) / a : 1; }
};

/// Rankine's active state: horizontal over vertical stress of sand at failure by extension, tan²(45° − φ/2): Rankine
/// (1857), doi:10.1098/rstl.1857.0003. Friction angle in rad, 0 … π/2.
inline double rankine_active(double friction_angle) {
  return std::pow(std::tan(0.25 * std::numbers::pi - 0.5 * friction_angle), 2);
}
/// Rankine's passive state: the same at failure by compression, tan²(45° + φ/2). Also major over minor stress at
/// failure.
inline double rankine_passive(double friction_angle) {
  return std::pow(std::tan(0.25 * std::numbers::pi + 0.5 * friction_angle), 2);
}

/// Stress ratio K, horizontal over vertical, in a silo after filling, 1.1 (1 − sin φ_i): EN 1991-4:2006. Internal
/// friction angle in rad.
inline double stored_stress_ratio(double internal_friction_angle) {
  return 1.1 * (1 - std::sin(internal_friction_angle));
}

/// Wall contact factor a_w of a wall with grooves or corrugations of this depth [m]: 0.2 as for corrugated walls in
/// EN 1991-4:2006, D.2; 1 if the depth is below a tenth of the mean diameter [m], where sand slides as on a flat wall.
inline double usual_wall_contact_factor(double groove_depth, double mean_diameter) {
  return groove_depth < 0.1 * mean_diameter ? 1 : 0.2;
}

/// Effective friction coefficient if sand slides on a fraction a_w of a wall and shears internally along the rest,
/// μ_eff = a_w μ_w + (1 − a_w) tan φ_i: EN 1991-4:2006, D.2. Internal friction angle in rad.
inline double effective_wall_friction(double contact_factor, double wall_friction, double internal_friction_angle) {
  return contact_factor * wall_friction + (1 - contact_factor) * std::tan(internal_friction_angle);
}
/// The same solved for a_w; infinite or NaN if μ_w = tan φ_i.
inline double wall_contact_factor(double effective_friction, double wall_friction, double internal_friction_angle) {
  const double internal = std::tan(internal_friction_angle);
  return (effective_friction - internal) / (wall_friction - internal);
}

/// Discharge rate through a slot [kg/s], 1.03 ρ_b √g L (w − 1.4 d)^3/2; 0 if w ≤ 1.4 d. Beverloo, Leniger, van de Velde
/// (1961), doi:10.1016/0009-2509(61)85030-6; for slots Nedderman (1992), doi:10.1017/CBO9780511600043. Bulk density in
/// kg/m³, lengths in m.
inline double beverloo_slot(double bulk_density, double length, double width, double mean_diameter) {
  const double open = std::max(width - 1.4 * mean_diameter, 0.0);
  return 1.03 * bulk_density * std::sqrt(gravity) * length * std::pow(open, 1.5);
}

}  // namespace grit::analytical_solutions
