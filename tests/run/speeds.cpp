// Speeds of bodies and walls: the time step follows them, and walls that spin are bounded by where bodies are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/error.hpp"
#include "support/scene.hpp"

namespace grit::test::speeds_tests {
namespace {

using testing::HasSubstr;

constexpr double radius = 5e-3;
const Description material{{"density", 2600}, {"contact_modulus", 1e6}, {"friction_angle", 0.4636476090008061}};

Description falling(const std::vector<Grain>& grains) {
  Description d = description("linear-frictional", material, grains);
  d["engines"]["gravity"] = {{"type", "gravity"}};
  return d;
}

/// A drum of 50 mm radius about the x axis, one revolution per second, with a grain near each of its ends.
Description drum(double length) {
  const double z = -(0.05 - radius - 1e-4);
  Description d = falling({{{0.01, 0, z}, radius}, {{length - 0.01, 0, z}, radius}});
  d["walls"]["drum"] = {
      {"type", "cylinder"},          {"start", {-0.1, 0, 0}},
      {"end", {length + 0.1, 0, 0}}, {"radius", 0.05},
      {"material", "grain"},         {"motion", {{"spin", {2 * std::numbers::pi, 0, 0}}, {"about", {0, 0, 0}}}}};
  return d;
}

/// How often neighbours, and candidates at walls alone, were searched.
struct Searches {
  std::uint64_t all = 0, at_walls = 0;
  bool operator==(const Searches&) const = default;
};
Searches searches(const Description& d, std::size_t steps) {
  Trial t(d);
  t.step(steps);
  const NeighbourLists& lists = t.kernel().state().lists;
  return {lists.rebuilds(), lists.searches_at_walls()};
}

TEST(SpinningDrum, CostsTheSameWhateverItsLength) { EXPECT_EQ(searches(drum(1), 1000), searches(drum(0.2), 1000)); }

TEST(SpinningDrum, DoesNotConsiderBodiesOutOfItsReach) {
  Description with_far_ball = drum(0.2);
  with_far_ball["bodies"]["grains"]["source"]["bodies"].push_back({{"position", {0.1, 2, 0}}, {"radius", radius}});
  // Without the bound of reach the surface would be credited with 2 m × 2π rad/s.
  EXPECT_LT(searches(with_far_ball, 1000).at_walls, searches(drum(0.2), 1000).at_walls + 10);
}

TEST(SpinningDrum, SearchesNoNeighboursWhereBodiesAreAtRest) {
  Description d = drum(0.2);
  d.erase("engines");  // nothing touches the drum
  const Searches found = searches(d, 1000);
  EXPECT_EQ(found.all, 1u);
  EXPECT_GT(found.at_walls, 5u);
  EXPECT_LT(found.at_walls, 100u) << "a skin lasts some dozens of steps";
}

TEST(SpinningBar, HitsBodiesThatAreFarFromItAtTheStart) {
  // A bar along x turns about z; a grain at rest lies at 90° to it, at 0.3 m from the axis.
  Description d = description("linear-frictional", material, {{{0, 0.3, 0}, radius}});
  d["walls"]["bar"] = {{"type", "box"},   {"low", {-0.4, -0.01, -0.01}}, {"high", {0.4, 0.01, 0.01}},
                       {"inside", false}, {"material", "grain"},         {"motion", {{"spin", {0, 0, -2}}}}};
  d["time_step"] = {{"value", 2e-4}};
  Trial t(d);
  t.step(4500);  // 0.9 s: 1.8 rad
  EXPECT_GT(t.velocity(0).norm(), 0.1);
}

TEST(Turntable, SlidesUnderGrainsAsFastAsABelt) {
  const auto with_motion = [](const Description& motion) {
    Description d = falling({{{0.1, 0, radius}, radius}});
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["walls"]["floor"]["motion"] = motion;
    Trial t(d);
    t.step(100);
    return t.velocity(0).y();
  };
  const double belt = with_motion({{"velocity", {0, 10, 0}}});
  EXPECT_GT(belt, 0.01);
  EXPECT_NEAR(with_motion({{"spin", {0, 0, 100}}, {"about", {0, 0, 0}}}), belt, 1e-3 * belt);
}

TEST(SawTooth, PushesBodiesWithItsFlanks) {
  // The mean normal of the wall is vertical, but its flanks push a grain in a groove when it slides.
  Description d = description("linear-frictional", material, {{{0, 0, -3e-3}, radius}});
  d["walls"]["teeth"] = {{"type", "saw-tooth"}, {"corner", {-0.01 / std::tan(0.7), -1, 0}},
                         {"edge_a", {2, 0, 0}}, {"edge_b", {0, 2, 0}},
                         {"depth", 0.01},       {"inclination", 0.7},
                         {"material", "grain"}, {"motion", {{"velocity", {300, 0, 0}}}}};
  try {
    d["time_step"] = {{"value", 1e-5}, {"allow_unstable", true}};
    Trial t(d);
    FAIL() << "no guard trips";
  } catch (const NumericsError& error) {
    EXPECT_EQ(error.guard(), Guard::travel);
    EXPECT_THAT(error.what(), HasSubstr("wall \"teeth\" moves"));
  }
}

TEST(TimeStepOfSpeeds, KeepsFastBodiesBelowTheLimit) {
  Description d = falling({{{0, 0, 2}, radius, {0, 0, -20}}});
  Trial t(d);
  const double limit = 0.8 * 0.05 * radius;
  for (int step = 0; step < 3000; ++step) {
    const double before = t.position(0).z();
    t.step();
    ASSERT_LE(std::abs(t.position(0).z() - before), limit * (1 + 1e-9)) << step;
  }
  EXPECT_LT(t.position(0).z(), 1.6);
}

TEST(TimeStepOfSpeeds, IsLongAgainWhenBodiesAreSlow) {
  Description d = falling({{{0, 0, 0.1}, radius, {0, 0, -20}}});
  d["materials"]["grain"]["restitution"] = 0.1;
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["guards"] = {{"overlap", 1}};
  d["materials"]["grain"]["contact_modulus"] = 1e8;
  Trial t(d);
  const double at_first = t.world().dt();
  t.step(4000);
  EXPECT_GT(t.world().dt(), 1.5 * at_first) << "velocity " << t.velocity(0).transpose();
}

TEST(TimeStepOfSpeeds, IsChosenByMaxDisplacement) {
  Description d = falling({{{0, 0, 2}, radius, {0, 0, -20}}});
  const double usual = Trial(d).world().dt();
  d["time_step"] = {{"max_displacement", 0.01}};
  EXPECT_NEAR(Trial(d).world().dt(), usual / 4, 1e-12);
}

TEST(TimeStepOfSpeeds, ForeseesWalls) {
  Description d = description("linear-frictional", material, {{{0, 0, 0}, radius}});
  d["walls"]["lid"] = plane({0, 0, 1.1 * radius}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -10};
  Trial t(d);
  EXPECT_LE(10 * t.world().dt(), 0.8 * 0.05 * radius);
  t.step(2);
  d["time_step"]["value"] = 0.051 * radius / 10;
  d["time_step"]["allow_unstable"] = true;
  try {
    Trial refused(d);
    FAIL() << "no guard trips";
  } catch (const NumericsError& error) {
    EXPECT_THAT(error.what(), HasSubstr("step 0, time 0 s: wall \"lid\" moves 0.051 of a radius towards a body"));
  }
}

}  // namespace
}  // namespace grit::test::speeds_tests
