// Spheres that hit a plane or each other aslant or spinning: Chung & Ooi (2011), doi 10.1007/s10035-011-0277-0, tests 4
// to 8, where sliding has a closed form, and where the contact sticks for a while, against the law's own equations;
// linear laws against their closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/contact/restitution.hpp"
#include "support/rebound.hpp"
#include "support/verified.hpp"

namespace grit::test {
namespace {

using std::numbers::pi;

struct Material {
  double young, poisson, density, friction, restitution;

  double mass(double radius) const { return density * 4 / 3 * pi * radius * radius * radius; }
  /// Largest one of an elastic impact on a rigid plane [m].
  double overlap(double radius, double speed) const {
    const double spring = 4.0 / 3 * young / (1 - poisson * poisson) * std::sqrt(radius);
    return std::pow(1.25 * mass(radius) * speed * speed / spring, 0.4);
  }
  double duration(double radius, double speed) const { return 2.9432 * overlap(radius, speed) / speed; }
  /// Friction acts on a sphere flattened by the plane: its mean arm over the radius, ∫ F (r − δ) dt / (r ∫ F dt).
  double arm(double radius, double speed) const {
    const double mean = 0.5 * std::tgamma(1.4) * std::tgamma(0.5) / std::tgamma(1.9);  // of δ, over the largest
    return 1 - mean * overlap(radius, speed) / radius;
  }
  Description hertz() const {
    return {{"density", density},
            {"young_modulus", young},
            {"poisson_ratio", poisson},
            {"friction_angle", std::atan(friction)},
            {"restitution", restitution}};
  }
};

/// A ball on its way through a contact with what is rigid and at rest.
struct Course {
  double depth = 0, closing, along, spin, shear = 0;  ///< m, m/s, m/s, rad/s; on the ball [N]
};
Course after(const Course& c, const Course& rate, double dt) {
  return {c.depth + dt * rate.depth, c.closing + dt * rate.closing, c.along + dt * rate.along, c.spin + dt * rate.spin,
          c.shear + dt * rate.shear};
}

/// Hertz's spring with its dashpot, and Mindlin's up to Coulomb's limit, as a system of differential equations.
struct Equations {
  Material material;
  double radius, reduced_radius;
  double flattened;  ///< of the overlap, what the arm of friction is shorter by: 1 on a plane, 1/2 on a sphere
  double mass = material.mass(radius);
  double damping = 2 * std::sqrt(5.0 / 6) * damping_of_restitution(material.restitution);

  double contact(const Course& c) const { return std::sqrt(reduced_radius * std::max(c.depth, 0.0)); }
  double normal(const Course& c) const {
    const double stiffness = 2 * material.young / (1 - material.poisson * material.poisson) * contact(c);
    return std::max(0.0, 2.0 / 3 * stiffness * c.depth + damping * std::sqrt(stiffness * mass) * c.closing);
  }
  Course rate(const Course& c) const {
    const double shear_modulus = material.young / (2 * (2 - material.poisson) * (1 + material.poisson));
    const double eased = c.closing < 0 && c.depth > 0 ? 0.5 * c.closing / c.depth * c.shear : 0;
    return {.depth = c.closing,
            .closing = -normal(c) / mass,
            .along = c.shear / mass,
            .spin = -2.5 * (radius - flattened * c.depth) * c.shear / (mass * radius * radius),
            .shear = eased - 8 * shear_modulus * contact(c) * (c.along - radius * c.spin)};
  }
  /// Runge and Kutta's, of fourth order; what is beyond the limit of friction slips.
  Course rebound(Course c) const {
    const double deepest = material.overlap(radius, c.closing), dt = 2.9432 * deepest / c.closing / 50000;
    do {
      const Course k1 = rate(c), k2 = rate(after(c, k1, dt / 2)), k3 = rate(after(c, k2, dt / 2)),
                   k4 = rate(after(c, k3, dt));
      c = after(after(after(after(c, k1, dt / 6), k2, dt / 3), k3, dt / 3), k4, dt / 6);
      const double limit = material.friction * normal(c);
      c.shear = std::clamp(c.shear, -limit, limit);
    } while (c.depth > 1e-6 * deepest || c.closing > 0);
    return c;
  }
};

/// Errors are over the speed that the point of contact comes with.
void verify_rebound(const std::string& at, const Rebound& found, const Course& known, double scale, double radius,
                    double allowed) {
  verify("tangential speed" + at + ", error over that of the contact before [m/s]", found.velocity.x(), known.along,
         allowed, scale);
  verify("spin" + at + ", error over the speed of the contact before per radius [rad/s]", found.spin.y(), known.spin,
         allowed, scale / radius);
}

Rebound off_rigid_plane(const Material& m, double radius, const Vec3& velocity, const Vec3& spin) {
  Description rigid = m.hertz();
  rigid["young_modulus"] = 1e30;
  return from_plane("hertz-mindlin", m.hertz(), rigid, radius, velocity, spin,
                    m.duration(radius, -velocity.z()) / 4000);
}

TEST(ObliqueImpact, SlidesAsChungAndOoisFourthTestSays) {
  const Material oxide{380e9, 0.23, 4000, 0.092, 0.98};
  constexpr double radius = 2.5e-3, speed = 3.9;
  for (int angle = 35; angle < 89; angle += 5) {
    const Vec3 in = aslant(speed, angle);
    const Rebound out = off_rigid_plane(oxide, radius, in, Vec3::Zero());
    const double impulse = oxide.friction * (1 + oxide.restitution) * -in.z();
    const std::string at = " at " + std::to_string(angle) + "°";
    verify("tangential restitution" + at, out.velocity.x() / in.x(), 1 - impulse / in.x(), 1e-5);
    verify("spin" + at + " [rad/s]", out.spin.y(), 2.5 * impulse * oxide.arm(radius, -in.z()) / radius, 1e-4);
    EXPECT_EQ(out.velocity.y(), 0);
  }
}

TEST(ObliqueImpact, FollowsItsEquationsAtSmallAnglesOfTheFourthTest) {
  const Material oxide{380e9, 0.23, 4000, 0.092, 0.98};
  constexpr double radius = 2.5e-3, speed = 3.9;
  const Equations equations{oxide, radius, radius, 1};
  for (int angle = 2; angle < 32; angle += angle < 5 ? 3 : 5) {
    const Vec3 in = aslant(speed, angle);
    const Rebound out = off_rigid_plane(oxide, radius, in, Vec3::Zero());
    const Course known = equations.rebound({.closing = -in.z(), .along = in.x(), .spin = 0});
    verify_rebound(" at " + std::to_string(angle) + "°", out, known, in.x(), radius, 5e-4);
  }
}

TEST(ObliqueImpact, SlidesAsChungAndOoisFifthTestSays) {
  const Material steel{208e9, 0.3, 7850, 0.3, 1};
  constexpr double radius = 1e-5, normal = 5;
  // Slides from first to last above tan θ = μ (7 − 1/κ), κ = 2 (1 − ν) / (2 − ν) (Maw, Barber and Fawcett 1976).
  for (const double ratio : {2.0, 3.0, 6.0, 12.0}) {
    const Rebound out = off_rigid_plane(steel, radius, {ratio * normal, 0, -normal}, Vec3::Zero());
    const std::string at = " at tan θ = " + std::to_string(int(ratio));
    verify("tangential speed" + at + " [m/s]", out.velocity.x(), (ratio - 2 * steel.friction) * normal, 1e-8);
    verify("spin" + at + " [rad/s]", out.spin.y(), 5 * steel.friction * normal * steel.arm(radius, normal) / radius,
           1e-9);
  }
}

TEST(ObliqueImpact, FollowsItsEquationsAtSmallAnglesOfTheFifthTest) {
  const Material steel{208e9, 0.3, 7850, 0.3, 1};
  constexpr double radius = 1e-5, normal = 5;
  const Equations equations{steel, radius, radius, 1};
  for (const double ratio : {0.1, 0.25, 0.5, 1.0, 1.5}) {
    const Rebound out = off_rigid_plane(steel, radius, {ratio * normal, 0, -normal}, Vec3::Zero());
    const Course known = equations.rebound({.closing = normal, .along = ratio * normal, .spin = 0});
    char at[32];
    std::snprintf(at, sizeof at, " at tan θ = %g", ratio);
    verify_rebound(at, out, known, ratio * normal, radius, 5e-4);
  }
}

TEST(ObliqueImpact, SpinTurnsIntoSpeedAsChungAndOoisSixthTestSays) {
  const Material alloy{70e9, 0.3, 2699, 0.4, 0.5};
  constexpr double radius = 0.1, normal = 0.2;
  const double impulse = alloy.friction * (1 + alloy.restitution) * normal;
  // The dashpot presses from the first instant, when the shear spring is not loaded yet: the slower the sphere spins,
  // the more friction comes short of its limit.
  for (const double factor : {5.0, 10.0, 20.0}) {
    const double spin = factor * normal / radius;
    const Rebound out = off_rigid_plane(alloy, radius, {0, 0, -normal}, {0, spin, 0});
    // The lowest point moves along −x, so that friction pushes along x.
    const std::string from = " from " + std::to_string(int(spin)) + " rad/s";
    verify("tangential speed" + from + " [m/s]", out.velocity.x(), impulse, 1e-2);
    verify("spin" + from + " [rad/s]", out.spin.y(), spin - 2.5 * impulse / radius, 5e-3);
  }
}

TEST(ObliqueImpact, FollowsItsEquationsAtSlowSpinsOfTheSixthTest) {
  const Material alloy{70e9, 0.3, 2699, 0.4, 0.5};
  constexpr double radius = 0.1, normal = 0.2;
  const Equations equations{alloy, radius, radius, 1};
  for (const double spin : {0.2, 1.0, 2.0, 4.0, 10.0, 40.0}) {
    const Rebound out = off_rigid_plane(alloy, radius, {0, 0, -normal}, {0, spin, 0});
    const Course known = equations.rebound({.closing = normal, .along = 0, .spin = spin});
    char from[32];
    std::snprintf(from, sizeof from, " from %g rad/s", spin);
    verify_rebound(from, out, known, radius * spin, radius, 3e-4);
  }
}

TEST(ObliqueImpact, OppositeSpinsRollOnEachOtherAsChungAndOoisSeventhTestSays) {
  const Material alloy{70e9, 0.3, 2699, 0.4, 0.5};
  constexpr double radius = 0.1, speed = 0.2;
  Errors tangential("tangential speed of two that spin against each other, error over the speed before");
  Errors turning("spin of two that spin against each other, error over that before");
  for (const double spin : {0.175, 2.0, 22.86}) {
    Description d = description("hertz-mindlin", alloy.hertz(),
                                {{{0, 0, -radius}, radius, {0, 0, speed}, {0, spin, 0}},
                                 {{0, 0, radius}, radius, {0, 0, -speed}, {0, -spin, 0}}});
    d["time_step"]["value"] = alloy.duration(radius, speed) / 4000;
    Trial t(d);
    do t.step();
    while ((t.position(1) - t.position(0)).norm() < 2 * radius);
    for (const std::uint32_t id : {0, 1}) {
      tangential.add(t.velocity(id).x() / speed);
      EXPECT_EQ(t.spin(id).y(), id == 0 ? spin : -spin);
      turning.add(t.spin(id).y() / (id == 0 ? spin : -spin) - 1);
    }
  }
  tangential.verify(1e-14);
  turning.verify(1e-14);
}

constexpr Material eighth{70e9, 0.3, 2699, 0.4, 0.5};
constexpr double eighth_radius = 0.1, heavy_radius = 0.5, eighth_speed = 0.2;

/// Off a sphere that is a million times as dense and a thousand times as stiff.
Rebound off_heavy_sphere(double spin) {
  Description heavy = eighth.hertz();
  heavy["young_modulus"] = 1e3 * eighth.young, heavy["density"] = 1e6 * eighth.density;
  Description d = description("hertz-mindlin", eighth.hertz(),
                              {{{0, 0, eighth_radius}, eighth_radius, {0, 0, -eighth_speed}, {0, spin, 0}}});
  Description list = d["bodies"]["grains"];
  list["material"] = "heavy";
  list["grains"]["grains"] = Description::array({{{"position", {0, 0, -heavy_radius}}, {"radius", heavy_radius}}});
  d["bodies"]["target"] = list;
  d["materials"]["heavy"] = heavy;
  d["time_step"]["value"] = eighth.duration(eighth_radius, eighth_speed) / 8000;
  Trial t(d);
  do t.step();
  while ((t.position(1) - t.position(0)).norm() < eighth_radius + heavy_radius);
  return {t.velocity(0), t.spin(0)};
}

TEST(ObliqueImpact, OffAMuchHeavierSphereIsOffAPlaneAsChungAndOoisEighthTestSays) {
  const double impulse = eighth.friction * (1 + eighth.restitution) * eighth_speed;
  const Rebound out = off_heavy_sphere(20);
  verify("tangential speed [m/s]", out.velocity.x(), impulse, 5e-3);
  verify("spin [rad/s]", out.spin.y(), 20 - 2.5 * impulse / eighth_radius, 5e-3);
}

TEST(ObliqueImpact, FollowsItsEquationsAtSlowSpinsOfTheEighthTest) {
  const double reduced = eighth_radius * heavy_radius / (eighth_radius + heavy_radius);
  const Equations equations{eighth, eighth_radius, reduced, 0.5};
  for (const double spin : {0.2, 1.0, 2.0, 4.0, 10.0}) {
    const Course known = equations.rebound({.closing = eighth_speed, .along = 0, .spin = spin});
    char from[32];
    std::snprintf(from, sizeof from, " from %g rad/s", spin);
    // The heavy sphere gives way by a thousandth of what the light one does.
    verify_rebound(from, off_heavy_sphere(spin), known, eighth_radius * spin, eighth_radius, 3e-4);
  }
}

/// A linear spring pair on a plane; κ = 2/7 has the contact point swing as long as the normal spring does.
struct Linear {
  static constexpr double modulus = 1e8, radius = 1e-3, density = 2500;
  double mass = density * 4 / 3 * pi * radius * radius * radius;
  double duration = pi / std::sqrt(modulus * radius / mass);
  static Description material(double ratio, double friction) {
    return {{"density", density},
            {"contact_modulus", modulus},
            {"shear_to_normal_stiffness", ratio},
            {"friction_angle", std::atan(friction)}};
  }
  static Description material(const std::string& law, double ratio, double friction) {
    Description m = material(ratio, friction);
    if (law == "linear-rolling") m["rolling_limit"] = 0;
    return m;
  }
};

TEST(ObliqueImpact, StickingContactGivesBackAllOfItsTangentialSpeed) {
  const Linear ball;
  for (const std::string law : {"linear-rolling", "linear-frictional"}) {
    const Description material = Linear::material(law, 2.0 / 7, 10);
    for (const double angle : {5.0, 30.0, 60.0, 80.0}) {
      const Vec3 in = aslant(0.01, angle);  // slow, so that it stays round
      const Rebound out = from_plane(law, material, material, ball.radius, in, Vec3::Zero(), ball.duration / 500);
      // The contact point comes back as fast as it went: 2/7 of its velocity are the centre's.
      const std::string at = ", " + law + " at " + std::to_string(int(angle)) + "°";
      verify("tangential speed" + at + " [m/s]", out.velocity.x(), in.x() * (1 - 2 * 2.0 / 7), 2e-4);
      verify("spin" + at + " [rad/s]", out.spin.y(), 2.5 * 2 * 2.0 / 7 * in.x() / ball.radius, 2e-4);
    }
  }
}

// Slides from first to last above tan θ = 7 μ, if that is above μ over the ratio of stiffnesses too.
TEST(ObliqueImpact, LinearLawsSlideAsCoulombSays) {
  const Linear ball;
  constexpr double friction = 0.1, speed = 0.01;
  for (const std::string law : {"linear-rolling", "linear-frictional"})
    for (const double restitution : {1.0, 0.6}) {
      if (law == "linear-rolling" && restitution < 1) continue;
      // A dashpot presses at once, when the shear spring is not loaded yet: that has to be soon.
      Description material = Linear::material(law, restitution < 1 ? 10 : 0.3, friction);
      if (restitution < 1) material["restitution"] = restitution;
      for (const double angle : {45.0, 55.0, 65.0, 75.0, 85.0}) {
        const Vec3 in = aslant(speed, angle);
        const double allowed = restitution < 1 ? 2e-3 : 1e-8;
        const Rebound out = from_plane(law, material, material, ball.radius, in, Vec3::Zero(), ball.duration / 4000);
        const double impulse = friction * (1 + restitution) * -in.z();
        // Friction acts on a sphere flattened by the plane: the force's mean of the overlap is π/4 of the largest.
        const double deepest = -in.z() * ball.duration / pi, arm = ball.radius - pi / 4 * deepest;
        char at[64];
        std::snprintf(at, sizeof at, ", %s, restitution %g, at %g°", law.c_str(), restitution, angle);
        verify(std::string("loss of tangential speed by sliding") + at + " [m/s]", in.x() - out.velocity.x(), impulse,
               allowed);
        verify(std::string("spin by sliding") + at + " [rad/s]", out.spin.y(),
               2.5 * impulse * arm / (ball.radius * ball.radius), allowed);
      }
    }
}

}  // namespace
}  // namespace grit::test
