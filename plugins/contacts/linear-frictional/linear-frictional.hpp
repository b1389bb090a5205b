// The law, separate from the plugin for use in tests.
#pragma once

#include <cmath>
#include <optional>

#include "grit/contact/law.hpp"
#include "grit/contact/law_parameters.hpp"

namespace grit {

struct LinearFrictional : LawBase {
  struct Settings {
    bool shear_damping = false;

    void declare(Parameters& p) {
      p.add("shear_damping", shear_damping).doc("whether restitution also damps sticking contacts in shear");
    }
  };

  struct Material {
    double contact_modulus = 300e6;
    double shear_to_normal_stiffness = 0.3;
    double friction_angle = 18 * degree;
    double restitution = 1;

    void declare(Parameters& p) {
      declare_contact_modulus(p, contact_modulus);
      declare_shear_to_normal_stiffness(p, shear_to_normal_stiffness);
      declare_friction_angle(p, friction_angle);
      declare_restitution(p, restitution);
    }
  };

  struct Interface {
    std::optional<double> friction_angle, restitution;

    void declare(Parameters& p) {
      declare_friction_angle(p, friction_angle);
      declare_restitution(p, restitution);
    }
  };

  template <class L>
  struct Pair {
    L modulus_a, modulus_b, shear_ratio, friction;
    L damping, shear_damping;  ///< damping ratios
  };

  static constexpr LawTraits traits{
      .single_precision = true, .losses = true, .features = {"shear", "damping", "shear damping"}};
  static constexpr unsigned with_shear = 1, with_damping = 2, with_shear_damping = 4;

  template <class L>
  struct State {
    Vec<L> shear;
  };
  static constexpr LawField fields[] = {{.name = "shear",
                                         .unit = "N",
                                         .doc = "shear spring force on b",
                                         .width = 3,
                                         .swap = -1,
                                         .needed_by = with_shear}};

  static unsigned features(const Pair<double>& pair) {
    const bool shear = pair.friction * pair.shear_ratio > 0;
    return (shear ? with_shear : 0u) | (pair.damping > 0 ? with_damping : 0u) |
           (shear && pair.shear_damping > 0 ? with_shear_damping : 0u);
  }

  /// A wall contributes friction and restitution; stiffness and radius are those of the body.
  static Pair<double> mix(const Settings& settings, const Material& a, const Material& b, const Interface& interface,
                          bool wall) {
    const Material& stiff_b = wall ? a : b;
    Pair<double> pair;
    pair.modulus_a = a.contact_modulus, pair.modulus_b = stiff_b.contact_modulus;
    pair.shear_ratio = 0.5 * (a.shear_to_normal_stiffness + stiff_b.shear_to_normal_stiffness);
    pair.friction = std::tan(interface.friction_angle.value_or(std::min(a.friction_angle, b.friction_angle)));
    // A spring without stiffness carries no force, not even one stored before.
    if (pair.shear_ratio == 0) pair.friction = 0;
    pair.damping = damping_of_restitution(interface.restitution.value_or(std::min(a.restitution, b.restitution)));
    pair.shear_damping = settings.shear_damping ? pair.damping : 0;
    return pair;
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair,
                                                               State<L>& state) {
    const L kn = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b), ks = pair.shear_ratio * kn;
    const L inverse_mass = at.inverse_mass_a + at.inverse_mass_b;

    Response<L> response;
    response.normal_force = kn * at.overlap;
    if constexpr ((Features & with_damping) != 0) {
      const L damped = response.normal_force - dashpot(pair.damping, kn, inverse_mass) * dot(at.velocity, at.normal);
      response.normal_force = max(L(0.0), damped);
    }

    if constexpr ((Features & with_shear) != 0) {
      const L limit = at.friction_limit(pair.friction, response.normal_force);
      const Vec<L> trial = stretched(at, state.shear, ks, at.velocity);
      const Vec<L> spring = shortened(trial, limit);
      state.shear = spring;
      response.shear = spring;
      if constexpr ((Features & with_shear_damping) != 0) {
        const L dash = dashpot(pair.shear_damping, ks, L(3.5) * inverse_mass);
        // Clearly below the limit, so that a second evaluation does not treat a contact that just slid as sticking.
        const L sticking = select(dot(trial, trial) < L(1 - beyond_rounding<L>) * limit * limit, dash, L(0.0));
        response.shear = shortened(spring - sticking * at.tangential(at.velocity), limit);
      }
    }
    return response;
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Loss<L> losses(const ContactPoint<L>& at, const Pair<L>& pair,
                                                         const State<L>& before, const State<L>& after,
                                                         const Response<L>& response) {
    const L kn = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b), ks = pair.shear_ratio * kn;
    Loss<L> loss{L(0.0), L(0.0), L(0.0)};
    if constexpr ((Features & with_damping) != 0)
      loss.viscosity = dashpot_work(at, response.normal_force, kn * at.overlap);
    if constexpr ((Features & with_shear) != 0) {
      const Vec<L>&shear = before.shear, &spring = after.shear;
      // A change of parameters that removes a spring accounts for its energy.
      loss.friction = select(pair.friction > L(0.0),
                             slip_work(at.turn(shear), stretched(at, shear, ks, at.velocity), spring, ks), L(0.0));
      loss.viscosity = loss.viscosity - at.dt * dot(response.shear - spring, at.velocity);
    }
    return loss;
  }

  static Stiffness stiffness(const PairSize& size, const Pair<double>& pair) {
    const double kn = spring_in_line(pair.modulus_a, size.radius_a, pair.modulus_b, size.radius_b);
    return {.normal = kn,
            .shear = pair.friction > 0 ? pair.shear_ratio * kn : 0,
            .damping_ratio = pair.damping,
            .shear_damping_ratio = pair.friction > 0 ? pair.shear_damping : 0};
  }
  static ElasticEnergy energy(const PairSize& size, const Pair<double>& pair, const State<double>& state) {
    const Stiffness k = stiffness(size, pair);
    return {.normal = 0.5 * k.normal * size.overlap * size.overlap,
            .shear = spring_energy(dot(state.shear, state.shear), k.shear)};
  }
};

}  // namespace grit
