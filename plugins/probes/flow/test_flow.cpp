#include "flow.hpp"

#include <gmock/gmock.h>

#include "contracts/probe.hpp"
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
  EXPECT_EQ(channel_value(probe, world, "mass"), 7);
  EXPECT_EQ(channel_value(probe, world, "bodies"), 3);
  double there = 0;
  for (const Row& row : world.velocity) there += 1 / row.w;
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "mass_left"), there);
}

TEST(Flow, GivesTheRateOfTheWindow) {
  FakeWorld world = emptying();
  FlowProbe probe;
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "rate"), 6 / 0.05);
  probe.window = 0.02;
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "rate"), 4 / 0.02);
  probe.window = 2;  // longer than the run so far
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "rate"), 7);
  world.now = 5, probe.window = 1;
  EXPECT_EQ(channel_value(probe, world, "rate"), 0);
  world.departure = {{.id = 0, .material = 0, .time = 4, .mass = 3, .position = Vec3::Zero()}};
  EXPECT_EQ(channel_value(probe, world, "rate"), 0) << "what left as the window began counts in the one before";
  world.now = 4;
  EXPECT_EQ(channel_value(probe, world, "rate"), 3);
}

TEST(Flow, TellsOutletsApart) {
  const FakeWorld world = emptying();
  FlowProbe probe = two_outlets();
  EXPECT_EQ(channel_value(probe, world, "left_mass"), 1);
  EXPECT_EQ(channel_value(probe, world, "right_mass"), 6) << "an outlet begins at its low end";
  EXPECT_EQ(channel_value(probe, world, "left_rate"), 0);
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "right_rate"), 6 / 0.05);
  probe.axis = "y";  // where the last body alone is in neither
  EXPECT_EQ(channel_value(probe, world, "left_mass"), 3);
  EXPECT_EQ(channel_value(probe, world, "right_mass"), 0);
  EXPECT_EQ(channel_value(probe, world, "mass"), 7);
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

INSTANTIATE_TEST_SUITE_P(Flow, ProbeContract,
                         testing::Values(ProbeCase{"all", [] { return std::make_shared<FlowProbe>(); }},
                                         ProbeCase{"outlets",
                                                   [] { return std::make_shared<FlowProbe>(two_outlets()); }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
