#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/time_step_control.hpp"
#include "kernel/world_view.hpp"
#include "two_spheres.hpp"

namespace grit::test::time_step_tests {
namespace {

class TimeStep : public testing::Test {
 protected:
  explicit TimeStep(const std::string& law = "linear-frictional") : state_(two_spheres(1.99 * radius, box(), law)) {
    control_.update_stiffening(state_);
    search(state_, passes_);
    evaluate(state_);
  }
  double set() {
    control_.set(state_, view_, bounds_, passes_);
    return state_.time.dt;
  }
  State state_;
  Passes passes_{1};
  WorldView view_{state_, passes_};
  TimeStepControl control_;
  DisplacementBounds bounds_;
};
class StiffeningStep : public TimeStep {
 protected:
  StiffeningStep() : TimeStep("hertz-mindlin") {}
};

TEST_F(TimeStep, IsTheShorterOfSafetyAndSteps) {
  state_.settings.time_step.steps_per_impact = 0;
  state_.settings.time_step.safety = 0.5;
  EXPECT_DOUBLE_EQ(set(), 0.5 * control_.critical());
  state_.settings.time_step.steps_per_impact = 100;
  EXPECT_LT(set(), 0.5 * control_.critical());
}

TEST_F(TimeStep, StaysWhileItCouldBeLittleLonger) {
  state_.settings.time_step.steps_per_impact = 0;
  state_.settings.time_step.safety = 0.5;
  const double before = set();
  state_.settings.time_step.safety = 0.54;
  EXPECT_EQ(set(), before);
  state_.settings.time_step.safety = 0.56;
  EXPECT_DOUBLE_EQ(set(), 0.56 / 0.5 * before);
}

TEST_F(TimeStep, IsRefusedWhereTimeDoesNotAdvance) {
  const auto refusal = [&] {
    try {
      set();
    } catch (const NumericsError& error) {
      EXPECT_EQ(error.keys(), std::vector<std::string>{"time_step"});
      return error.cause();
    }
    return std::string();
  };
  state_.time.time = 1e9;
  EXPECT_EQ(refusal(), "");
  state_.time.time = 1e15;
  EXPECT_EQ(refusal().substr(0, 31), "time does not advance in steps ");
  state_.settings.time_step.value = 1e-12;
  EXPECT_EQ(refusal().substr(0, 49), "time does not advance in steps of 1e-12 s; check ");
}

TEST_F(TimeStep, PrescribedAboveTheCriticalOneIsRefused) {
  state_.settings.time_step.value = 1;
  try {
    set();
    FAIL();
  } catch (const NumericsError& error) {
    EXPECT_EQ(error.guard(), Guard::critical_step);
  }
  state_.settings.time_step.allow_unstable = true;
  EXPECT_EQ(set(), 1);
}

TEST_F(TimeStep, PrescribedIsComparedWithNewContactsUnlessItMayBeUnstable) {
  state_.settings.time_step.value = 1e-9;
  state_.settings.time_step.allow_unstable = true;
  set();
  const double before = control_.critical();
  state_.bodies.velocity[0].w *= 4;  // one body is lighter, both have moved
  for (const std::size_t i : {0u, 1u}) state_.bodies.position[i].y += 0.2 * radius;
  set_speed(passes_, 0.2 * radius);
  state_.lists.advance(1, 0, passes_);
  control_.follow(control_.due(state_, passes_), state_, view_, bounds_, passes_);
  EXPECT_EQ(control_.critical(), before);
  state_.settings.time_step.allow_unstable = false;
  control_.follow(control_.due(state_, passes_), state_, view_, bounds_, passes_);
  EXPECT_LT(control_.critical(), 0.9 * before);
}

TEST_F(TimeStep, IsComparedWithContactsAtEveryEighthSearchIfItMayBeUnstable) {
  state_.settings.time_step.value = 1e-9;
  state_.settings.time_step.allow_unstable = true;
  set();
  double before = control_.critical();
  std::vector<bool> compared;
  for (int i = 0; i < 16; ++i) {
    state_.bodies.velocity[0].w *= 1.1;
    search(state_, passes_);
    control_.search_ends(state_, view_, bounds_, passes_);
    compared.push_back(control_.critical() < before);
    before = control_.critical();
  }
  EXPECT_EQ(std::ranges::count(compared, true), 2);
  state_.settings.time_step.allow_unstable = false;
  control_.search_ends(state_, view_, bounds_, passes_);
  EXPECT_LT(control_.critical(), before);
}

TEST_F(TimeStep, IsNotComparedAgainWhereBodiesHaveOnlyGoneToAndFro) {
  set();
  const double before = control_.critical();
  state_.bodies.velocity[0].w *= 4;
  const auto follow = [&](double speed) {
    set_speed(passes_, speed);
    state_.lists.advance(1, 0, passes_);
    control_.follow(control_.due(state_, passes_), state_, view_, bounds_, passes_);
    return control_.critical();
  };
  EXPECT_EQ(follow(0.2 * radius), before) << "they are where they were";
  state_.bodies.position[0].y += 0.2 * radius;
  EXPECT_LT(follow(0.2 * radius), before);
}

TEST_F(TimeStep, IsNotComparedAgainWhereBodiesHaveMovedTogether) {
  const Vec3 together(0, 0.2 * radius, 0);
  for (const std::size_t i : {0u, 1u}) set_velocity(state_, i, together);
  search(state_, passes_), set();
  const double before = control_.critical();
  state_.bodies.velocity[0].w *= 4;
  for (const std::size_t i : {0u, 1u}) state_.bodies.position[i].y += together.y();
  const Velocity own{0, together.y(), 0};
  passes_.chunks()[0].motion.velocities = {own, own};
  passes_.chunks()[0].relative_speed = state_.lists.skins().relative_speed(0, {own, own});
  state_.lists.advance(1, 0, passes_);
  EXPECT_GT(state_.lists.skins().walked(0), 0.19 * radius);
  control_.follow(control_.due(state_, passes_), state_, view_, bounds_, passes_);
  EXPECT_EQ(control_.critical(), before);
}

TEST_F(TimeStep, IsStableWithTheRatesOfEngines) {
  class Damper final : public Engine {
   public:
    void declare(Parameters&) override {}
    Phase phase() const override { return Phase::forces; }
    EngineRates rates(const World&) const override { return {.stiffness = 0, .damping = 1e9}; }
  } damper;
  state_.settings.time_step.steps_per_impact = 0;
  const double without = set();
  state_.settings.force_engines = {{&damper, {}}};
  EXPECT_LT(set(), without);
  EXPECT_NEAR(control_.critical(), 2e-9, 1e-12) << "2 m/c for a dashpot alone";
}

TEST_F(TimeStep, IgnoresTheRatesOfEnginesOnOtherGroups) {
  /// Stiff where the body with the id 1 is.
  class Field final : public Engine {
   public:
    void declare(Parameters&) override {}
    Phase phase() const override { return Phase::forces; }
    EngineRates rates(const World& world) const override {
      return {.stiffness = std::ranges::find(world.ids(), 1u) != world.ids().end() ? 1e18 : 0, .damping = 0};
    }
  } field;
  state_.settings.time_step.steps_per_impact = 0;
  state_.bodies.groups = {{"first", 0}, {"second", 1}};
  state_.settings.groups = {"first", "second"};
  const double without = (set(), control_.critical());
  state_.settings.force_engines = {{&field, {true, false}}};
  set();
  EXPECT_EQ(control_.critical(), without);
  state_.settings.force_engines = {{&field, {false, true}}};
  set();
  EXPECT_NEAR(control_.critical(), 2e-9, 1e-11);
  state_.settings.force_engines = {{&field, {}}};
  set();
  EXPECT_NEAR(control_.critical(), 2e-9, 1e-11);
}

TEST_F(TimeStep, WithoutBodiesIsThatOfTheGroups) {
  set();
  const double with_bodies = control_.critical();
  State empty = two_spheres(1.99 * radius);
  empty.settings.of_groups = demand_without_contacts(empty.bodies, *empty.settings.law);
  empty.bodies = {};
  Passes none(1);
  TimeStepControl control;
  control.update_stiffening(empty);
  search(empty, none);
  DisplacementBounds bounds;
  control.set(empty, WorldView(empty, none), bounds, none);
  EXPECT_NEAR(control.critical(), with_bodies, 1e-12 * with_bodies);
}

TEST_F(TimeStep, StaysOnceAllBodiesHaveLeft) {
  const double before = set();
  state_.bodies = {};
  search(state_, passes_, Renumbering({}, 2));
  set();
  state_.lists.advance_walls(radius);
  control_.follow(control_.due(state_, passes_), state_, view_, bounds_, passes_);
  EXPECT_EQ(state_.time.dt, before);
}

TEST_F(TimeStep, OfLinearSpringsDoesNotFollowOverlaps) {
  EXPECT_FALSE(control_.stiffening().is_there());
  EXPECT_EQ(control_.stiffening().expected_overlap(), 0);
  set();
  state_.overlap = 0.15;
  EXPECT_FALSE(control_.may_stiffen(state_, bounds_));
}

TEST_F(StiffeningStep, ExpectsTheOverlapOfTheFastestImpact) {
  EXPECT_TRUE(control_.stiffening().is_there());
  set();
  const double at_rest = control_.stiffening().expected_overlap(), step = state_.time.dt;
  set_velocity(state_, 0, {5, 0, 0});
  set();
  EXPECT_GT(control_.stiffening().expected_overlap(), 1.2 * at_rest);
  EXPECT_LT(state_.time.dt, step);
}

TEST_F(StiffeningStep, IsSetAgainWhenContactsAreDeeper) {
  set();
  EXPECT_FALSE(control_.may_stiffen(state_, bounds_));
  state_.overlap *= 1.3;
  EXPECT_TRUE(control_.may_stiffen(state_, bounds_));
}

}  // namespace
}  // namespace grit::test::time_step_tests
