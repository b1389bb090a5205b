// Springs of one contact with a wall: displacement of a sticking ball by a small load, time until a spinning ball
// rests, and rebound of a ball that sticks in an oblique impact.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/contact/restitution.hpp"
#include "support/rebound.hpp"
#include "support/verified.hpp"

namespace grit::test::contact_springs_tests {
namespace {

using std::numbers::pi;

constexpr double radius = 0.01, density = 2500, modulus = 1e8, poisson = 0.3, shear_ratio = 0.3, g = 9.81;
const double mass = density * 4 / 3 * pi * radius * radius * radius;
/// Effective modulus of two equal solids.
constexpr double plane_modulus = modulus / (2 * (1 - poisson * poisson)),
                 shear_modulus = modulus / (4 * (2 - poisson) * (1 + poisson));

Description material(const std::string& law, double friction) {
  Description m{{"density", density}, {"friction_angle", std::atan(friction)}};
  if (law == "hertz-mindlin") m["young_modulus"] = modulus, m["poisson_ratio"] = poisson;
  else m["contact_modulus"] = modulus, m["shear_to_normal_stiffness"] = shear_ratio;
  if (law == "linear-rolling") m["rolling_limit"] = 0;
  return m;
}

/// Overlap by the weight.
double sunk(const std::string& law) {
  const double curved = 4.0 / 3 * plane_modulus * std::sqrt(radius);
  return law == "hertz-mindlin" ? std::pow(mass * g / curved, 2.0 / 3) : mass * g / (modulus * radius);
}
double shear_stiffness(const std::string& law) {
  return law == "hertz-mindlin" ? 8 * shear_modulus * std::sqrt(radius * sunk(law)) : shear_ratio * modulus * radius;
}

Description on_floor(const std::string& law, const Description& solid, double lean) {
  Description d = description(law, solid, {{{0, 0, radius - sunk(law)}, radius}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {g * lean, 0, -g}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  return d;
}

/// Displacement of the ball by a load along the wall [m].
double moved(const Description& d) {
  Trial t(d);
  while (t.world().time() < 0.3) t.step();
  EXPECT_LT(t.velocity(0).norm(), 1e-12);
  return t.position(0).x();
}

TEST(ContactSprings, GiveWayAlongAWallAsTheirShearStiffnessSays) {
  constexpr double load = 1e-3;  // of the weight
  for (const std::string law : {"linear-frictional", "linear-rolling", "hertz-mindlin"}) {
    Description d = on_floor(law, material(law, 1), load);
    d["engines"]["hold"] = {{"type", "hold"}, {"rotation", "xyz"}};
    verify("way of a ball that cannot turn along a wall under a small load, " + law + " [m]", moved(d),
           load * mass * g / shear_stiffness(law), 1e-6);
  }
}

TEST(ContactSprings, GiveWayInRollingAsTheirStiffnessSays) {
  constexpr double load = 1e-4, ratio = 0.7;
  for (const std::string law : {"linear-rolling", "hertz-mindlin"}) {
    Description solid = material(law, 1);
    solid["rolling_stiffness"] = ratio, solid["rolling_limit"] = 1;
    // The load also rotates the ball: K_r = β K_s r².
    verify("way of a ball that resists rolling along a wall under a small load, " + law + " [m]",
           moved(on_floor(law, solid, load)), load * mass * g / shear_stiffness(law) * (1 + 1 / ratio), 1e-3);
  }
}

TEST(ContactSprings, TwistingBringsASpinOnTheSpotToRest) {
  constexpr double limit = 0.1, spin = 5;
  Description solid = material("linear-rolling", 1);
  solid["twisting_stiffness"] = 1, solid["twisting_limit"] = limit;
  Description d = on_floor("linear-rolling", solid, 0);
  d["engines"].erase("damping");
  d["bodies"]["grains"]["source"]["bodies"][0]["spin"] = {0, 0, spin};
  Trial t(d);
  while (t.world().time() < 0.01) t.step();
  const double first = t.world().time(), before = t.spin(0).z();
  while (t.world().time() < 0.015) t.step();
  verify("deceleration of a ball that spins on the spot [rad/s²]",
         (before - t.spin(0).z()) / (t.world().time() - first), 2.5 * limit * g / radius, 1e-9);
  while (t.world().time() < 0.1) t.step();
  EXPECT_LT(std::abs(t.spin(0).z()), 0.02 * spin) << "oscillates about rest";
}

// A sticking contact point oscillates with its own spring and 2/7 of the mass during loading and unloading.
TEST(ContactSprings, LinearOnesThatStickSwingAsLongAsTheContactLasts) {
  const double duration = pi / std::sqrt(modulus * radius / mass);
  for (const std::string law : {"linear-frictional", "linear-rolling"})
    for (const double ratio : {0.3, 0.8}) {
      Description solid = material(law, 1e6);
      solid["shear_to_normal_stiffness"] = ratio;
      const Vec3 in = aslant(0.01, 60);
      const Rebound out = from_plane(law, solid, solid, radius, in, Vec3::Zero(), duration / 2000);
      // The point is fast at the end of the contact, which is known to one step.
      const double allowed = ratio < 0.5 ? 1e-4 : 1e-3;
      const double turned = 2.0 / 7 * (1 - std::cos(pi * std::sqrt(3.5 * ratio)));
      char at[64];
      std::snprintf(at, sizeof at, ", %s, shear stiffness %.1f", law.c_str(), ratio);
      verify(std::string("tangential speed of a ball that sticks") + at + ", error over the speed before",
             out.velocity.x(), in.x() * (1 - turned), allowed, in.x());
      verify(std::string("spin of a ball that sticks") + at + ", error over the speed before per radius", out.spin.y(),
             2.5 * turned * in.x() / radius, allowed, in.x() / radius);
    }
}

TEST(ContactSprings, DashpotsInShearTakeTheirShare) {
  constexpr double ratio = 0.8;
  const double duration = pi / std::sqrt(modulus * radius / mass);
  for (const double restitution : {0.8, 0.5}) {
    Description solid = material("linear-frictional", 1e6);
    solid["shear_to_normal_stiffness"] = ratio, solid["restitution"] = restitution;
    const Vec3 in = aslant(0.01, 60);
    Description d = description("linear-frictional", solid, {{{0, 0, radius}, radius, in}});
    d["contacts"]["shear_damping"] = true;
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["time_step"]["value"] = duration / 4000;
    Trial t(d);
    do t.step();
    while (t.position(0).z() < radius);
    // The contact ends where tension would begin; until then the contact point moves as a damped oscillator with the
    // same fraction of critical damping.
    const double part = damping_of_restitution(restitution), slow = std::sqrt(1 - part * part);
    const double phase = 2 * std::acos(part) / slow * std::sqrt(3.5 * ratio);
    const double point = std::exp(-part * phase) * (std::cos(slow * phase) - part / slow * std::sin(slow * phase));
    char at[64];
    std::snprintf(at, sizeof at, ", restitution %.1f, error over the speed before", restitution);
    verify(std::string("tangential speed of a ball that sticks by damped springs") + at, t.velocity(0).x(),
           in.x() * (1 - 2.0 / 7 * (1 - point)), 2e-3, in.x());
  }
}

/// Hertz's spring and Mindlin's spring without slip, as a system of differential equations.
struct Swing {
  double overlap = 0, closing, force = 0, sliding;  ///< m, m/s; shear force [N]; velocity of the contact point [m/s]
};
Swing rate(const Swing& s) {
  const double depth = std::max(s.overlap, 0.0), contact = std::sqrt(radius * depth);
  Swing r{};
  r.overlap = s.closing, r.closing = -4.0 / 3 * plane_modulus * contact * depth / mass;
  r.sliding = -3.5 * s.force / mass;
  // Unloading reduces the shear force in proportion.
  r.force =
      8 * shear_modulus * contact * s.sliding + (s.closing < 0 && depth > 0 ? s.force * 0.5 * s.closing / depth : 0);
  return r;
}
Swing along(const Swing& s, const Swing& r, double dt) {
  return {s.overlap + dt * r.overlap, s.closing + dt * r.closing, s.force + dt * r.force, s.sliding + dt * r.sliding};
}

TEST(ContactSprings, HertzAndMindlinsThatStickFollowTheirEquations) {
  for (const double degrees : {10.0, 45.0, 80.0}) {
    const Vec3 in = aslant(0.01, degrees);
    Swing s{.closing = -in.z(), .sliding = in.x()};
    const double deepest = std::pow(1.25 * mass * in.z() * in.z() / (4.0 / 3 * plane_modulus * std::sqrt(radius)), 0.4);
    const double duration = 2.9432 * deepest / -in.z(), dt = duration / 200000;
    do {  // fourth-order Runge–Kutta
      const Swing a = rate(s), b = rate(along(s, a, dt / 2)), c = rate(along(s, b, dt / 2)), d = rate(along(s, c, dt));
      s = along(along(along(along(s, a, dt / 6), b, dt / 3), c, dt / 3), d, dt / 6);
    } while (s.overlap > 1e-6 * deepest);
    const Description solid = material("hertz-mindlin", 1e6);
    const Rebound out = from_plane("hertz-mindlin", solid, solid, radius, in, Vec3::Zero(), duration / 4000);
    const std::string at = ", hit at " + std::to_string(int(degrees)) + "°, error over the speed before";
    verify("tangential speed of a ball that sticks after Hertz and Mindlin" + at, out.velocity.x(),
           in.x() - 2.0 / 7 * (in.x() - s.sliding), 1e-3, in.x());
  }
}

}  // namespace
}  // namespace grit::test::contact_springs_tests
