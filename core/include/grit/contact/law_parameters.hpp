// Parameters that several laws share, declared once. `T` is double for a material, std::optional<double> for an
// interface, where a value given overrides what the two materials would be mixed to.
#pragma once

#include <numbers>

#include "grit/contact/restitution.hpp"
#include "grit/parameters.hpp"

namespace grit {

inline constexpr double degree = std::numbers::pi / 180;

inline void declare_contact_modulus(Parameters& p, double& value) {
  p.add("contact_modulus", value).unit("Pa").symbol("E_c").above(0).doc("modulus of the normal spring");
}
inline void declare_shear_to_normal_stiffness(Parameters& p, double& value) {
  p.add("shear_to_normal_stiffness", value)
      .symbol("nu_c")
      .at_least(0)
      .at_most(10)
      .doc("shear over normal stiffness; the mean of two materials counts");
}
template <class T>
void declare_friction_angle(Parameters& p, T& value) {
  p.add("friction_angle", value)
      .unit("rad")
      .symbol("mu")
      .at_least(0)
      .below(std::numbers::pi / 2)
      .doc("angle of friction; the smaller of two materials counts");
}
template <class T>
void declare_restitution(Parameters& p, T& value) {
  p.add("restitution", value)
      .symbol("e")
      .at_least(least_restitution)
      .at_most(1)
      .doc("speed after over speed before a head-on collision; the smaller of two materials counts; 1: no dashpot");
}
inline void declare_rolling_stiffness(Parameters& p, double& value) {
  p.add("rolling_stiffness", value)
      .symbol("beta")
      .at_least(0)
      .at_most(100)
      .doc("rolling stiffness over k_s R_a R_b; the mean of two materials counts");
}
template <class T>
void declare_rolling_limit(Parameters& p, T& value) {
  p.add("rolling_limit", value)
      .symbol("eta")
      .at_least(0)
      .at_most(100)
      .doc("limit moment over normal force and radius; the smaller of two materials counts");
}

}  // namespace grit
