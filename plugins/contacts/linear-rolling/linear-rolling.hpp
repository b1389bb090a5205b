// The law, separate from the plugin for use in tests.
#pragma once

#include <cmath>
#include <optional>

#include "grit/contact/law.hpp"
#include "grit/contact/law_parameters.hpp"

namespace grit {

struct LinearRolling : LawBase {
  struct Settings {
    std::string limit_radius = "mean";

    void declare(Parameters& p) {
      p.add("limit_radius", limit_radius)
          .one_of({"mean", "smaller"})
          .doc("radius in rolling and twisting limits: (R_a + R_b) / 2, or the smaller of the two as in YADE");
    }
  };

  struct Material {
    double contact_modulus = 300e6;
    double shear_to_normal_stiffness = 0.3;
    double friction_angle = 18 * degree;
    double rolling_stiffness = 0.7;
    double rolling_limit = 0.4;
    double twisting_stiffness = 0;
    double twisting_limit = 0;
    double restitution = 1;

    void declare(Parameters& p) {
      declare_contact_modulus(p, contact_modulus);
      declare_shear_to_normal_stiffness(p, shear_to_normal_stiffness);
      declare_friction_angle(p, friction_angle);
      declare_rolling_stiffness(p, rolling_stiffness);
      declare_rolling_limit(p, rolling_limit);
      p.add("twisting_stiffness", twisting_stiffness)
          .symbol("beta_t")
          .at_least(0)
          .at_most(100)
          .doc("twisting stiffness over k_s R_a R_b; two materials: their mean");
      p.add("twisting_limit", twisting_limit)
          .symbol("eta_t")
          .at_least(0)
          .at_most(100)
          .doc(
              "limit of the twisting moment over normal force times radius; the smaller of two materials, unless an "
              "interface gives it");
      declare_restitution(p, restitution);
    }
  };

  struct Interface {
    std::optional<double> friction_angle, rolling_limit, twisting_limit, restitution;

    void declare(Parameters& p) {
      declare_friction_angle(p, friction_angle);
      declare_rolling_limit(p, rolling_limit);
      p.add("twisting_limit", twisting_limit)
          .symbol("eta_t")
          .at_least(0)
          .at_most(100)
          .doc("limit of the twisting moment between these two materials");
      declare_restitution(p, restitution);
    }
  };

  template <class L>
  struct Pair {
    L modulus_a, modulus_b, shear_ratio, friction;
    L rolling, rolling_limit, twisting, twisting_limit;
    L smaller_radius;  ///< 1: limits by the smaller radius; 0: by the mean
    L damping;         ///< damping ratio
  };

  static constexpr unsigned with_shear = 1, with_rolling = 2, with_twisting = 4, with_damping = 8;
  static constexpr LawTraits traits{.single_precision = true,
                                    .losses = true,
                                    .features = {"shear", "rolling", "twisting", "damping"},
                                    .prerequisites = {0, 0, with_shear | with_rolling, 0}};

  template <class L>
  struct State {
    Vec<L> shear, rolling;
    L twisting;
  };
  static constexpr LawField fields[] = {
      {.name = "shear", .unit = "N", .doc = "shear spring force on b", .width = 3, .swap = -1, .needed_by = with_shear},
      {.name = "rolling",
       .unit = "N m",
       .doc = "rolling moment on b",
       .width = 3,
       .swap = -1,
       .needed_by = with_rolling},
      {.name = "twisting",
       .unit = "N m",
       .doc = "twisting moment on b, along the normal from a to b",
       .needed_by = with_twisting}};

  static unsigned features(const Pair<double>& pair) {
    return (pair.friction > 0 ? with_shear : 0u) | (pair.rolling * pair.rolling_limit > 0 ? with_rolling : 0u) |
           (pair.twisting * pair.twisting_limit > 0 ? with_twisting : 0u) | (pair.damping > 0 ? with_damping : 0u);
  }

  /// A wall contributes strength only; stiffness and radius are those of the body.
  static Pair<double> mix(const Settings& settings, const Material& a, const Material& b, const Interface& interface,
                          bool wall) {
    const Material& stiff_b = wall ? a : b;
    const auto mean = [](double x, double y) { return 0.5 * (x + y); };
    Pair<double> pair;
    pair.modulus_a = a.contact_modulus, pair.modulus_b = stiff_b.contact_modulus;
    pair.shear_ratio = mean(a.shear_to_normal_stiffness, stiff_b.shear_to_normal_stiffness);
    pair.friction = std::tan(interface.friction_angle.value_or(std::min(a.friction_angle, b.friction_angle)));
    pair.rolling = mean(a.rolling_stiffness, stiff_b.rolling_stiffness);
    pair.rolling_limit = interface.rolling_limit.value_or(std::min(a.rolling_limit, b.rolling_limit));
    pair.twisting = mean(a.twisting_stiffness, stiff_b.twisting_stiffness);
    pair.twisting_limit = interface.twisting_limit.value_or(std::min(a.twisting_limit, b.twisting_limit));
    // A spring without stiffness carries no force, not even one stored before.
    if (pair.shear_ratio == 0) pair.friction = 0;
    if (pair.shear_ratio * pair.rolling == 0) pair.rolling_limit = 0;
    if (pair.shear_ratio * pair.twisting == 0) pair.twisting_limit = 0;
    pair.smaller_radius = settings.limit_radius == "smaller" ? 1 : 0;
    pair.damping = damping_of_restitution(interface.restitution.value_or(std::min(a.restitution, b.restitution)));
    return pair;
  }

  /// Radius in moment limits [m], multiplied by the normal force.
  template <class L>
  [[gnu::always_inline]] constexpr static L limiting_radius(const ContactPoint<L>& at, const Pair<L>& pair) {
    const L mean = L(0.5) * (at.radius_a + at.radius_b), smaller = min(at.radius_a, at.radius_b);
    return select(pair.smaller_radius > L(0.0), smaller, mean);
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair,
                                                               State<L>& state) {
    const L kn = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b), ks = pair.shear_ratio * kn;

    Response<L> response;
    response.normal_force = kn * at.overlap;
    if constexpr ((Features & with_damping) != 0) {
      const L dash = dashpot(pair.damping, kn, at.inverse_mass_a + at.inverse_mass_b);
      response.normal_force = max(L(0.0), response.normal_force - dash * dot(at.velocity, at.normal));
    }

    if constexpr ((Features & with_shear) != 0) {
      const Vec<L> shear = stretched(at, state.shear, ks, at.velocity);
      response.shear = shortened(shear, at.friction_limit(pair.friction, response.normal_force));
      state.shear = response.shear;
    }

    if constexpr ((Features & (with_rolling | with_twisting)) != 0) {
      const L arm = limiting_radius(at, pair) * response.normal_force;
      const L angular = ks * at.radius_a * at.radius_b;
      if constexpr ((Features & with_rolling) != 0) {
        const Vec<L> rolling = stretched(at, state.rolling, pair.rolling * angular, at.spin);
        response.moment = shortened(rolling, pair.rolling_limit * arm);
        state.rolling = response.moment;
      }
      if constexpr ((Features & with_twisting) != 0) {
        state.twisting = twisted(at, state.twisting, pair.twisting * angular, pair.twisting_limit * arm);
        response.moment = response.moment + state.twisting * at.normal;
      }
    }
    return response;
  }

  /// slip_work() times twice the stiffness, from the fraction of `trial` that evaluate() keeps at `limit`.
  template <class L>
  [[gnu::always_inline]] constexpr static L slipped(const Vec<L>& before, const Vec<L>& trial, const L& limit) {
    const L square = dot(trial, trial), kept = min(L(1.0), limit / max(sqrt(square), L(tiny<L>)));
    const L loaded = multiply_add(before.x, trial.x, multiply_add(before.y, trial.y, before.z * trial.z));
    const L both = multiply_add(kept, square, loaded);
    return multiply_add(-kept, both, both);
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Loss<L> losses(const ContactPoint<L>& at, const Pair<L>& pair,
                                                         const State<L>& before, const State<L>& after,
                                                         const Response<L>& response) {
    const L kn = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b), ks = pair.shear_ratio * kn;
    L slid(0.0);
    if constexpr ((Features & with_shear) != 0) {
      slid = slipped(at.turn(before.shear), stretched(at, before.shear, ks, at.velocity),
                     at.friction_limit(pair.friction, response.normal_force));
    }
    const L angular = ks * at.radius_a * at.radius_b, rolling_stiffness = pair.rolling * angular;
    // Rolling stiffness if active; one division serves both springs.
    L other(1.0), rolled(0.0);
    if constexpr ((Features & with_rolling) != 0) {
      const L arm = limiting_radius(at, pair) * response.normal_force;
      other = select(pair.rolling_limit > L(0.0), rolling_stiffness, L(1.0));
      rolled = slipped(at.turn(before.rolling), stretched(at, before.rolling, rolling_stiffness, at.spin),
                       pair.rolling_limit * arm);
    }
    // A spring without stiffness has no limit, see mix().
    const L half = L(0.5) / (ks * other);
    // A change of parameters that removes a spring accounts for its energy.
    const auto if_active = [](const L& limit, const L& lost) { return select(limit > L(0.0), lost, L(0.0)); };
    Loss<L> loss{L(0.0), L(0.0), L(0.0)};
    if constexpr ((Features & with_damping) != 0)
      loss.viscosity = dashpot_work(at, response.normal_force, kn * at.overlap);
    if constexpr ((Features & with_shear) != 0) loss.friction = if_active(pair.friction, slid * (half * other));
    if constexpr ((Features & with_rolling) != 0) loss.rolling = if_active(pair.rolling_limit, rolled * (half * ks));
    if constexpr ((Features & with_twisting) != 0) {
      const L stiffness = pair.twisting * angular;
      const L trial = before.twisting - (stiffness * at.dt) * dot(at.spin, at.normal);
      loss.rolling =
          loss.rolling + if_active(pair.twisting_limit, L(0.5) * (before.twisting + after.twisting) *
                                                            (trial - after.twisting) / max(stiffness, L(tiny<L>)));
    }
    return loss;
  }

  static Stiffness stiffness(const PairSize& size, const Pair<double>& pair) {
    const double kn = spring_in_line(pair.modulus_a, size.radius_a, pair.modulus_b, size.radius_b);
    const double ks = pair.shear_ratio * kn, angular = ks * size.radius_a * size.radius_b;
    return {.normal = kn,
            .shear = pair.friction > 0 ? ks : 0,
            .rolling = pair.rolling_limit > 0 ? pair.rolling * angular : 0,
            .twisting = pair.twisting_limit > 0 ? pair.twisting * angular : 0,
            .damping_ratio = pair.damping};
  }
  static ElasticEnergy energy(const PairSize& size, const Pair<double>& pair, const State<double>& state) {
    const Stiffness k = stiffness(size, pair);
    return {.normal = 0.5 * k.normal * size.overlap * size.overlap,
            .shear = spring_energy(dot(state.shear, state.shear), k.shear),
            .rolling = spring_energy(dot(state.rolling, state.rolling), k.rolling) +
                       spring_energy(state.twisting * state.twisting, k.twisting)};
  }
};

}  // namespace grit
