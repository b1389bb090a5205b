// The law, separate from the plugin for use in tests.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "grit/contact/law.hpp"
#include "grit/contact/law_parameters.hpp"

namespace grit {

struct Capillary : LawBase {
  template <class T>
  static void declare_bridge_volume(Parameters& p, T& value) {
    p.add("bridge_volume", value)
        .unit("m^3")
        .symbol("V")
        .at_least(0)
        .doc("volume of liquid in each bridge; an interface may give its own");
  }
  template <class T>
  static void declare_contact_angle(Parameters& p, T& value) {
    p.add("contact_angle", value)
        .unit("rad")
        .symbol("theta")
        .at_least(0)
        .below(std::numbers::pi / 2)
        .doc("contact angle of the liquid; two materials: their mean, unless an interface gives it");
  }

  struct Settings {
    double surface_tension = 0.072;
    double bridge_volume = 0;

    void declare(Parameters& p) {
      p.add("surface_tension", surface_tension)
          .unit("N/m")
          .symbol("gamma")
          .at_least(0)
          .doc("surface tension of the liquid; default: water at 25 degrees Celsius");
      declare_bridge_volume(p, bridge_volume);
    }
  };

  struct Material {
    double contact_modulus = 300e6;
    double shear_to_normal_stiffness = 0.3;
    double friction_angle = 18 * degree;
    double restitution = 1;
    double contact_angle = 0;

    void declare(Parameters& p) {
      declare_contact_modulus(p, contact_modulus);
      declare_shear_to_normal_stiffness(p, shear_to_normal_stiffness);
      declare_friction_angle(p, friction_angle);
      declare_restitution(p, restitution);
      declare_contact_angle(p, contact_angle);
    }
  };

  struct Interface {
    std::optional<double> friction_angle, restitution, contact_angle, bridge_volume;

    void declare(Parameters& p) {
      declare_friction_angle(p, friction_angle);
      declare_restitution(p, restitution);
      declare_contact_angle(p, contact_angle);
      declare_bridge_volume(p, bridge_volume);
    }
  };

  template <class L>
  struct Pair {
    L modulus_a, modulus_b, shear_ratio, friction;
    L damping;          ///< damping ratio
    L tension;          ///< 2π γ cos θ [N/m]; 0 without liquid
    L per_root_volume;  ///< 1/√V; 0 without liquid
    L rupture;          ///< rupture distance [m]
    L curved;           ///< 1: b is a sphere; 0: b is a flat wall
  };

  static constexpr LawTraits traits{
      .single_precision = true, .losses = true, .reach = true, .features = {"shear", "damping"}};
  static constexpr unsigned with_shear = 1, with_damping = 2;

  template <class L>
  struct State {
    L bridge;
    Vec<L> shear;
  };
  static constexpr LawField fields[] = {
      {.name = "bridge", .unit = "1", .doc = "1 since the surfaces touched, 0 before"},
      {.name = "shear",
       .unit = "N",
       .doc = "shear spring force on b",
       .width = 3,
       .swap = -1,
       .needed_by = with_shear}};

  static unsigned features(const Pair<double>& pair) {
    return (pair.friction > 0 ? with_shear : 0u) | (pair.damping > 0 ? with_damping : 0u);
  }

  /// A wall contributes friction, restitution and its contact angle; stiffness and radius are those of the body.
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
    const double angle = interface.contact_angle.value_or(0.5 * (a.contact_angle + b.contact_angle)),
                 volume = interface.bridge_volume.value_or(settings.bridge_volume);
    const bool wet = volume > 0;
    pair.tension = wet ? 2 * std::numbers::pi * settings.surface_tension * std::cos(angle) : 0;
    pair.per_root_volume = wet ? 1 / std::sqrt(volume) : 0;
    pair.rupture = wet ? (1 + 0.5 * angle) * std::cbrt(volume) : 0;
    pair.curved = wall ? 0 : 1;
    return pair;
  }

  template <class L>
  [[gnu::always_inline]] constexpr static L reach(const Pair<L>& pair, const L&, const L&) {
    return pair.rupture;
  }

  /// Radius of two equal spheres with about the same bridge [m]: 2 R_a R_b / (R_a + R_b), 2 R_a at a wall.
  template <class L>
  [[gnu::always_inline]] constexpr static L bridge_radius(const Pair<L>& pair, const L& radius_a, const L& radius_b) {
    return L(2.0) * radius_a * radius_b / max(pair.curved * radius_a + radius_b, L(tiny<L>));
  }

  // F = 2π R γ cos θ / (1 + 1.05 x + 2.5 x²), x = distance √(R/V).
  static constexpr double linear = 1.05, square = 2.5;

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair,
                                                               State<L>& state) {
    const L kn = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b), ks = pair.shear_ratio * kn;
    const L inverse_mass = at.inverse_mass_a + at.inverse_mass_b, none(0.0);
    state.bridge = max(state.bridge, select(at.overlap > none, L(1.0), none));

    // The contact of the solids, on which friction depends.
    L solid = kn * max(at.overlap, none);
    if constexpr ((Features & with_damping) != 0) {
      const L damped = solid - dashpot(pair.damping, kn, inverse_mass) * dot(at.velocity, at.normal);
      solid = select(at.overlap > none, max(none, damped), none);
    }
    const L radius = bridge_radius(pair, at.radius_a, at.radius_b);
    const L x = max(-at.overlap, none) * sqrt(radius) * pair.per_root_volume;
    Response<L> response;
    response.normal_force = solid - state.bridge * pair.tension * radius / (L(1.0) + x * (L(linear) + L(square) * x));

    if constexpr ((Features & with_shear) != 0) {
      response.shear = shortened(stretched(at, state.shear, ks, at.velocity), at.friction_limit(pair.friction, solid));
      state.shear = response.shear;
    }
    return response;
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Loss<L> losses(const ContactPoint<L>& at, const Pair<L>& pair,
                                                         const State<L>& before, const State<L>& after,
                                                         const Response<L>& response) {
    const L kn = spring_in_line(pair.modulus_a, at.radius_a, pair.modulus_b, at.radius_b), ks = pair.shear_ratio * kn;
    Loss<L> loss{L(0.0), L(0.0), L(0.0)};
    if constexpr ((Features & with_damping) != 0) {
      const L radius = bridge_radius(pair, at.radius_a, at.radius_b);
      const L undamped = kn * at.overlap - after.bridge * pair.tension * radius;
      loss.viscosity = select(at.overlap > L(0.0), dashpot_work(at, response.normal_force, undamped), L(0.0));
    }
    // A change of parameters that removes a spring accounts for its energy.
    if constexpr ((Features & with_shear) != 0)
      loss.friction = select(
          pair.friction > L(0.0),
          slip_work(at.turn(before.shear), stretched(at, before.shear, ks, at.velocity), after.shear, ks), L(0.0));
    return loss;
  }

  static Stiffness stiffness(const PairSize& size, const Pair<double>& pair) {
    const double kn = spring_in_line(pair.modulus_a, size.radius_a, pair.modulus_b, size.radius_b);
    return {.normal = kn, .shear = pair.friction > 0 ? pair.shear_ratio * kn : 0, .damping_ratio = pair.damping};
  }

  /// ∫ dx / (1 + 1.05 x + 2.5 x²) from 0.
  static double stretch(double x) {
    const double root = std::sqrt(4 * square - linear * linear);
    return 2 / root * (std::atan((2 * square * x + linear) / root) - std::atan(linear / root));
  }
  static ElasticEnergy energy(const PairSize& size, const Pair<double>& pair, const State<double>& state) {
    const Stiffness k = stiffness(size, pair);
    const double radius = bridge_radius(pair, size.radius_a, size.radius_b), pull = pair.tension * radius;
    ElasticEnergy stored{.shear = spring_energy(dot(state.shear, state.shear), k.shear)};
    if (size.overlap > 0) {
      stored.normal = (0.5 * k.normal * size.overlap - pull) * size.overlap;
    } else if (state.bridge > 0 && pull > 0) {
      const double per_length = std::sqrt(radius) * pair.per_root_volume;
      stored.normal = pull / per_length * stretch(-size.overlap * per_length);
    }
    return stored;
  }
};

}  // namespace grit
