// The law, separate from the plugin for use in tests.
#pragma once

#include <cmath>
#include <optional>

#include "grit/contact/law.hpp"
#include "grit/contact/law_parameters.hpp"

namespace grit {

struct HertzMindlin : LawBase {
  using Settings = NoParameters;

  struct Material {
    double young_modulus = 70e9;
    double poisson_ratio = 0.3;
    double friction_angle = 18 * degree;
    double restitution = 1;
    double rolling_stiffness = 0;
    double rolling_limit = 0;

    void declare(Parameters& p) {
      p.add("young_modulus", young_modulus).unit("Pa").symbol("E").above(0).doc("Young's modulus of the solid");
      p.add("poisson_ratio", poisson_ratio).symbol("nu").above(-1).at_most(0.5).doc("Poisson's ratio of the solid");
      declare_friction_angle(p, friction_angle);
      declare_restitution(p, restitution);
      declare_rolling_stiffness(p, rolling_stiffness);
      declare_rolling_limit(p, rolling_limit);
    }
  };

  struct Interface {
    std::optional<double> friction_angle, restitution, rolling_limit;

    void declare(Parameters& p) {
      declare_friction_angle(p, friction_angle);
      declare_restitution(p, restitution);
      declare_rolling_limit(p, rolling_limit);
    }
  };

  template <class L>
  struct Pair {
    L modulus, shear_modulus;  ///< E* and G* [Pa]
    L friction;
    L damping;  ///< 2 √(5/6) ζ
    L rolling, rolling_limit;
    L curved;  ///< 1: b is a sphere; 0: b is a wall, flat at the scale of the contact
  };

  static constexpr LawTraits traits{
      .single_precision = true, .losses = true, .features = {"shear", "damping", "rolling"}};
  static constexpr unsigned with_shear = 1, with_damping = 2, with_rolling = 4;

  template <class L>
  struct State {
    Vec<L> shear;
    L contact_radius;
    Vec<L> rolling;
  };
  static constexpr LawField fields[] = {
      {.name = "shear", .unit = "N", .doc = "shear spring force on b", .width = 3, .swap = -1, .needed_by = with_shear},
      {.name = "contact_radius",
       .unit = "m",
       .doc = "radius of the contact area",
       .needed_by = with_shear | with_rolling},
      {.name = "rolling",
       .unit = "N m",
       .doc = "rolling moment on b",
       .width = 3,
       .swap = -1,
       .needed_by = with_rolling}};

  static unsigned features(const Pair<double>& pair) {
    return (pair.friction > 0 ? with_shear : 0u) | (pair.damping > 0 ? with_damping : 0u) |
           (pair.rolling * pair.rolling_limit > 0 ? with_rolling : 0u);
  }

  static Pair<double> mix(const Settings&, const Material& a, const Material& b, const Interface& interface,
                          bool wall) {
    const auto plane_compliance = [](const Material& m) {
      return (1 - m.poisson_ratio * m.poisson_ratio) / m.young_modulus;
    };
    const auto shear_compliance = [](const Material& m) {
      return (2 - m.poisson_ratio) * 2 * (1 + m.poisson_ratio) / m.young_modulus;
    };
    Pair<double> pair;
    pair.modulus = 1 / (plane_compliance(a) + plane_compliance(b));
    pair.shear_modulus = 1 / (shear_compliance(a) + shear_compliance(b));
    pair.friction = std::tan(interface.friction_angle.value_or(std::min(a.friction_angle, b.friction_angle)));
    const double restitution = interface.restitution.value_or(std::min(a.restitution, b.restitution));
    pair.damping = 2 * std::sqrt(5.0 / 6) * damping_of_restitution(restitution);
    pair.rolling = 0.5 * (a.rolling_stiffness + b.rolling_stiffness);
    pair.rolling_limit = interface.rolling_limit.value_or(std::min(a.rolling_limit, b.rolling_limit));
    // A spring without stiffness carries no force, not even one stored before.
    if (pair.rolling == 0) pair.rolling_limit = 0;
    pair.curved = wall ? 0 : 1;
    return pair;
  }

  /// R* [m]; radius_b is ignored at a wall.
  template <class L>
  [[gnu::always_inline]] constexpr static L reduced_radius(const L& a, const L& b, const L& curved) {
    return a * b / max(curved * a + b, L(tiny<L>));
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair,
                                                               State<L>& state) {
    const L contact_radius = sqrt(reduced_radius(at.radius_a, at.radius_b, pair.curved) * at.overlap);
    const L kn = L(2.0) * pair.modulus * contact_radius, ks = L(8.0) * pair.shear_modulus * contact_radius;

    Response<L> response;
    response.normal_force = L(2.0 / 3) * kn * at.overlap;
    if constexpr ((Features & with_damping) != 0) {
      const L dash = dashpot(L(0.5) * pair.damping, kn, at.inverse_mass_a + at.inverse_mass_b);
      response.normal_force = max(L(0.0), response.normal_force - dash * dot(at.velocity, at.normal));
    }

    // A spring that softens during unloading loses force and energy in proportion to its stiffness.
    const L kept = min(L(1.0), contact_radius / max(state.contact_radius, L(tiny<L>)));
    state.contact_radius = contact_radius;
    if constexpr ((Features & with_shear) != 0) {
      response.shear = shortened(stretched(at, kept * state.shear, ks, at.velocity),
                                 at.friction_limit(pair.friction, response.normal_force));
      state.shear = response.shear;
    }
    if constexpr ((Features & with_rolling) != 0) {
      const L stiffness = pair.rolling * ks * at.radius_a * at.radius_b;
      const L arm = L(0.5) * (at.radius_a + at.radius_b);
      response.moment = shortened(stretched(at, kept * state.rolling, stiffness, at.spin),
                                  pair.rolling_limit * arm * response.normal_force);
      state.rolling = response.moment;
    }
    return response;
  }

  /// Energy that springs lose as stiffness follows the contact area counts as slip.
  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Loss<L> losses(const ContactPoint<L>& at, const Pair<L>& pair,
                                                         const State<L>& before, const State<L>& after,
                                                         const Response<L>& response) {
    const L contact_radius = sqrt(reduced_radius(at.radius_a, at.radius_b, pair.curved) * at.overlap);
    const L kn = L(2.0) * pair.modulus * contact_radius, ks = L(8.0) * pair.shear_modulus * contact_radius;
    const L kept = min(L(1.0), contact_radius / max(before.contact_radius, L(tiny<L>)));
    // A change of parameters that removes a spring accounts for its energy.
    const auto lost = [&](const L& limit, const Vec<L>& stored, const Vec<L>& now, const L& stiffness_per_ks,
                          const Vec<L>& rate) {
      const L stiffness = stiffness_per_ks * ks;
      const L stiffness_before = stiffness_per_ks * L(8.0) * pair.shear_modulus * before.contact_radius;
      const Vec<L> remaining = kept * stored;
      const L released = L(0.5) * (dot(stored, stored) / max(stiffness_before, L(tiny<L>)) -
                                   dot(remaining, remaining) / max(stiffness, L(tiny<L>)));
      const L slipped = slip_work(at.turn(remaining), stretched(at, remaining, stiffness, rate), now, stiffness);
      return select(limit > L(0.0), select(before.contact_radius > L(0.0), released, L(0.0)) + slipped, L(0.0));
    };
    Loss<L> loss{L(0.0), L(0.0), L(0.0)};
    if constexpr ((Features & with_damping) != 0)
      loss.viscosity = dashpot_work(at, response.normal_force, L(2.0 / 3) * kn * at.overlap);
    if constexpr ((Features & with_shear) != 0)
      loss.friction = lost(pair.friction, before.shear, after.shear, L(1.0), at.velocity);
    if constexpr ((Features & with_rolling) != 0)
      loss.rolling =
          lost(pair.rolling_limit, before.rolling, after.rolling, pair.rolling * at.radius_a * at.radius_b, at.spin);
    return loss;
  }

  /// Smallest overlap over R* used by stiffness(): new contacts soon become deeper.
  static constexpr double least_overlap = 1e-4;

  static Stiffness stiffness_at(const PairSize& size, const Pair<double>& pair, double contact_radius) {
    const double ks = 8 * pair.shear_modulus * contact_radius;
    return {.normal = 2 * pair.modulus * contact_radius,
            .shear = pair.friction > 0 ? ks : 0,
            .rolling = pair.rolling_limit > 0 ? pair.rolling * ks * size.radius_a * size.radius_b : 0,
            .damping_ratio = 0.5 * pair.damping};
  }
  static Stiffness stiffness(const PairSize& size, const Pair<double>& pair) {
    const double radius = reduced_radius(size.radius_a, size.radius_b, pair.curved);
    return stiffness_at(size, pair, std::sqrt(radius * std::max(size.overlap, least_overlap * radius)));
  }
  static ElasticEnergy energy(const PairSize& size, const Pair<double>& pair, const State<double>& state) {
    const double radius = reduced_radius(size.radius_a, size.radius_b, pair.curved);
    // Shear and rolling stiffness at the last step: losses() accounts for changes of the area since.
    const Stiffness k = stiffness_at(size, pair, state.contact_radius);
    const double kn = stiffness_at(size, pair, std::sqrt(radius * size.overlap)).normal;
    return {.normal = 4.0 / 15 * kn * size.overlap * size.overlap,
            .shear = spring_energy(dot(state.shear, state.shear), k.shear),
            .rolling = spring_energy(dot(state.rolling, state.rolling), k.rolling)};
  }
};

}  // namespace grit
