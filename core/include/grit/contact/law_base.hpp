// The names that a contact law uses, for laws in any namespace.
#pragma once

#include "grit/contact/contact_law.hpp"
#include "grit/contact/contact_point.hpp"
#include "grit/contact/lanes.hpp"
#include "grit/contact/law_parameters.hpp"
#include "grit/contact/law_traits.hpp"
#include "grit/contact/restitution.hpp"
#include "grit/contact/springs.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// Settings or Interface of a law without such parameters.
struct NoParameters {
  void declare(Parameters&) {}
};

/// Base class of laws, so that their code needs no `grit::`. The functions are members because argument-dependent
/// lookup finds nothing for plain doubles, which are lanes too. Functions that take a Vec or a ContactPoint, such as
/// dot() and stretched(), are found without it.
struct LawBase {
  template <class L>
  using ContactPoint = grit::ContactPoint<L>;
  template <class L>
  using Response = grit::Response<L>;
  template <class L>
  using Loss = grit::Loss<L>;
  template <class L>
  using Vec = grit::Vec<L>;
  using ElasticEnergy = grit::ElasticEnergy;
  using LawField = grit::LawField;
  using LawTraits = grit::LawTraits;
  using NoParameters = grit::NoParameters;
  using PairSize = grit::PairSize;
  using Parameters = grit::Parameters;
  using Stiffness = grit::Stiffness;

  template <class L>
  static constexpr double tiny = grit::tiny<L>;
  template <class L>
  static constexpr double beyond_rounding = grit::beyond_rounding<L>;
  static constexpr double degree = grit::degree;

  template <class Mask, class T>
  [[gnu::always_inline]] constexpr static T select(const Mask& condition, const T& yes, const T& no) {
    return grit::select(condition, yes, no);
  }
  template <class L>
  [[gnu::always_inline]] constexpr static L sqrt(const L& a) {
    return grit::sqrt(a);
  }
  template <class L>
  [[gnu::always_inline]] constexpr static L abs(const L& a) {
    return grit::abs(a);
  }
  template <class L>
  [[gnu::always_inline]] constexpr static L min(const L& a, const L& b) {
    return grit::min(a, b);
  }
  template <class L>
  [[gnu::always_inline]] constexpr static L max(const L& a, const L& b) {
    return grit::max(a, b);
  }
  template <class L>
  [[gnu::always_inline]] constexpr static L multiply_add(const L& a, const L& b, const L& c) {
    return grit::multiply_add(a, b, c);
  }
  template <class L>
  [[gnu::always_inline]] constexpr static L spring_in_line(const L& modulus_a, const L& radius_a, const L& modulus_b,
                                                           const L& radius_b) {
    return grit::spring_in_line(modulus_a, radius_a, modulus_b, radius_b);
  }
  template <class L>
  [[gnu::always_inline]] constexpr static L dashpot(const L& ratio, const L& stiffness, const L& inverse_mass) {
    return grit::dashpot(ratio, stiffness, inverse_mass);
  }
  static double spring_energy(double square, double stiffness) { return grit::spring_energy(square, stiffness); }
  static double damping_of_restitution(double restitution) { return grit::damping_of_restitution(restitution); }
};

}  // namespace grit
