// Spheres that hit a plane or each other aslant or spinning: Chung & Ooi (2011), doi 10.1007/s10035-011-0277-0, tests 4
// to 8, where sliding has a closed form; and sticking against the closed form of a linear law.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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

TEST(ObliqueImpact, OffAMuchHeavierSphereIsOffAPlaneAsChungAndOoisEighthTestSays) {
  const Material alloy{70e9, 0.3, 2699, 0.4, 0.5};
  constexpr double radius = 0.1, large = 0.5, normal = 0.2, spin = 20;
  Description heavy = alloy.hertz();
  heavy["young_modulus"] = 7e13, heavy["density"] = 2699e6;
  Description d =
      description("hertz-mindlin", alloy.hertz(), {{{0, 0, radius}, radius, {0, 0, -normal}, {0, spin, 0}}});
  Description list = d["bodies"]["grains"];
  list["material"] = "heavy";
  list["grains"]["grains"] = Description::array({{{"position", {0, 0, -large}}, {"radius", large}}});
  d["bodies"]["target"] = list;
  d["materials"]["heavy"] = heavy;
  d["time_step"]["value"] = alloy.duration(radius, normal) / 8000;
  Trial t(d);
  do t.step();
  while ((t.position(1) - t.position(0)).norm() < radius + large);
  const double impulse = alloy.friction * (1 + alloy.restitution) * normal;
  verify("tangential speed [m/s]", t.velocity(0).x(), impulse, 5e-3);
  verify("spin [rad/s]", t.spin(0).y(), spin - 2.5 * impulse / radius, 5e-3);
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

}  // namespace
}  // namespace grit::test
