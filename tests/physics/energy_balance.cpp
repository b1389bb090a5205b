// Energies of contacts and of changes of settings, compared with closed forms; closure of the energy balance.
#include <gtest/gtest.h>

#include <cmath>

#include "energy_balance.hpp"
#include "support/verified.hpp"

namespace grit::test::energy_balance_tests {
namespace {

TEST(Energies, OfAFallIsKineticAndGravitational) {
  Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius}});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["time_step"]["value"] = fall_step;
  Kept fall(d);
  fall.step(1000);
  const Energies now = fall.world().energies();
  EXPECT_LE(std::abs(now.closure_error), 1e-12 * now.kinetic);
  EXPECT_NEAR(now.gravitational, mass * 9.81 * fall.position(0).z(), 1e-12 * now.kinetic);
}

TEST(Energies, LocalDampingTakesItsShareOfTheWork) {
  Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius}});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.3}};
  d["time_step"]["value"] = fall_step;
  Kept fall(d);
  fall.step(1000);
  const Energies now = fall.world().energies();
  // A body at rest is not damped: the first half step is free.
  verify("share of a fall's energy that local damping takes", now.local_damping / -now.gravitational, 0.3, 2e-3);
  EXPECT_LE(std::abs(now.closure_error), 1e-3 * now.kinetic) << "the half step is damped by the full force";
}

// Damping increases the force that decelerates the grains and reduces the one that accelerates them: the spring takes
// 1 / (1 + λ) of their energy and returns 1 - λ of that.
TEST(Energies, LocalDampingTakesItsShareOfAnImpact) {
  const double speed = 0.1, damping = 0.3;
  Description d = grains("linear-rolling", {},
                         {{Vec3::Zero(), radius, {speed, 0, 0}}, {{2 * radius, 0, 0}, radius, {-speed, 0, 0}}});
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", damping}};
  Kept pair(d);
  pair.step(2000);
  const Energies now = pair.world().energies();
  const double before = 2 * kinetic_at(speed), left = (1 - damping) / (1 + damping);
  ASSERT_EQ(now.elastic(), 0) << "they are separated";
  EXPECT_NEAR(now.local_damping / before, 1 - left, 2e-3);
  EXPECT_NEAR(now.kinetic / before, left, 2e-3);
  EXPECT_LE(std::abs(now.closure_error), 1e-3 * before);
}

TEST(Energies, ADashpotTakesWhatRestitutionSays) {
  for (const std::string law : {"linear-frictional", "hertz-mindlin"}) {
    Description material{{"restitution", 0.5}, {"friction_angle", 0}};
    if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
    const double speed = 0.5;
    Description d =
        grains(law, material, {{Vec3::Zero(), radius, {speed, 0, 0}}, {{2.01 * radius, 0, 0}, radius, {-speed, 0, 0}}});
    d["time_step"]["value"] = 2e-8;
    Kept hit(d);
    do hit.step();
    while (hit.velocity(0).x() > 0 || !hit.world().contacts().empty());
    const Energies now = hit.world().energies();
    const double start = 2 * kinetic_at(speed);
    verify("share of the energy that the dashpot takes at restitution 0.5, " + law, now.viscosity / start, 0.75,
           law == "hertz-mindlin" ? 1e-4 : 1e-3);
    verify("closure error over the energy of a damped collision, " + law, now.closure_error / start, 0, 1e-5, 1.0);
    EXPECT_EQ(now.friction, 0);
  }
}

TEST(Energies, ABallThatSlidesUntilItRollsLosesTwoSevenths) {
  for (const std::string law : {"linear-frictional", "linear-rolling", "hertz-mindlin"}) {
    Description material{{"friction_angle", 0.2}};
    if (law == "linear-rolling") material["rolling_limit"] = 0;
    if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
    const double speed = 0.3;
    Description d = grains(law, material, {{{0, 0, 0.9999 * radius}, radius, {speed, 0, 0}}});
    d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -100}}};
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["time_step"]["safety"] = 0.1;
    Kept slide(d);
    while (slide.spin(0).y() * radius < 0.999 * slide.velocity(0).x()) slide.step(100);
    slide.step(5000);
    const Energies now = slide.world().energies();
    verify("energy lost over kinetic energy of a ball that slides until it rolls, " + law,
           now.friction / kinetic_at(speed), 2.0 / 7, law == "hertz-mindlin" ? 1e-2 : 5e-3);
    verify("closure error over the energy of a ball that slides until it rolls, " + law,
           now.closure_error / kinetic_at(speed), 0, 5e-3, 1.0);
  }
}

Description rough(const std::string& law, double friction_angle) {
  Description material{{"friction_angle", friction_angle}};
  if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
  else material["contact_modulus"] = 1e7;
  if (law == "linear-rolling") material["rolling_stiffness"] = 0;
  return material;
}

TEST(Energies, FrictionOfDeepContactsIsWhatMotionLoses) {
  // Slip is computed with the radii as arms; the centres of bodies that overlap move less. The force on them is larger
  // than that of the spring by as much, 5 % at the start.
  for (const std::string law : {"linear-rolling", "linear-frictional", "hertz-mindlin"})
    for (const double ratio : {1.0, 4.0}) {
      const double other = radius / ratio;
      const Vec3 apart(0.95 * (radius + other), 0, 0), across(0, 2, 0), spin(0, 0, 3 / radius);
      Description d = grains(law, rough(law, 0.02),
                             {{Vec3::Zero(), radius, across, spin}, {apart, other, -across, Vec3(0, 0, -1 / radius)}});
      d["time_step"]["safety"] = 0.1 * safety;
      d["guards"]["overlap"] = 0.3;
      Kept slide(d);
      while (slide.kernel().state().pairs.touching_count() > 0) slide.step(10);
      const Energies now = slide.world().energies();
      EXPECT_GT(now.friction, 1e-3 * now.kinetic);
      EXPECT_EQ(now.elastic(), 0);
      verify("friction of two of a ratio of " + std::string(ratio == 1 ? "1" : "4") +
                 " that slide and overlap by a twentieth, over what motion lost, " + law,
             now.friction / (now.friction - now.closure_error), 1, 2e-3);
    }
}

TEST(Energies, ABallThatIsPressedDeepAndRollsDownASlopeLosesNothing) {
  for (const std::string law : {"linear-rolling", "linear-frictional", "hertz-mindlin"}) {
    const double depth = 0.1, angle = 0.4, contact_modulus = 1e7;
    const double pressed =
        law == "hertz-mindlin" ? 0.02 * 1e8 * radius * radius : contact_modulus * radius * depth * radius;
    Description d = grains(law, rough(law, 1.3), {{{0, 0, (1 - depth) * radius}, radius}});
    const double g = pressed / (mass * std::cos(angle));
    d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {g * std::sin(angle), 0, -g * std::cos(angle)}}};
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());

    Kept roll(d);
    while (roll.position(0).x() < 20 * radius) roll.step(10);
    const Energies now = roll.world().energies();
    EXPECT_LE(now.friction, 1e-3 * now.kinetic) << "it sticks";
    verify("closure error over the energy of a ball that is pressed deep and rolls down a slope, " + law,
           now.closure_error / now.kinetic, 0, 2e-3, 1.0);
  }
}

TEST(Energies, RollingResistanceTakesWhatIsLeft) {
  const double speed = 0.1;
  Description d = grains("linear-rolling", {{"friction_angle", 0.5}, {"rolling_limit", 0.01}},
                         {{{0, 0, 0.9999 * radius}, radius, {speed, 0, 0}, {0, speed / radius, 0}}});
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -1000}}};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["time_step"]["safety"] = 0.1;
  Kept roll(d);
  const double start = roll.world().energies().kinetic;
  while (roll.spin(0).y() > 0) roll.step(100);
  const Energies now = roll.world().energies();
  verify("energy that rolling resistance takes of a ball that rolls to rest, over its kinetic energy",
         now.rolling / start, 1, 2e-2);
  verify("closure error over the energy of a ball that rolls to rest", now.closure_error / start, 0, 5e-3, 1.0);
}

// Nothing is summed up before the first request; from then on everything, with the same motion.
TEST(Energies, OneThatBeginsLateIsTheRestOfAnEarlyOne) {
  Description d = grains("linear-rolling", {{"friction_angle", 0.2}, {"rolling_limit", 0.01}},
                         {{{0, 0, 0.9999 * radius}, radius, {0.3, 0, 0}}});
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {1, 0, -1000}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.1}};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["floor"]["motion"]["velocity"] = {0, 0, 1e-3};
  d["time_step"]["safety"] = 0.1;
  Kept early(d);
  Trial late(d, 1, BodyState::energy);
  early.step(500), late.step(500);
  const Energies before = early.world().energies();
  EXPECT_EQ(late.world().energies().dissipated(), 0);
  early.step(500), late.step(500);
  const Energies whole = early.world().energies(), rest = late.world().energies();
  EXPECT_EQ(early.position(0), late.position(0));
  for (const auto member : {&Energies::friction, &Energies::rolling, &Energies::local_damping, &Energies::gravitational,
                            &Energies::walls}) {
    EXPECT_NE(rest.*member, 0);
    EXPECT_NEAR(rest.*member, whole.*member - before.*member, 1e-12 * std::abs(whole.*member));
  }
}

TEST(Energies, AWallsWorkIsStored) {
  Description d = grains("linear-frictional", {{"friction_angle", 0}}, {{{0, 0, radius}, radius}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["lid"] = plane({0, 0, 2 * radius}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -1e-3};
  Kept press(d);
  while (press.kernel().state().walls.states()[1].pose.shift.z() > -1e-5) press.step(100);
  const Energies now = press.world().energies();
  EXPECT_GT(now.elastic_normal, 0);
  verify("energy stored over the work of a wall that presses a grain", now.elastic_normal / now.walls, 1, 2e-6);
  EXPECT_LE(std::abs(now.closure_error), 1e-6 * now.walls);
}

TEST(Energies, AChangeOfStiffnessIsPutInBySettings) {
  Description d =
      grains("linear-frictional", {{"friction_angle", 0.2}}, {{Vec3::Zero(), radius}, {{1.99 * radius, 0, 0}, radius}});
  d["materials"]["grain"]["contact_modulus"] = 1e8;
  d["stages"].push_back({{"name", "stiffer"},
                         {"change", {{"materials", {{"grain", {{"contact_modulus", 3e8}}}}}}},
                         {"until", {{"type", "steps"}, {"value", 1}}},
                         {"limit", 1}});
  Kept part(d);
  const double before = part.world().energies().elastic();
  part.begin_stage(1, "stiffer");
  part.kernel().find_forces();
  Energies now = part.world().energies();
  EXPECT_NEAR(now.settings, 2 * before, 1e-12 * before);
  EXPECT_NEAR(now.elastic(), 3 * before, 1e-12 * before);
  EXPECT_LE(std::abs(now.closure_error), 1e-12 * before);
  part.step(2000);
  now = part.world().energies();
  EXPECT_EQ(now.elastic(), 0) << "they are separated";
  EXPECT_NEAR(now.kinetic, 3 * before, 2e-3 * before);
}

/// A compressed packing: closure error over all work done.
double closure_of_a_packing(double share_of_critical, double modulus) {
  const Vec3 low = Vec3::Zero(), high = Vec3::Constant(6e-3);
  Description d = description("linear-rolling", {{"contact_modulus", modulus}, {"density", 2600}},
                              jumble({6, 6, 6}, 1e-3, 0.005, 5));
  const char* const names[3][2] = {{"left", "right"}, {"front", "back"}, {"bottom", "lid"}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][names[axis][up ? 0 : 1]] = side(axis, up ? low[axis] : high[axis], low, high, up);
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -0.2};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.2}};
  d["time_step"]["safety"] = share_of_critical;
  d["guards"]["overlap"] = 0.9;
  Kept press(d);
  while (press.world().time() < 1.5e-3) press.step();
  const Energies now = press.world().energies();
  EXPECT_GT(now.friction, 0.01 * now.walls);
  EXPECT_GT(now.local_damping, 0.01 * now.walls);
  EXPECT_GT(now.walls, 0);
  return std::abs(now.closure_error) / (now.walls + now.dissipated());
}

TEST(Energies, WhatASpringHeldGoesWithTheSettingThatSwitchesItOff) {
  for (const std::string law : {"linear-rolling", "linear-frictional", "hertz-mindlin"})
    for (const std::string off :
         {"shear_to_normal_stiffness", "friction_angle", "rolling_stiffness", "rolling_limit"}) {
      SCOPED_TRACE(law + ", " + off);
      const bool rolls = law != "linear-frictional", hertz = law == "hertz-mindlin";
      if ((!rolls && off.starts_with("rolling")) || (hertz && off == "shear_to_normal_stiffness")) continue;
      Description d = grains(law, {{"friction_angle", 0.5}},
                             {{Vec3::Zero(), radius}, {{1.99 * radius, 0, 0}, radius, {0, 1e-3, 0}, {0, 0, 3}}});
      auto& grain = d["materials"]["grain"];
      if (rolls) grain["rolling_stiffness"] = 0.7, grain["rolling_limit"] = 0.4;
      // Another pair keeps the feature active.
      d["materials"]["other"] = grain;
      d["stages"].push_back({{"name", "without"},
                             {"change", {{"materials", {{"grain", {{off, 0}}}}}}},
                             {"until", {{"type", "steps"}, {"value", 1}}},
                             {"limit", 1}});
      Kept pair(d);
      pair.step(40);
      const Energies before = pair.world().energies();
      ASSERT_GT(off.starts_with("rolling") ? before.elastic_rolling : before.elastic_shear, 0);
      pair.begin_stage(1, "without");
      pair.kernel().find_forces();
      const Energies now = pair.world().energies();
      EXPECT_LT(now.settings, 0);
      EXPECT_NEAR(now.friction + now.rolling, before.friction + before.rolling, 1e-12 * before.elastic());
      // Half a step of the removed force, of the 40 steps of loading.
      EXPECT_NEAR(now.closure_error, before.closure_error, -0.05 * now.settings);
    }
}

TEST(Energies, OfAPackingClosesBetterWithShorterSteps) {
  const double coarse = closure_of_a_packing(0.8, 1e7), fine = closure_of_a_packing(0.1, 1e7);
  verify("closure error of a packing pressed at 0.1 of the critical step, over work and dissipation", fine, 0, 0.01,
         1.0);
  EXPECT_LE(fine, 0.5 * coarse);
}

}  // namespace
}  // namespace grit::test::energy_balance_tests
