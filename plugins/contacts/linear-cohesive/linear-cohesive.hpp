// The law, separate from the plugin for use in tests.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "grit/contact/law.hpp"
#include "grit/contact/law_parameters.hpp"

namespace grit {

struct LinearCohesive : LawBase {
  using Settings = NoParameters;

  template <class T>
  static void declare_tensile_strength(Parameters& p, T& value) {
    p.add("tensile_strength", value)
        .unit("Pa")
        .symbol("sigma_t")
        .at_least(0)
        .doc(
            "pull-off force over the cross-section of the smaller body; the smaller of two materials, unless an "
            "interface gives it");
  }

  struct Material {
    double contact_modulus = 300e6;
    double shear_to_normal_stiffness = 0.3;
    double friction_angle = 18 * degree;
    double tensile_strength = 0;
    double rolling_stiffness = 0;
    double rolling_limit = 0;

    void declare(Parameters& p) {
      declare_contact_modulus(p, contact_modulus);
      declare_shear_to_normal_stiffness(p, shear_to_normal_stiffness);
      declare_friction_angle(p, friction_angle);
      declare_tensile_strength(p, tensile_strength);
      declare_rolling_stiffness(p, rolling_stiffness);
      declare_rolling_limit(p, rolling_limit);
    }
  };

  struct Interface {
    std::optional<double> friction_angle, tensile_strength, rolling_limit;

    void declare(Parameters& p) {
      declare_friction_angle(p, friction_angle);
      declare_tensile_strength(p, tensile_strength);
      declare_rolling_limit(p, rolling_limit);
    }
  };

  template <class L>
  struct Pair {
    L modulus_a, modulus_b, shear_ratio, friction;
    L strength;  ///< π times the tensile strength
    L rolling, rolling_limit;
  };

  static constexpr LawTraits traits{
      .single_precision = true, .losses = true, .reach = true, .features = {"shear", "rolling"}};
  static constexpr unsigned with_shear = 1, with_rolling = 2;

  template <class L>
  struct State {
    L bond;
    Vec<L> shear, rolling;
  };
  static constexpr LawField fields[] = {
      {.name = "bond", .unit = "1", .doc = "1 since the surfaces touched, 0 before"},
      {.name = "shear", .unit = "N", .doc = "shear spring force on b", .width = 3, .swap = -1, .needed_by = with_shear},
      {.name = "rolling",
       .unit = "N m",
       .doc = "rolling moment on b",
       .width = 3,
       .swap = -1,
       .needed_by = with_rolling}};

  static unsigned features(const Pair<double>& pair) {
    return (pair.friction > 0 ? with_shear : 0u) | (pair.rolling * pair.rolling_limit > 0 ? with_rolling : 0u);
  }

  /// A wall contributes strength only; stiffness and radius are those of the body.
  static Pair<double> mix(const Settings&, const Material& a, const Material& b, const Interface& interface,
                          bool wall) {
    const Material& stiff_b = wall ? a : b;
    const auto mean = [](double x, double y) { return 0.5 * (x + y); };
    Pair<double> pair;
    pair.modulus_a = a.contact_modulus, pair.modulus_b = stiff_b.contact_modulus;
    pair.shear_ratio = mean(a.shear_to_normal_stiffness, stiff_b.shear_to_normal_stiffness);
    pair.friction = std::tan(interface.friction_angle.value_or(std::min(a.friction_angle, b.friction_angle)));
    pair.strength =
        std::numbers::pi * interface.tensile_strength.value_or(std::min(a.tensile_strength, b.tensile_strength));
    pair.rolling = mean(a.rolling_stiffness, stiff_b.rolling_stiffness);
    pair.rolling_limit = interface.rolling_limit.value_or(std::min(a.rolling_limit, b.rolling_limit));
    // A spring without stiffness carries no force, not even one stored before.
    if (pair.shear_ratio == 0) pair.friction = 0;
    if (pair.shear_ratio * pair.rolling == 0) pair.rolling_limit = 0;
    return pair;
  }

  /// The tension at which a bond breaks [N].
  template <class L>
  [[gnu::always_inline]] constexpr static L pull_off_force(const Pair<L>& pair, const L& radius_a, const L& radius_b) {
    const L radius = min(radius_a, radius_b);
    return pair.strength * radius * radius;
  }
  template <class L>
  [[gnu::always_inline]] constexpr static L reach(const Pair<L>& pair, const L& radius_a, const L& radius_b) {
    return pull_off_force(pair, radius_a, radius_b) /
           max(spring_in_line(pair.modulus_a, radius_a, pair.modulus_b, radius_b), L(tiny<L>));
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair,
                                                               State<L>& state) {
    const L kn = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b), ks = pair.shear_ratio * kn;
    state.bond = max(state.bond, select(at.overlap > L(0.0), L(1.0), L(0.0)));

    Response<L> response;
    response.normal_force = state.bond * (kn * at.overlap);
    // Distance of the normal force from tensile failure; never negative within the reach, but for rounding.
    const L carried = state.bond * max(L(0.0), kn * at.overlap + pull_off_force(pair, at.radius_a, at.radius_b));

    if constexpr ((Features & with_shear) != 0) {
      response.shear =
          shortened(stretched(at, state.shear, ks, at.velocity), at.friction_limit(pair.friction, carried));
      state.shear = response.shear;
    }
    if constexpr ((Features & with_rolling) != 0) {
      const L arm = L(0.5) * (at.radius_a + at.radius_b) * carried;
      const L stiffness = pair.rolling * ks * at.radius_a * at.radius_b;
      response.moment = shortened(stretched(at, state.rolling, stiffness, at.spin), pair.rolling_limit * arm);
      state.rolling = response.moment;
    }
    return response;
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Loss<L> losses(const ContactPoint<L>& at, const Pair<L>& pair,
                                                         const State<L>& before, const State<L>& after,
                                                         const Response<L>&) {
    const L kn = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b), ks = pair.shear_ratio * kn;
    Loss<L> loss{L(0.0), L(0.0), L(0.0)};
    // A change of parameters that removes a spring accounts for its energy.
    const auto lost = [&](const L& limit, const Vec<L>& stored, const Vec<L>& now, const L& stiffness,
                          const Vec<L>& rate) {
      return select(limit > L(0.0), slip_work(at.turn(stored), stretched(at, stored, stiffness, rate), now, stiffness),
                    L(0.0));
    };
    if constexpr ((Features & with_shear) != 0)
      loss.friction = lost(pair.friction, before.shear, after.shear, ks, at.velocity);
    if constexpr ((Features & with_rolling) != 0)
      loss.rolling = lost(pair.rolling_limit, before.rolling, after.rolling,
                          pair.rolling * ks * at.radius_a * at.radius_b, at.spin);
    return loss;
  }

  static Stiffness stiffness(const PairSize& size, const Pair<double>& pair) {
    const double kn = spring_in_line(pair.modulus_a, size.radius_a, pair.modulus_b, size.radius_b);
    const double ks = pair.shear_ratio * kn;
    return {.normal = kn,
            .shear = pair.friction > 0 ? ks : 0,
            .rolling = pair.rolling_limit > 0 ? pair.rolling * ks * size.radius_a * size.radius_b : 0};
  }
  static ElasticEnergy energy(const PairSize& size, const Pair<double>& pair, const State<double>& state) {
    const Stiffness k = stiffness(size, pair);
    const bool acts = size.overlap > 0 || state.bond > 0;
    return {.normal = acts ? 0.5 * k.normal * size.overlap * size.overlap : 0,
            .shear = spring_energy(dot(state.shear, state.shear), k.shear),
            .rolling = spring_energy(dot(state.rolling, state.rolling), k.rolling)};
  }
};

}  // namespace grit
