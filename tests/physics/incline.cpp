// A sphere on a plane: sliding, rolling without slip, at rest; each limit from both sides. The plane is horizontal and
// gravity is inclined.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::incline_tests {
namespace {

constexpr double g = 9.81, radius = 0.01, density = 2500, modulus = 1e8, young = 1e11, poisson = 0.3;

/// A sphere on the plane with the overlap by its weight; `friction` is a coefficient.
Description on_plane(const std::string& law, double friction, double slope, Description material = {}) {
  const double angle = std::atan(slope), stiffness = modulus * radius;
  const double mass = density * 4 / 3 * std::numbers::pi * std::pow(radius, 3), weight = mass * g * std::cos(angle);
  const double curved = 4.0 / 3 * young / (2 * (1 - poisson * poisson)) * std::sqrt(radius);
  const double sunk = law == "hertz-mindlin" ? std::pow(weight / curved, 2.0 / 3) : weight / stiffness;
  material["density"] = density;
  if (law == "hertz-mindlin") material["young_modulus"] = young, material["poisson_ratio"] = poisson;
  else material["contact_modulus"] = modulus;
  material["friction_angle"] = std::atan(friction);
  Description d = description(law, material, {{{0, 0, radius - sunk}, radius}});
  d["walls"]["slope"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {g * std::sin(angle), 0, -g * std::cos(angle)}}};
  return d;
}
/// Damped shear, so that the spring of a new contact comes to rest soon.
Description frictional(double friction, double slope) {
  Description d = on_plane("linear-frictional", friction, slope, {{"restitution", 0.3}});
  d["contacts"]["shear_damping"] = true;
  return d;
}
/// Rolling resistance; local damping brings the springs of a sticking sphere to rest and does not change the limits.
Description resisting(const std::string& law, double friction, double limit, double slope, double damping) {
  Description d = on_plane(law, friction, slope, {{"rolling_limit", limit}, {"rolling_stiffness", 0.7}});
  if (damping > 0) d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", damping}};
  return d;
}

struct Rates {
  double acceleration, spinning;  ///< m/s², rad/s²
};
/// By least squares over the second half of a time: oscillations of undamped springs average out.
Rates rates(const Description& d, double time) {
  Trial t(d);
  while (t.world().time() < 0.5 * time) t.step();
  double tt = 0, tv = 0, tw = 0, n = 0;
  Vec3 mean = Vec3::Zero();  // time, speed, spin
  for (; t.world().time() < time; t.step()) {
    const Vec3 now(t.world().time(), t.velocity(0).x(), t.spin(0).y());
    const double weight = n / (n + 1), before = now[0] - mean[0];
    tt += weight * before * before, tv += weight * before * (now[1] - mean[1]),
        tw += weight * before * (now[2] - mean[2]);
    mean += (now - mean) / ++n;
  }
  return {tv / tt, tw / tt};
}
double down(double slope) { return g * std::sin(std::atan(slope)); }
double normal(double slope) { return g * std::cos(std::atan(slope)); }

TEST(Incline, SphereSlidesBelowTwoSeventhsOfTheSlope) {
  Errors along("acceleration of a sphere that slides, error over g");
  for (const double slope : {0.3, 1.0})
    for (const double share : {0.3, 0.9, 0.99}) {
      const double friction = share * 2.0 / 7 * slope;
      const Rates now = rates(frictional(friction, slope), 0.2);
      // The arm of friction is the radius less an overlap of 1e-5 of it.
      along.add((now.acceleration - (down(slope) - friction * normal(slope))) / g);
      EXPECT_NEAR(now.spinning * radius / (2.5 * friction * normal(slope)), 1, 2e-5) << slope << ' ' << share;
      EXPECT_GT(now.acceleration - now.spinning * radius, 0.9 * (1 - share) * down(slope)) << "it slips";
    }
  along.verify(1e-11);
}

TEST(Incline, SphereRollsAboveTwoSeventhsOfTheSlope) {
  Errors along("acceleration of a sphere that rolls, error over g");
  for (const double slope : {0.3, 1.0})
    for (const double share : {1.01, 1.1, 3.0}) {
      const Rates now = rates(frictional(share * 2.0 / 7 * slope, slope), 0.2);
      // 5/7 holds for a contact point at the radius; the overlap is 1e-5 of it.
      along.add((now.acceleration - 5.0 / 7 * down(slope)) / g);
      EXPECT_NEAR(now.spinning * radius, now.acceleration, 1e-11 * g) << slope << ' ' << share;
    }
  along.verify(3e-6);
}

TEST(Incline, SlippingSphereRollsAtFiveSeventhsOfItsSpeed) {
  const double friction = 0.3, speed = 0.5;
  Description d = frictional(friction, 0);
  d["bodies"]["grains"]["source"]["bodies"][0]["velocity"] = {speed, 0, 0};
  Trial t(d);
  const auto slip = [&] { return t.velocity(0).x() - radius * t.spin(0).y(); };
  double before = slip(), rolls_at = 0;
  for (; slip() > 1e-3 * speed; t.step()) before = slip(), rolls_at = t.world().time();
  before = slip(), rolls_at = t.world().time();
  t.step(10);
  const double end = 2 * speed / (7 * friction * g);
  // Slip decreases at 7/2 μ g until the end, except for the 1e-7 m of initial spring elongation.
  verify("time that a slipping sphere takes to roll [s]", rolls_at + before / (3.5 * friction * g), end, 2e-5);
  while (t.world().time() < 2 * end) t.step();
  verify("speed of a slipping sphere when it rolls, over that at first", t.velocity(0).x() / speed, 5.0 / 7, 7e-6);
  EXPECT_NEAR(t.spin(0).y() * radius / speed, 5.0 / 7, 5e-6);
}

class RollingResistance : public testing::TestWithParam<const char*> {
 protected:
  const std::string law = GetParam();
};

TEST_P(RollingResistance, HoldsUpToTheAngleThatItGives) {
  Errors creep("speed of a ball that rolling resistance holds, " + law + ", error over √(g R)");
  Errors along("acceleration of a ball that rolls against resistance, " + law + ", error over g");
  for (const double limit : {0.05, 0.4}) {
    const double friction = 0.8;
    for (const double share : {0.5, 0.9, 0.99}) {
      Trial t(resisting(law, friction, limit, share * limit, 0.3));
      while (t.world().time() < 0.15) t.step();
      const Vec3 place = t.position(0);
      while (t.world().time() < 0.2) t.step();
      EXPECT_LT((t.position(0) - place).norm(), 1e-15) << limit << ' ' << share;
      EXPECT_LT(t.velocity(0).norm(), 1e-12) << limit << ' ' << share;
      creep.add(t.velocity(0).norm() / std::sqrt(g * radius));
    }
    for (const double share : {1.01, 1.1, 1.5}) {
      const double slope = share * limit;
      const Rates now = rates(resisting(law, friction, limit, slope, 0), 0.2);
      along.add((now.acceleration - 5.0 / 7 * (down(slope) - limit * normal(slope))) / g);
      EXPECT_NEAR(now.spinning * radius, now.acceleration, 5e-6 * g) << limit << ' ' << share;
    }
  }
  creep.verify(1e-11);
  along.verify(5e-6);
}

TEST_P(RollingResistance, HasABallSlideAboveTheAngleOfFrictionThatItKeepsFromRolling) {
  const double friction = 0.3, limit = 2;
  Trial t(resisting(law, friction, limit, 0.99 * friction, 0.3));
  while (t.world().time() < 0.15) t.step();
  const Vec3 place = t.position(0);
  while (t.world().time() < 0.2) t.step();
  EXPECT_LT((t.position(0) - place).norm(), 1e-15);
  Errors along("acceleration of a ball that slides and cannot roll, " + law + ", error over g");
  for (const double share : {1.01, 1.5}) {
    const double slope = share * friction;
    const Rates now = rates(resisting(law, friction, limit, slope, 0), 0.2);
    along.add((now.acceleration - (down(slope) - friction * normal(slope))) / g);
    EXPECT_NEAR(now.spinning * radius, 0, 2e-5 * g) << share;
  }
  along.verify(1e-11);
}

INSTANTIATE_TEST_SUITE_P(Incline, RollingResistance, testing::Values("linear-rolling", "hertz-mindlin"),
                         [](const auto& info) { return std::string(info.index == 0 ? "Linear" : "Hertz"); });

}  // namespace
}  // namespace grit::test::incline_tests
