// Parameters that several laws share. `T` is double for a material and std::optional<double> for an interface, where a
// value overrides the one mixed from the two materials.
#pragma once

#include <numbers>

#include "grit/contact/restitution.hpp"
#include "grit/parameters.hpp"

namespace grit {

inline void declare_contact_modulus(Parameters& p, double& value) {
  p.add("contact_modulus", value)
      .unit("Pa")
      .symbol("E_c")
      .above(0)
      .doc("contact modulus; normal stiffness grows with it and with the radii");
}
inline void declare_shear_to_normal_stiffness(Parameters& p, double& value) {
  p.add("shear_to_normal_stiffness", value)
      .symbol("nu_c")
      .at_least(0)
      .at_most(10)
      .doc("shear over normal stiffness; two materials: their mean");
}
template <class T>
void declare_friction_angle(Parameters& p, T& value) {
  p.add("friction_angle", value)
      .unit("rad")
      .symbol("phi")
      .at_least(0)
      .below(std::numbers::pi / 2)
      .doc("friction angle, tan(phi) is the coefficient; the smaller of two materials, unless an interface gives it");
}
template <class T>
void declare_restitution(Parameters& p, T& value) {
  p.add("restitution", value)
      .symbol("e")
      .at_least(least_restitution)
      .at_most(1)
      .doc(
          "normal relative speed after over before a collision; 1: no dashpot; the smaller of two materials, unless an "
          "interface gives it");
}
inline void declare_rolling_stiffness(Parameters& p, double& value) {
  p.add("rolling_stiffness", value)
      .symbol("beta")
      .at_least(0)
      .at_most(100)
      .doc("rolling stiffness over k_s R_a R_b; two materials: their mean");
}
template <class T>
void declare_rolling_limit(Parameters& p, T& value) {
  p.add("rolling_limit", value)
      .symbol("eta")
      .at_least(0)
      .at_most(100)
      .doc(
          "limit of the rolling moment over normal force times radius; the smaller of two materials, unless an "
          "interface gives it");
}

}  // namespace grit
