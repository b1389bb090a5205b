#include "flow.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grit/testing/probe.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"

namespace grit {
namespace {

using testing::HasSubstr;

/// A world at t = 1 s that three bodies have left, at 0.2, 0.96 and 0.99 s.
FakeWorld emptying() {
  FakeWorld world = lattice_world(2, 2, 2);
  world.now = 1;
  world.departure = {
      {8, 0, 0.2, 1.0, {0.01, 0, 0}}, {9, 0, 0.96, 2.0, {0.03, 0, 0}}, {10, 0, 0.99, 4.0, {0.02, 0.5, 0}}};
  return world;
}

FlowProbe two_outlets() {
  FlowProbe probe;
  probe.outlets = {{"left", {0, 0.02}}, {"right", {0.02, 0.04}}};
  return probe;
}

std::vector<std::string> problems_of(const Description& keys) {
  FlowProbe probe;
  Parameters parameters;
  probe.declare(parameters);
  std::vector<Problem> problems;
  read(Document(keys, "test"), "", parameters, problems);
  std::vector<std::string> texts;
  for (const Problem& problem : problems) texts.push_back(problem.pointer + " " + problem.message);
  return texts;
}

TEST(Flow, AddsUpWhatHasLeftAndWhatIsThere) {
  const FakeWorld world = emptying();
  FlowProbe probe;
  EXPECT_EQ(channel_value(probe, world, "discharged_mass"), 7);
  EXPECT_EQ(channel_value(probe, world, "discharged_bodies"), 3);
  double there = 0;
  for (const Row& row : world.velocity) there += 1 / row.w;
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "remaining_mass"), there);
}

TEST(Flow, GivesTheRateOfTheWindow) {
  FakeWorld world = emptying();
  FlowProbe probe;
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "discharge_rate"), 6 / 0.05);
  probe.window = 0.02;
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "discharge_rate"), 4 / 0.02);
  probe.window = 2;  // longer than the run so far
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "discharge_rate"), 7);
  world.now = 5, probe.window = 1;
  EXPECT_EQ(channel_value(probe, world, "discharge_rate"), 0);
  world.departure = {{.id = 0, .material = 0, .time = 4, .mass = 3, .position = Vec3::Zero()}};
  EXPECT_EQ(channel_value(probe, world, "discharge_rate"), 0)
      << "what left as the window began counts in the one before";
  world.now = 4;
  EXPECT_EQ(channel_value(probe, world, "discharge_rate"), 3);
}

TEST(Flow, TellsOutletsApart) {
  const FakeWorld world = emptying();
  FlowProbe probe = two_outlets();
  EXPECT_EQ(channel_value(probe, world, "left_discharged_mass"), 1);
  EXPECT_EQ(channel_value(probe, world, "right_discharged_mass"), 6) << "an outlet begins at its low end";
  EXPECT_EQ(channel_value(probe, world, "left_discharge_rate"), 0);
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "right_discharge_rate"), 6 / 0.05);
  probe.axis = "y";  // where the last body alone is in neither
  EXPECT_EQ(channel_value(probe, world, "left_discharged_mass"), 3);
  EXPECT_EQ(channel_value(probe, world, "right_discharged_mass"), 0);
  EXPECT_EQ(channel_value(probe, world, "discharged_mass"), 7);
}

TEST(Flow, RefusesOutletsThatOverlapOrAreNone) {
  EXPECT_TRUE(problems_of({{"outlets", {{"a", {{"low", 0}, {"high", 1}}}, {"b", {{"low", 1}, {"high", 2}}}}}}).empty());
  EXPECT_THAT(problems_of({{"outlets", {{"a", {{"low", 0}, {"high", 1.1}}}, {"b", {{"low", 1}, {"high", 2}}}}}}),
              testing::ElementsAre(HasSubstr("\"a\" and \"b\", which overlap")));
  EXPECT_THAT(problems_of({{"outlets", {{"a", {{"low", 1}, {"high", 1}}}}}}),
              testing::ElementsAre(HasSubstr("above low")));
  EXPECT_THAT(problems_of({{"outlets", {{"A-1", {{"low", 0}, {"high", 1}}}}}}),
              testing::ElementsAre(HasSubstr("the name \"A-1\"")));
  EXPECT_THAT(problems_of({{"window", 0}}), testing::ElementsAre(HasSubstr("/window")));
}

/// Grains of 1 mm, twenty by two by twenty, that sink by speed(x, z), as some leave; the walls across x are 20 mm
/// apart.
template <class Speed>
FakeWorld sinking(Speed speed) {
  FakeWorld world;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 2; ++j)
      for (int k = 0; k < 20; ++k) {
        const Vec3 place(1e-3 * (i + 0.5), 1e-3 * (j + 0.5), 1e-3 * (k + 0.5));
        world.add(place, 0.5e-3, {0.01, 0, -speed(place.x(), place.z())});
      }
  world.whole = {Vec3::Zero(), {20e-3, 2e-3, 20e-3}};
  world.now = 1;
  world.departure = {{.id = 9999, .material = 0, .time = 0.99, .mass = 1, .position = Vec3::Zero()}};
  return world;
}
FlowProbe patterned() {
  FlowProbe probe;
  probe.pattern.emplace().depth_axis = "y";
  return probe;
}

TEST(FlowPattern, IsMassFlowWhereAllSinks) {
  const FakeWorld world = sinking([](double x, double) { return x < 2e-3 || x > 18e-3 ? 0.1 : 0.2; });
  FlowProbe probe = patterned();
  EXPECT_EQ(channel_value(probe, world, "flow_type"), 3);
  EXPECT_EQ(channel_value(probe, world, "transition_height"), 0);
  // 2 + 2 columns of 20 at half the speed of the others.
  for (const double speed : channel_values(probe, world, "speed")) EXPECT_NEAR(speed, 0.18, 1e-15);
  for (const double share : channel_values(probe, world, "wall_speed_ratio")) EXPECT_NEAR(share, 0.1 / 0.18, 1e-14);
  EXPECT_NEAR(channel_values(probe, world, "position").back(), 19.5e-3, 1e-17);
  probe.pattern->moving_fraction = 0.6;
  EXPECT_EQ(channel_value(probe, world, "flow_type"), 1);
}

TEST(FlowPattern, IsPipeFlowWhereNothingMovesAtAWall) {
  // Along the left wall all sinks, along the right nothing does.
  const FakeWorld world = sinking([](double x, double) { return x < 15e-3 ? 0.2 : 0; });
  FlowProbe probe = patterned();
  EXPECT_EQ(channel_value(probe, world, "flow_type"), 1);
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "transition_height")));
}

TEST(FlowPattern, IsMixedFlowWhereTheChannelMeetsTheWalls) {
  const auto funnel = [](double x, double z) { return z > 12e-3 || std::abs(x - 10e-3) < 5e-3 ? 0.2 : 0; };
  FakeWorld world = sinking(funnel);
  FlowProbe probe = patterned();
  EXPECT_EQ(channel_value(probe, world, "flow_type"), 2);
  EXPECT_NEAR(channel_value(probe, world, "transition_height"), 12e-3, 1e-17);
  // What is above the surface says nothing.
  world.whole.high.z() = 40e-3;
  EXPECT_EQ(channel_value(probe, world, "flow_type"), 2);
  EXPECT_TRUE(std::isnan(channel_values(probe, world, "speed").back()));
  world.departure.front().time = 0.5;
  EXPECT_EQ(channel_value(probe, world, "flow_type"), 0) << "nothing leaves any more";
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "transition_height")));
}

TEST(FlowPattern, HasAMapOfVelocities) {
  const FakeWorld world = sinking([](double x, double) { return x < 10e-3 ? 0.2 : 0; });
  FlowProbe probe = patterned();
  const auto fields = probe.fields(world);
  ASSERT_EQ(fields.size(), 3u);
  const auto &centre = fields[0].values, &velocity = fields[2].values;
  ASSERT_EQ(centre.size(), velocity.size());
  int left = 0, right = 0;
  for (std::size_t i = 0; i < centre.size(); i += 3) {
    EXPECT_NEAR(velocity[i], 0.01, 1e-15);
    if (centre[i] < 7.4e-3) {
      EXPECT_NEAR(velocity[i + 2], -0.2, 1e-14);
      ++left;
    } else if (centre[i] > 12.6e-3) {
      EXPECT_NEAR(velocity[i + 2], 0, 1e-14);
      ++right;
    }
  }
  EXPECT_GT(left, 20);
  EXPECT_GT(right, 20);
  EXPECT_TRUE(FlowProbe().fields(world).empty());
}

TEST(FlowPattern, IsNotSeenAlongTheOutlets) {
  EXPECT_TRUE(problems_of({{"pattern", Description::object()}}).empty());
  EXPECT_THAT(problems_of({{"axis", "z"}, {"pattern", Description::object()}}),
              testing::ElementsAre(HasSubstr("a profile along z, where outlets lie")));
}

INSTANTIATE_TEST_SUITE_P(Flow, ProbeContract,
                         testing::Values(ProbeCase{"all", [] { return std::make_shared<FlowProbe>(); }},
                                         ProbeCase{"outlets",
                                                   [] { return std::make_shared<FlowProbe>(two_outlets()); }},
                                         ProbeCase{"pattern", [] { return std::make_shared<FlowProbe>(patterned()); }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
