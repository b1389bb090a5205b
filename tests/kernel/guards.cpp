#include "kernel/guards.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kernel/displacement_bounds.hpp"
#include "kernel/specimen.hpp"
#include "kernel/world_view.hpp"
#include "two_spheres.hpp"

namespace grit::test::guards_tests {
namespace {

/// The guard that `work` trips.
template <class Work>
std::pair<Guard, std::string> failure(Work work) {
  try {
    work();
  } catch (const NumericsError& error) {
    return {error.guard(), error.what()};
  }
  return {Guard::none, "no failure"};
}

TEST(Guards, NameTheDeepestContact) {
  State state = two_spheres(1.5 * radius);
  Passes passes(1);
  search(state, passes);
  evaluate(state);
  state.stage = "fill", state.time.step = 12;
  const WorldView view(state, passes);
  const auto [guard, text] = failure([&] { check_overlap(state, view); });
  EXPECT_EQ(guard, Guard::overlap);
  EXPECT_THAT(text, testing::StartsWith("step 12, time 0 s, stage \"fill\": body 0 at (-0.00075, 0, 0) m overlaps body "
                                        "1 by 0.5 of its radius, more than /guards/overlap 0.2; "));
  state.settings.guards.overlap = 0.5 + 1e-9;
  EXPECT_EQ(failure([&] { check_overlap(state, view); }).second, "no failure");
}

TEST(Guards, RefusePeriodsThatAreTooShort) {
  const double shortest = 4 * (radius + 0.03 * 2 * radius);
  const auto period = [&](double length) {
    Cell cell = box({true, false, false});
    cell.high.x() = cell.low.x() + length;
    return failure([&] { check_periods(two_spheres(2.1 * radius, cell)); }).first;
  };
  EXPECT_EQ(period(0.99 * shortest), Guard::period);
  EXPECT_EQ(period(1.01 * shortest), Guard::none);
}

TEST(Guards, AdviseOnAServoThatMayHaveShortenedAPeriod) {
  Cell cell = box({true, false, false});
  cell.high.x() = cell.low.x() + 3 * radius;
  State state = two_spheres(2.1 * radius, cell);
  state.settings.cell_servo.emplace();
  const auto advice = [&] { return failure([&] { check_periods(state); }).second; };
  const auto longer = testing::HasSubstr("make the domain longer along this axis"),
             target = testing::HasSubstr("the target of /domain/servo may be beyond what the bodies can bear");
  EXPECT_THAT(advice(), testing::AllOf(longer, testing::Not(target))) << "it was too short from the start";
  state.time.step = 100;
  EXPECT_THAT(advice(), testing::AllOf(longer, target));
}

TEST(Guards, LimitTheGrowthOfAStep) {
  const State state = two_spheres(0.004);
  EXPECT_EQ(failure([&] { check_growth(state, 0.049 * radius); }).first, Guard::none);
  EXPECT_EQ(failure([&] { check_growth(state, 0.051 * radius); }).first, Guard::travel);
}

class Travel : public testing::Test {
 protected:
  Travel() {
    search(state_, passes_);
    state_.time.previous_dt = 1e-5;
  }
  /// After a step in which the first body had this velocity.
  Guard guard(const Vec3& velocity) {
    set_velocity(state_, 0, velocity);
    const Velocity own{velocity.x(), velocity.y(), velocity.z()};
    passes_.chunks()[0].motion = {.velocities = {own, own}, .finite = velocity.allFinite()};
    passes_.find_extremes(state_.lists.furthest_here(passes_, state_.time.previous_dt), false);
    return failure([&] { bounds_.advance(state_, passes_); }).first;
  }
  State state_ = two_spheres(0.004);
  Passes passes_{1};
  DisplacementBounds bounds_;
};

TEST_F(Travel, OfABodyIsLimited) {
  EXPECT_EQ(guard({0, 0.049 * radius / 1e-5, 0}), Guard::none);
  EXPECT_EQ(guard({0, 0.051 * radius / 1e-5, 0}), Guard::travel);
}

TEST_F(Travel, MustBeANumber) { EXPECT_EQ(guard({0, std::nan(""), 0}), Guard::finite); }

TEST_F(Travel, TwoBodiesApproachByTwiceTheFastest) {
  guard({1, 0, 0});
  EXPECT_DOUBLE_EQ(bounds_.last_approach(), 2e-5);
  EXPECT_DOUBLE_EQ(bounds_.closing_speed(1e-5), 2);
}

TEST_F(Travel, IsRelativeToTheMeanFlow) {
  state_ = two_spheres(0.004, box({true, false, false}));
  state_.cell.set_strain_rate({1e5, 0, 0}, 0);
  search(state_, passes_);
  state_.time.previous_dt = 1e-5;
  set_velocity(state_, 1, {0.002 * 1e5, 0, 0});
  EXPECT_EQ(guard({-0.002 * 1e5, 0, 0}), Guard::none) << "both move with the flow, 200 m/s at 2 mm from the centre";
}

TEST(SpecimenRegion, IsTheCellWithoutWalls) {
  const State state = two_spheres(0.004);
  EXPECT_EQ(specimen_region(state, 0.001).low, Vec3::Constant(-0.01)) << "only walls have a margin";
  EXPECT_EQ(specimen_region(state, 0).high, Vec3::Constant(0.01));
}

TEST(WorldViewOfAState, ComputesForcesOnceAnInstant) {
  State state = two_spheres(1.99 * radius);
  Passes passes(1);
  search(state, passes);
  evaluate(state);
  WorldView view(state, passes);
  state.settings.motion.gravity = {0, 0, -10};
  const double force = view.forces()[1].x;
  EXPECT_GT(force, 0) << "pushed apart";
  EXPECT_NEAR(view.forces()[1].z, -10 * sphere_mass(), 1e-12 * sphere_mass());
  ASSERT_EQ(view.contacts().size(), 1u);
  EXPECT_NEAR(view.contacts()[0].overlap, 0.01 * radius, 1e-12 * radius);
  state.sum[1].force.x = 7;
  EXPECT_EQ(view.forces()[1].x, force) << "the same instant";
  view.invalidate();
  EXPECT_EQ(view.forces()[1].x, 7);
}

}  // namespace
}  // namespace grit::test::guards_tests
