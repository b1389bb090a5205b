// The law itself, apart from the plugin, so that tests see it.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "grit/contact/law.hpp"

namespace grit {

struct LinearRolling {
  struct Settings {
    std::string limit_radius = "mean";

    void declare(Parameters& p) {
      p.add("limit_radius", limit_radius)
          .one_of({"mean", "smaller"})
          .doc("radius in the rolling limit: (R_a + R_b) / 2, or the smaller of the two as YADE has it");
    }
  };

  struct Material {
    double contact_modulus = 300e6;
    double shear_to_normal_stiffness = 0.3;
    double friction_angle = 18 * std::numbers::pi / 180;
    double rolling_stiffness = 0.7;
    double rolling_limit = 0.4;
    double twisting_stiffness = 0;
    double twisting_limit = 0;

    void declare(Parameters& p) {
      p.add("contact_modulus", contact_modulus).unit("Pa").symbol("E_c").above(0).doc("modulus of the normal spring");
      p.add("shear_to_normal_stiffness", shear_to_normal_stiffness)
          .symbol("nu_c")
          .at_least(0)
          .at_most(10)
          .doc("shear over normal stiffness");
      p.add("friction_angle", friction_angle)
          .unit("rad")
          .symbol("mu")
          .at_least(0)
          .below(std::numbers::pi / 2)
          .doc("angle of friction between grains; the smaller of two materials counts");
      p.add("rolling_stiffness", rolling_stiffness)
          .symbol("beta")
          .at_least(0)
          .at_most(100)
          .doc("rolling stiffness over k_s R_a R_b");
      p.add("rolling_limit", rolling_limit)
          .symbol("eta")
          .at_least(0)
          .at_most(100)
          .doc("limit moment over normal force and radius; the smaller of two materials counts");
      p.add("twisting_stiffness", twisting_stiffness)
          .symbol("beta_t")
          .at_least(0)
          .at_most(100)
          .doc("twisting stiffness over k_s R_a R_b");
      p.add("twisting_limit", twisting_limit)
          .symbol("eta_t")
          .at_least(0)
          .at_most(100)
          .doc("limit of the twisting moment over normal force and radius");
    }
  };

  struct Interface {
    std::optional<double> friction_angle, rolling_limit, twisting_limit;

    void declare(Parameters& p) {
      p.add("friction_angle", friction_angle)
          .unit("rad")
          .symbol("mu")
          .at_least(0)
          .below(std::numbers::pi / 2)
          .doc("angle of friction between these two materials");
      p.add("rolling_limit", rolling_limit).symbol("eta").at_least(0).doc("limit moment between these two materials");
      p.add("twisting_limit", twisting_limit)
          .symbol("eta_t")
          .at_least(0)
          .doc("limit of the twisting moment between these two materials");
    }
  };

  template <class L>
  struct Pair {
    L modulus_a, modulus_b, shear_ratio, friction;
    L rolling, rolling_limit, twisting, twisting_limit;
    L smaller_radius;  ///< 1: limits by the smaller radius, 0: by the mean
  };

  template <class L>
  struct State {
    L shear_x, shear_y, shear_z;        ///< shear force on b [N]
    L rolling_x, rolling_y, rolling_z;  ///< rolling moment on b [N m]
    L twisting;                         ///< twisting moment on b along the normal [N m]
  };
  static std::vector<StateField> fields() {
    return {{"shear_x", "N", "shear force on b", -1},          {"shear_y", "N", "shear force on b", -1},
            {"shear_z", "N", "shear force on b", -1},          {"rolling_x", "N m", "rolling moment on b", -1},
            {"rolling_y", "N m", "rolling moment on b", -1},   {"rolling_z", "N m", "rolling moment on b", -1},
            {"twisting", "N m", "twisting moment on b, along the normal from a to b", 1}};
  }

  static constexpr unsigned feature_bits = 2;
  static constexpr unsigned with_rolling = 1, with_twisting = 2;
  static unsigned features(const Pair<double>& pair) {
    return (pair.rolling * pair.rolling_limit > 0 ? with_rolling : 0u) |
           (pair.twisting * pair.twisting_limit > 0 ? with_twisting : 0u);
  }
  static constexpr std::size_t fields_used(unsigned features) {
    return (features & with_twisting) != 0 ? 7 : (features & with_rolling) != 0 ? 6 : 3;
  }

  static Pair<double> mix(const Settings& settings, const Material& a, const Material& b, const Interface& interface) {
    const auto mean = [](double x, double y) { return 0.5 * (x + y); };
    Pair<double> pair;
    pair.modulus_a = a.contact_modulus, pair.modulus_b = b.contact_modulus;
    pair.shear_ratio = mean(a.shear_to_normal_stiffness, b.shear_to_normal_stiffness);
    pair.friction = std::tan(interface.friction_angle.value_or(std::min(a.friction_angle, b.friction_angle)));
    pair.rolling = mean(a.rolling_stiffness, b.rolling_stiffness);
    pair.rolling_limit = interface.rolling_limit.value_or(std::min(a.rolling_limit, b.rolling_limit));
    pair.twisting = mean(a.twisting_stiffness, b.twisting_stiffness);
    pair.twisting_limit = interface.twisting_limit.value_or(std::min(a.twisting_limit, b.twisting_limit));
    pair.smaller_radius = settings.limit_radius == "smaller" ? 1 : 0;
    return pair;
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair, State<L>& state) {
    const L zero(0.0), one(1.0), tiny(1e-300);
    const L soft_a = pair.modulus_a * at.radius_a, soft_b = pair.modulus_b * at.radius_b;
    const L kn = L(2.0) * soft_a * soft_b / (soft_a + soft_b);
    const L ks = pair.shear_ratio * kn;

    Response<L> response;
    response.normal_force = kn * at.overlap;

    Vec<L> shear = at.turn(Vec<L>{state.shear_x, state.shear_y, state.shear_z});
    shear = shear - (ks * at.dt) * at.tangential(at.velocity);
    const L limit = pair.friction * response.normal_force;
    shear = shear * min(one, limit / max(sqrt(dot(shear, shear)), tiny));
    response.shear = shear;
    state.shear_x = shear.x, state.shear_y = shear.y, state.shear_z = shear.z;

    if constexpr (Features != 0) {
      const L mean = L(0.5) * (at.radius_a + at.radius_b), smaller = min(at.radius_a, at.radius_b);
      const L arm = select(pair.smaller_radius > zero, smaller, mean) * response.normal_force;
      const L angular = ks * at.radius_a * at.radius_b * at.dt;
      Vec<L> moment{zero, zero, zero};
      if constexpr ((Features & with_rolling) != 0) {
        moment = at.turn(Vec<L>{state.rolling_x, state.rolling_y, state.rolling_z});
        moment = moment - (pair.rolling * angular) * at.tangential(at.spin);
        moment = moment * min(one, pair.rolling_limit * arm / max(sqrt(dot(moment, moment)), tiny));
        state.rolling_x = moment.x, state.rolling_y = moment.y, state.rolling_z = moment.z;
      }
      if constexpr ((Features & with_twisting) != 0) {
        L twisting = state.twisting - pair.twisting * angular * dot(at.spin, at.normal);
        const L most = pair.twisting_limit * arm;
        twisting = max(-most, min(most, twisting));
        state.twisting = twisting;
        moment = moment + twisting * at.normal;
      }
      response.moment = moment;
    }
    return response;
  }

  static double normal_stiffness(const PairSize& size, const Pair<double>& pair) {
    const double a = pair.modulus_a * size.radius_a, b = pair.modulus_b * size.radius_b;
    return 2 * a * b / (a + b);
  }
  static Stiffness stiffness(const PairSize& size, const Pair<double>& pair) {
    const double kn = normal_stiffness(size, pair), ks = pair.shear_ratio * kn;
    const double angular = ks * size.radius_a * size.radius_b;
    return {.normal = kn,
            .shear = ks,
            .rolling = pair.rolling_limit > 0 ? pair.rolling * angular : 0,
            .twisting = pair.twisting_limit > 0 ? pair.twisting * angular : 0};
  }
  static double energy(const PairSize& size, const Pair<double>& pair, const State<double>& state) {
    const Stiffness k = stiffness(size, pair);
    const auto stored = [](double square, double stiffness) { return stiffness > 0 ? 0.5 * square / stiffness : 0.0; };
    const auto square = [](double x, double y, double z) { return x * x + y * y + z * z; };
    return 0.5 * k.normal * size.overlap * size.overlap +
           stored(square(state.shear_x, state.shear_y, state.shear_z), k.shear) +
           stored(square(state.rolling_x, state.rolling_y, state.rolling_z), k.rolling) +
           stored(state.twisting * state.twisting, k.twisting);
  }
};

}  // namespace grit
