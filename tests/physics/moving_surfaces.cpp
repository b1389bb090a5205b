// Belts and turntables, whose surfaces move while the walls stay, and walls that rotate freely under their moments.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/error.hpp"
#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::moving_surface_tests {
namespace {

constexpr double radius = 1e-3, gravity = 9.81, density = 2500, modulus = 1e7;
const double mass = density * 4.0 / 3 * std::numbers::pi * radius * radius * radius;

/// A ball at rest on a floor.
Description on_a_floor(const Vec3& place = Vec3::Zero()) {
  const double overlap = mass * gravity / (modulus * radius);
  Description d = description(
      "linear-frictional",
      {{"density", density}, {"contact_modulus", modulus}, {"friction_angle", std::atan(0.3)}, {"restitution", 0.5}},
      {{place + (radius - overlap) * Vec3::UnitZ(), radius}});
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -gravity}}};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  return d;
}

double energy_error(const World& world) {
  const Energies now = world.energies();
  return now.closure_error / std::abs(now.walls);
}

TEST(MovingSurface, BeltSlipsUnderABallUntilItRolls) {
  const double speed = 0.2, friction = 0.3;
  Description d = on_a_floor();
  d["walls"]["floor"]["motion"]["surface_velocity"] = {speed, 0, 0};
  d["time_step"]["safety"] = 0.1;
  Trial trial(d, 1, BodyState::energy);
  trial.world().energies();
  // v = μ g t and R ω = 5/2 μ g t until v + R ω = V at the contact point.
  const double rolls = 2 * speed / (7 * friction * gravity);
  while (trial.world().time() < 0.5 * rolls) trial.step();
  const double time = trial.world().time();
  verify("speed of a ball on which a belt slips, over μ g t", trial.velocity(0).x() / (friction * gravity * time), 1,
         2e-3);
  verify("spin of a ball on which a belt slips, over 5 μ g t / (2 R)",
         -trial.spin(0).y() * radius / (2.5 * friction * gravity * time), 1, 2e-3);
  while (trial.world().time() < 3 * rolls) trial.step();
  verify("speed of a ball that rolls on a belt, over that of the belt", trial.velocity(0).x() / speed, 2.0 / 7, 3e-3);
  verify("speed of its surface by rotation, over that of the belt", -trial.spin(0).y() * radius / speed, 5.0 / 7, 3e-3);
  const Energies now = trial.world().energies();
  verify("heat over the work of a belt", now.dissipated() / now.walls, 0.5, 1e-2);
  verify("closure error over the work of a belt", energy_error(trial.world()), 0, 1e-3, 1.0);
  EXPECT_EQ(trial.world().walls()[0].position, Vec3::Zero());
}

TEST(MovingSurface, BeltActsAsAPlateThatMoves) {
  Description belt = on_a_floor(), plate = belt;
  belt["walls"]["floor"]["motion"] = {{"surface_velocity", {0.1, -0.05, 0}}, {"ramp_time", 1e-3}};
  plate["walls"]["floor"]["motion"] = {{"velocity", {0.1, -0.05, 0}}, {"ramp_time", 1e-3}};
  Trial one(belt), other(plate);
  for (int n = 0; n < 2000; ++n) {
    one.step(), other.step();
    ASSERT_EQ(one.world().dt(), other.world().dt());
    ASSERT_LT((one.position(0) - other.position(0)).norm(), 1e-13) << n;
    ASSERT_LT((one.spin(0) - other.spin(0)).norm(), 1e-8) << n;
  }
  EXPECT_GT(one.velocity(0).x(), 0.01);
}

/// Only the part along the surface counts: a belt does not push.
TEST(MovingSurface, BeltNeverMovesAlongItsNormal) {
  Description along = on_a_floor(), askew = along;
  along["walls"]["floor"]["motion"]["surface_velocity"] = {0.1, 0, 0};
  askew["walls"]["floor"]["motion"]["surface_velocity"] = {0.1, 0, 0.7};
  Trial one(along), other(askew);
  one.step(1000), other.step(1000);
  EXPECT_EQ(one.position(0), other.position(0));
  EXPECT_EQ(one.velocity(0), other.velocity(0));
}

TEST(MovingSurface, FastBeltIsNoDanger) {
  Description d = on_a_floor();
  auto& motion = d["walls"]["floor"]["motion"];
  motion["surface_velocity"] = {50, 0, 0}, motion["surface_spin"] = {0, 0, 100};
  Trial trial(d);
  const double dt = trial.world().dt();
  EXPECT_GT(dt * 50, 0.05 * radius) << "more than the travel guard allows a body";
  trial.step(100);
  EXPECT_EQ(trial.world().dt(), dt);
  EXPECT_GT(trial.velocity(0).x(), 0);
  motion.erase("surface_velocity"), motion.erase("surface_spin");
  motion["velocity"] = {0, 0, 50};
  EXPECT_THROW(Trial(d).step(100), NumericsError);
}

/// A drum whose surface turns is a drum that turns; a ball climbs and slips in it.
TEST(MovingSurface, SurfaceThatSpinsActsAsADrumThatSpins) {
  Description d = on_a_floor({0, 0.3 * radius, 0});
  d["contacts"]["type"] = "linear-rolling";  // which also depends on the relative rotation
  d["materials"]["grain"] = {
      {"density", density}, {"contact_modulus", modulus}, {"friction_angle", 0.8}, {"rolling_limit", 0.1}};
  d["walls"] = {{"drum",
                 {{"type", "cylinder"},
                  {"start", {0, -2 * radius, 5 * radius}},
                  {"end", {0, 2 * radius, 5 * radius}},
                  {"radius", 5 * radius},
                  {"material", "grain"}}}};
  d["time_step"]["safety"] = 0.1;
  Description surface = d, whole = d;
  surface["walls"]["drum"]["motion"]["surface_spin"] = {0, 30, 0};
  whole["walls"]["drum"]["motion"]["spin"] = {0, 30, 0};
  Trial one(surface, 1, BodyState::energy), other(whole, 1, BodyState::energy);
  one.world().energies(), other.world().energies();
  double highest = 0;
  while (one.world().time() < 0.1) {
    one.step(), other.step();
    ASSERT_LT((one.position(0) - other.position(0)).norm(), 1e-6 * radius);
    highest = std::max(highest, one.position(0).z());
  }
  EXPECT_GT(highest, 1.05 * radius);
  EXPECT_NEAR(one.world().energies().walls / other.world().energies().walls, 1, 1e-6);
  EXPECT_NEAR(energy_error(one.world()), energy_error(other.world()), 1e-6);
  EXPECT_LT(std::abs(energy_error(one.world())), 1e-2);
}

/// A plate that turns freely about an edge, with a ball that comes towards it.
TEST(FreeRotation, KeepsEnergyAndAngularMomentumInAnElasticImpact) {
  const double speed = 0.1, arm = 8 * radius, inertia = 0.4 * mass * arm * arm;
  Description d =
      description("linear-frictional", {{"density", density}, {"contact_modulus", modulus}, {"friction_angle", 0}},
                  {{{arm, 0, 1.01 * radius}, radius, {0, 0, -speed}}});
  d["walls"]["flap"] = {
      {"type", "rectangle"},
      {"corner", {0, -radius, 0}},
      {"edge_a", {10 * radius, 0, 0}},
      {"edge_b", {0, 2 * radius, 0}},
      {"material", "grain"},
      {"motion", {{"about", {0, 0, 0}}, {"free_rotation", {{"axis", {0, 2, 0}}, {"inertia", inertia}}}}}};
  d["time_step"]["safety"] = 0.02;
  Trial trial(d);
  while (trial.world().time() < 2e-3) trial.step();
  EXPECT_TRUE(trial.world().contacts().empty() && trial.world().walls()[0].contacts == 0);
  const double impulse = 2 * speed / (1 / mass + arm * arm / inertia);  // elastic, at the arm
  verify("spin of a flap hit by a ball [rad/s]", trial.world().walls()[0].spin.y(), impulse * arm / inertia, 2e-3);
  verify("speed of the ball afterwards [m/s]", trial.velocity(0).z(), impulse / mass - speed, 2e-3, speed);
  const double spin = trial.world().walls()[0].spin.norm();
  const double energy = 0.5 * mass * trial.velocity(0).squaredNorm() + 0.5 * inertia * spin * spin;
  verify("energy of ball and flap, over that before", energy / (0.5 * mass * speed * speed), 1, 1e-3);
}

/// A motor on a turntable: the ball on it takes part of its moment.
TEST(FreeRotation, DrivenByAMomentCarriesItsLoadAlong) {
  const double arm = 2 * radius, inertia = 3 * mass * arm * arm, moment = 0.2 * mass * gravity * arm;
  Description d = on_a_floor({arm, 0, 0});
  d["contacts"]["type"] = "linear-rolling";
  d["materials"]["grain"] = {{"density", density},     {"contact_modulus", modulus}, {"friction_angle", std::atan(0.8)},
                             {"rolling_stiffness", 1}, {"rolling_limit", 4},         {"twisting_stiffness", 1},
                             {"twisting_limit", 4}};
  d["walls"]["floor"]["motion"]["free_rotation"] = {{"axis", {0, 0, 1}}, {"inertia", inertia}, {"moment", moment}};
  d["time_step"]["safety"] = 0.1;
  Trial trial(d, 1, BodyState::energy);
  trial.world().energies();
  while (trial.world().time() < 0.05) trial.step();
  const double all = inertia + mass * arm * arm + 0.4 * mass * radius * radius;
  verify("spin of a turntable that a motor drives with a ball on it, over M t / I",
         trial.world().walls()[0].spin.z() / (moment * trial.world().time() / all), 1, 5e-3);
  verify("closure error over the work of a turntable", energy_error(trial.world()), 0, 1e-3, 1.0);
}

}  // namespace
}  // namespace grit::test::moving_surface_tests
