// The friction of a ball that rolls over a bend of its floor is continuous; about an edge it pivots without slip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include "support/scene.hpp"
#include "support/stl_file.hpp"
#include "support/verified.hpp"

namespace grit::test::bends_tests {
namespace {

// The overlap by the weight is 7e-4 of the radius. Gravity is inclined, so that friction is 2/7 of its tangential
// component.
constexpr double radius = 1e-3, gravity = 2e4, lean = 0.2, speed = 0.02, sunk = 7e-4 * radius, ahead = 1e-4;

struct Law {
  std::string name;
  bool shear_dashpot;
  friend void PrintTo(const Law& law, std::ostream* stream) {
    *stream << law.name << (law.shear_dashpot ? ", damped" : "");
  }
};

/// A ball that rolls towards x = 0, with `aside` of its velocity along y.
Description rolling_ball(const Law& law, double aside) {
  const Vec3 way = Vec3(1, aside, 0).normalized();
  const Grain ball{Vec3(0, 0, radius - sunk) - ahead / way.x() * way, radius, speed * way,
                   speed / radius * Vec3::UnitZ().cross(way)};
  Description d = description(law.name, {{"friction_angle", "40 deg"}}, {ball});
  Description& material = d["materials"]["grain"];
  if (law.name == "hertz-mindlin") material["young_modulus"] = 1e9;
  if (law.name == "linear-frictional") d["contacts"]["shear_damping"] = law.shear_dashpot;
  if (law.name == "linear-rolling") material["rolling_limit"] = 1e-3;
  else material["restitution"] = 0.3;
  if (!law.shear_dashpot) d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.3}};
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {gravity * lean, 0, -gravity}}};
  d["time_step"]["value"] = 1e-7;
  return d;
}

/// Two floors that meet at x = 0 at an angle `bend`.
std::vector<Vec3> bent_floor(double bend) {
  const Vec3 first(-5 * radius, 0, 0), second(5 * radius * std::cos(bend), 0, 5 * radius * std::sin(bend)),
      side(0, 5 * radius, 0);
  return {first - side, -side,         side,          first - side, side,          first + side,
          -side,        second - side, second + side, -side,        second + side, side};
}

/// Friction of the floor on the ball, in one contact.
struct Hold {
  Vec3 normal, friction;
};
Hold hold(const Trial& trial) {
  const auto contacts = trial.world().contacts();
  EXPECT_EQ(contacts.size(), 1u) << trial.position(0).transpose();
  const Contact& one = contacts.front();
  return {one.normal, one.normal_force * one.normal - one.force};
}

class Bends : public testing::TestWithParam<std::tuple<Law, double>> {};

// In a valley only the normal may jump; over a ridge it rotates, and friction changes as pivoting requires.
TEST_P(Bends, AreNoJerkToABallThatRolls) {
  const auto& [law, bend] = GetParam();
  Errors jerk("friction's jump at a bend beyond what the bend, its turn and the floor before it make, over friction");
  Errors turning("turn of the normal over a bend, change over the bend");
  for (const double aside : {0.0, 0.3}) {
    const StlFile file(stl_text(bent_floor(bend)));
    Description d = rolling_ball(law, aside);
    d["walls"]["floor"] = {
        {"type", "mesh"}, {"path", file.path()}, {"scale", 1.0}, {"open", true}, {"material", "grain"}};
    Trial trial(d);
    const double near = 1.1 * std::abs(bend) * radius;
    Hold last = hold(trial);
    double ordinary = 0, turned = 0;  // change of friction in one step away from the bend
    for (int step = 0; trial.position(0).x() < 0.3 * ahead + near; ++step) {
      ASSERT_LT(step, 20000) << "it crossed the bend";
      trial.step();
      const Hold now = hold(trial);
      const double change = (now.friction - last.friction).norm(), turn = (now.normal - last.normal).norm();
      if (std::abs(trial.position(0).x()) > near && turn == 0) ordinary = std::max(ordinary, change);
      else {
        const double asked = (std::abs(bend) + turn) * last.friction.norm() + 1.5 * ordinary;
        EXPECT_LE(change, asked) << "at " << trial.position(0).transpose() << ", " << last.friction.norm();
        jerk.add(std::max(0.0, change - asked) / last.friction.norm());
      }
      turned += turn;
      last = now;
    }
    turning.add(turned / std::abs(bend) - 1);
  }
  jerk.verify(0), turning.verify(1e-3);
}

// A ball tips over an edge as a rigid body that rotates about it: the velocity of its centre is (R − δ) ω, not R ω.
// Shear springs are stiff, so that their deformation by the growing friction is smaller than this difference.
TEST(Edge, IsPivotedAboutWithoutSlip) {
  constexpr double ball = 0.01, depth = 0.01 * ball, g = 9.81, density = 2600, pi = std::numbers::pi;
  const double modulus = density * 4 / 3 * pi * ball * ball * g / depth;  // same overlap by its weight
  Description d = description("linear-frictional",
                              {{"contact_modulus", modulus},
                               {"density", density},
                               {"friction_angle", "80 deg"},
                               {"restitution", 0.1},
                               {"shear_to_normal_stiffness", 10}},
                              {{Vec3(-2e-4, 0, ball - depth), ball, {0.02, 0, 0}, {0, 0.02 / ball, 0}}});
  d["contacts"]["shear_damping"] = true;
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["time_step"]["value"] = 1e-5;
  d["walls"]["shelf"] = {{"type", "rectangle"},
                         {"corner", {-0.1, -0.1, 0}},
                         {"edge_a", {0.1, 0, 0}},
                         {"edge_b", {0, 0.2, 0}},
                         {"material", "grain"}};
  Trial trial(d);
  const auto angle = [&] { return std::atan2(trial.position(0).x(), trial.position(0).z()); };
  int steps = 0;
  Errors slip("slip of a ball that tips over an edge, over its speed");
  for (; angle() < 0.5; ++steps) {
    ASSERT_LT(steps, 100000);
    trial.step();
    if (angle() < 0.2) continue;
    const Vec3 arm = trial.position(0), along = Vec3::UnitY().cross(arm).normalized();
    ASSERT_EQ(trial.world().contacts().size(), 1u);
    slip.add(trial.velocity(0).dot(along) / (arm.norm() * trial.spin(0).y()) - 1);
  }
  slip.verify(1e-3);
}

const Law laws[] = {
    {"linear-frictional", true}, {"linear-frictional", false}, {"linear-rolling", false}, {"hertz-mindlin", true}};

INSTANTIATE_TEST_SUITE_P(All, Bends,
                         testing::Combine(testing::ValuesIn(laws),
                                          testing::Values(0.001, 0.01, 0.05, -0.001, -0.01, -0.05)));

}  // namespace
}  // namespace grit::test::bends_tests
