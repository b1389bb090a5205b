// The law, separate from the plugin for use in tests.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>

#include "grit/contact/law.hpp"
#include "grit/contact/law_parameters.hpp"

namespace grit {

/// With R* the reduced radius, E* the plane modulus and w the work of adhesion, c = √(2πw/E*) and the radius of the
/// contact area a = (c R*)^(2/3) u². Then the overlap is δ₀ (u⁴ − u), δ₀ = (c R*)^(4/3) / R*, and the normal force
/// E* R* c² (4/3 u⁶ − 2 u³).
struct Jkr : LawBase {
  using Settings = NoParameters;

  struct Material {
    double young_modulus = 70e9;
    double poisson_ratio = 0.3;
    double surface_energy = 0;
    double friction_angle = 18 * degree;
    double restitution = 1;

    void declare(Parameters& p) {
      p.add("young_modulus", young_modulus).unit("Pa").symbol("E").above(0).doc("Young's modulus of the solid");
      p.add("poisson_ratio", poisson_ratio).symbol("nu").above(-1).at_most(0.5).doc("Poisson's ratio of the solid");
      p.add("surface_energy", surface_energy)
          .unit("J/m^2")
          .symbol("gamma")
          .at_least(0)
          .doc("surface energy; the work of adhesion is 2 sqrt(gamma_a gamma_b), unless an interface gives it");
      declare_friction_angle(p, friction_angle);
      declare_restitution(p, restitution);
    }
  };

  struct Interface {
    std::optional<double> work_of_adhesion, friction_angle, restitution;

    void declare(Parameters& p) {
      p.add("work_of_adhesion", work_of_adhesion)
          .unit("J/m^2")
          .symbol("w")
          .at_least(0)
          .doc("work to separate a unit of area of these two materials");
      declare_friction_angle(p, friction_angle);
      declare_restitution(p, restitution);
    }
  };

  template <class L>
  struct Pair {
    L modulus, shear_modulus;  ///< E* and G* [Pa]
    L adhesion;                ///< c [√m]
    L root;                    ///< its cube root
    L friction;
    L damping;  ///< 2 √(5/6) ζ
    L curved;   ///< 1: b is a sphere; 0: b is a wall, flat at the scale of the contact
  };

  static constexpr LawTraits traits{.losses = true, .reach = true, .features = {"shear", "damping"}};
  static constexpr unsigned with_shear = 1, with_damping = 2;

  template <class L>
  struct State {
    L bond;
    Vec<L> shear;
    L contact_radius;
  };
  static constexpr LawField fields[] = {
      {.name = "bond", .unit = "1", .doc = "1 since the surfaces touched, 0 before"},
      {.name = "shear", .unit = "N", .doc = "shear spring force on b", .width = 3, .swap = -1, .needed_by = with_shear},
      {.name = "contact_radius", .unit = "m", .doc = "radius of the contact area", .needed_by = with_shear}};

  static unsigned features(const Pair<double>& pair) {
    return (pair.friction > 0 ? with_shear : 0u) | (pair.damping > 0 ? with_damping : 0u);
  }

  /// Smallest c [√m]: adhesion so weak is lost in rounding, and the equations need no case without.
  static constexpr double least_adhesion = 1e-12;

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
    const double work = interface.work_of_adhesion.value_or(2 * std::sqrt(a.surface_energy * b.surface_energy));
    pair.adhesion = std::max(least_adhesion, std::sqrt(2 * std::numbers::pi * work / pair.modulus));
    pair.root = std::cbrt(pair.adhesion);
    pair.friction = std::tan(interface.friction_angle.value_or(std::min(a.friction_angle, b.friction_angle)));
    const double restitution = interface.restitution.value_or(std::min(a.restitution, b.restitution));
    pair.damping = 2 * std::sqrt(5.0 / 6) * damping_of_restitution(restitution);
    pair.curved = wall ? 0 : 1;
    return pair;
  }

  /// R* [m]; radius_b is ignored at a wall.
  template <class L>
  [[gnu::always_inline]] constexpr static L reduced_radius(const L& a, const L& b, const L& curved) {
    return max(a * b / max(curved * a + b, L(tiny<L>)), L(tiny<L>));
  }

  /// Cube root to round-off, for radii from 1e-15 to 1e15 m: 1/3 = 1/4 + 1/16 + 1/64 + …, then Halley's steps.
  template <class L>
  [[gnu::always_inline]] constexpr static L cube_root(const L& x) {
    const auto fourth = [](const L& y) { return sqrt(sqrt(y)); };
    const L first = fourth(x), second = fourth(first);
    L root = first * second * fourth(second);
    for (int step = 0; step < 3; ++step) {
      const L cube = root * root * root;
      root = root * (cube + L(2.0) * x) / max(L(2.0) * cube + x, L(tiny<L>));
    }
    return root;
  }

  // Of u⁴ − u: its minimum, where a contact under controlled displacement breaks.
  static constexpr double least_u = 0.62996052494743658238;  ///< 4^(−1/3)
  static constexpr double least_depth = 0.75 * least_u;

  /// The upper root u of u⁴ − u = depth. Newton's steps fall monotonically from a bound above the root.
  template <class L>
  [[gnu::always_inline]] constexpr static L upper_root(const L& depth) {
    const L d = max(depth, L(-least_depth));
    const L near = L(least_u) + sqrt((d + L(least_depth)) * L(1 / (6 * least_u * least_u)));
    const L far = sqrt(sqrt(max(d, L(0.0)))) + L(1.0);
    L u = min(near, far);
    for (int step = 0; step < 6; ++step) {
      const L square = u * u;
      // The slope vanishes at the minimum, where the difference does, too.
      u = u - (square * square - u - d) / max(L(4.0) * square * u - L(1.0), L(1e-6));
    }
    return u;
  }

  /// Scales of a contact.
  template <class L>
  struct Scale {
    L width;  ///< contact radius over u² [m]
    L depth;  ///< δ₀ [m]
    L force;  ///< E* R* c² [N]; the pull-off force is 3/4 of it
  };
  template <class L>
  [[gnu::always_inline]] constexpr static Scale<L> scale_of(const Pair<L>& pair, const L& radius_a, const L& radius_b) {
    const L radius = reduced_radius(radius_a, radius_b, pair.curved);
    const L s = pair.root * cube_root(radius), width = s * s;
    return {width, width * width / radius, pair.modulus * radius * pair.adhesion * pair.adhesion};
  }

  template <class L>
  [[gnu::always_inline]] constexpr static L reach(const Pair<L>& pair, const L& radius_a, const L& radius_b) {
    return L(least_depth) * scale_of(pair, radius_a, radius_b).depth;
  }

  template <class L>
  [[gnu::always_inline]] constexpr static L normal_force(const Scale<L>& scale, const L& u) {
    const L cube = u * u * u;
    return scale.force * cube * (L(4.0 / 3) * cube - L(2.0));
  }

  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Response<L> evaluate(const ContactPoint<L>& at, const Pair<L>& pair,
                                                               State<L>& state) {
    const Scale<L> scale = scale_of(pair, at.radius_a, at.radius_b);
    const L u = upper_root(at.overlap / max(scale.depth, L(tiny<L>)));
    const L contact_radius = scale.width * u * u, pull_off = L(0.75) * scale.force;
    state.bond = max(state.bond, select(at.overlap > L(0.0), L(1.0), L(0.0)));

    Response<L> response;
    response.normal_force = state.bond * normal_force(scale, u);
    if constexpr ((Features & with_damping) != 0) {
      const L kn = L(2.0) * pair.modulus * contact_radius;
      const L dash = state.bond * dashpot(L(0.5) * pair.damping, kn, at.inverse_mass_a + at.inverse_mass_b);
      // A dashpot does not pull harder than adhesion can.
      response.normal_force = max(-pull_off, response.normal_force - dash * dot(at.velocity, at.normal));
    }
    if constexpr ((Features & with_shear) != 0) {
      const L ks = L(8.0) * pair.shear_modulus * contact_radius;
      // A spring that softens as the area shrinks loses force and energy in proportion to its stiffness.
      const L kept = min(L(1.0), contact_radius / max(state.contact_radius, L(tiny<L>)));
      const L limit = at.friction_limit(pair.friction, state.bond * (response.normal_force + L(2.0) * pull_off));
      response.shear = shortened(stretched(at, kept * state.shear, ks, at.velocity), limit);
      state.shear = response.shear;
      state.contact_radius = state.bond * contact_radius;
    }
    return response;
  }

  /// Energy that the spring loses as stiffness follows the contact area counts as slip.
  template <unsigned Features, class L>
  [[gnu::always_inline]] constexpr static Loss<L> losses(const ContactPoint<L>& at, const Pair<L>& pair,
                                                         const State<L>& before, const State<L>& after,
                                                         const Response<L>& response) {
    Loss<L> loss{L(0.0), L(0.0), L(0.0)};
    if constexpr ((Features & with_damping) != 0) {
      const Scale<L> scale = scale_of(pair, at.radius_a, at.radius_b);
      const L u = upper_root(at.overlap / max(scale.depth, L(tiny<L>)));
      loss.viscosity = dashpot_work(at, response.normal_force, after.bond * normal_force(scale, u));
    }
    if constexpr ((Features & with_shear) != 0) {
      const L ks = L(8.0) * pair.shear_modulus * after.contact_radius,
              ks_before = L(8.0) * pair.shear_modulus * before.contact_radius;
      const L kept = min(L(1.0), after.contact_radius / max(before.contact_radius, L(tiny<L>)));
      const Vec<L> remaining = kept * before.shear;
      const L released = L(0.5) * (dot(before.shear, before.shear) / max(ks_before, L(tiny<L>)) -
                                   dot(remaining, remaining) / max(ks, L(tiny<L>)));
      const L slipped = slip_work(at.turn(remaining), stretched(at, remaining, ks, at.velocity), after.shear, ks);
      // A change of parameters that removes the spring accounts for its energy.
      loss.friction =
          select(pair.friction > L(0.0), select(before.contact_radius > L(0.0), released, L(0.0)) + slipped, L(0.0));
    }
    return loss;
  }

  /// Smallest overlap over R* used by stiffness(): new contacts soon become deeper.
  static constexpr double least_overlap = 1e-4;

  static Stiffness stiffness(const PairSize& size, const Pair<double>& pair) {
    const Scale<double> scale = scale_of(pair, size.radius_a, size.radius_b);
    const double radius = reduced_radius(size.radius_a, size.radius_b, pair.curved);
    const double u = upper_root(std::max(size.overlap, least_overlap * radius) / scale.depth);
    const double fifth = u * u * u * u * u;
    const double contact_radius = scale.width * u * u,
                 slope = scale.force / scale.depth * (8 * fifth - 6 * u * u) / (4 * u * u * u - 1);
    // The dashpot follows the stiffness without adhesion, 2 E* a, which is above the slope.
    return {.normal = slope,
            .shear = pair.friction > 0 ? 8 * pair.shear_modulus * contact_radius : 0,
            .damping_ratio = 0.5 * pair.damping * std::sqrt(2 * pair.modulus * contact_radius / slope)};
  }
  static ElasticEnergy energy(const PairSize& size, const Pair<double>& pair, const State<double>& state) {
    const Scale<double> scale = scale_of(pair, size.radius_a, size.radius_b);
    const double u = upper_root(size.overlap / scale.depth);
    const auto integral = [](double v) {
      return std::pow(v, 4) * (0.5 - 4.0 / 3 * std::pow(v, 3) + 8.0 / 15 * std::pow(v, 6));
    };
    const bool acts = size.overlap > 0 || state.bond > 0;
    return {.normal = acts ? scale.force * scale.depth * (integral(u) - integral(1)) : 0,
            // Shear stiffness at the last step: losses() accounts for changes of the area since.
            .shear = spring_energy(dot(state.shear, state.shear), 8 * pair.shear_modulus * state.contact_radius)};
  }
};

}  // namespace grit
