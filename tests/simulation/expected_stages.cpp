// What a description announces of its stages, against numbers by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulation/expected_stages.hpp"
#include "support/clump.hpp"
#include "support/scene.hpp"

namespace grit::test::expected_stages_tests {
namespace {

std::vector<ExpectedStage> expected(const Description& d, std::size_t bodies) {
  const Scene scene = scene_of(d);
  const LiveScene live(scene);
  return expected_stages(scene, live.components(), bodies, 1e-3);
}
std::vector<ExpectedStream> streams(const Description& d) {
  const Scene scene = scene_of(d);
  const LiveScene live(scene);
  return expected_streams(*scene.description, live.components());
}

Description one_grain() {
  return description("linear-rolling", {{"contact_modulus", 1e6}, {"density", 2600}}, {{Vec3::Zero(), 1e-3}});
}
Description stage(const std::string& name, const Description& until, double limit) {
  return {{"name", name}, {"until", until}, {"limit", limit}};
}
Description lasting(const std::string& name, double time) {
  return stage(name, {{"type", "time"}, {"value", time}}, 10);
}

TEST(ExpectedStages, LastAsTheirConditionsSay) {
  Description d = one_grain();
  d["walls"]["lid"] = plane({0, 0, 1}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"] = {{"velocity", {0.5, 0, 0}}, {"ramp_time", 0.2}};
  d["stages"] =
      Description::array({lasting("fall", 0.3),
                          stage("shear", {{"type", "displacement"}, {"wall", "lid"}, {"axis", "x"}, {"value", 2}}, 10),
                          stage("settle", {{"type", "at-rest"}, {"below", 0.01}}, 5),
                          stage("rest", {{"type", "at-rest"}, {"below", 0.001}}, 4)});
  d["stages"][2]["typical_time"] = 0.5;
  const auto all = expected(d, 3);
  ASSERT_EQ(all.size(), 4u);
  const double half_a_ramp = 0.1;
  const std::vector<double> least{0.3, 4 + half_a_ramp, 0.5, 0}, most{0.3, 4 + half_a_ramp, 5, 4},
      shown{0.3, 4 + half_a_ramp, 0.5, 4};
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].known, i < 2) << i;
    EXPECT_EQ(all[i].usual, i == 2) << i;
    EXPECT_DOUBLE_EQ(all[i].least, least[i]) << i;
    EXPECT_DOUBLE_EQ(all[i].most, most[i]) << i;
    EXPECT_DOUBLE_EQ(all[i].shown(), shown[i]) << i;
    EXPECT_DOUBLE_EQ(all[i].least_body_time, 3 * least[i]) << i;
    EXPECT_DOUBLE_EQ(all[i].most_body_time, 3 * most[i]) << i;
    EXPECT_EQ(all[i].bodies, 3) << i;
  }
}

TEST(ExpectedStages, OfSeveralConditionsHaveTheirBounds) {
  const Description time = {{"type", "time"}, {"value", 0.5}}, steps = {{"type", "steps"}, {"value", 200}},
                    rest = {{"type", "at-rest"}, {"below", 0.01}};
  const auto of = [](const char* type, const Description& a, const Description& b) {
    return Description{{"type", type}, {"of", Description::array({a, b})}};
  };
  Description d = one_grain();
  d["stages"] =
      Description::array({stage("steps", steps, 4), stage("both", of("all", time, steps), 4),
                          stage("either", of("any", time, steps), 4), stage("later", of("all", time, rest), 4),
                          stage("earlier", of("any", time, rest), 4), stage("usual", of("all", time, rest), 4)});
  d["stages"][5]["typical_time"] = 0.7;
  const auto all = expected(d, 1);
  const std::vector<double> least{0.2, 0.5, 0.2, 0.5, 0, 0.7}, most{0.2, 0.5, 0.2, 4, 0.5, 4};
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].known, i < 3) << i;
    EXPECT_EQ(all[i].usual, i == 5) << i;
    EXPECT_DOUBLE_EQ(all[i].least, least[i]) << i;
    EXPECT_DOUBLE_EQ(all[i].most, most[i]) << i;
  }
}

TEST(ExpectedStages, HaveTheBodiesThatAppearInThem) {
  Description d = one_grain();
  d["bodies"]["late"] = d["bodies"]["grains"];
  d["bodies"]["late"]["stage"] = "second";
  d["stages"] = Description::array({lasting("first", 1), lasting("second", 2)});
  const auto all = expected(d, 1);
  EXPECT_EQ(all[0].arriving, 0u);
  EXPECT_EQ(all[1].arriving, 1u);
  EXPECT_DOUBLE_EQ(all[0].least_body_time, 1);
  EXPECT_DOUBLE_EQ(all[1].least_body_time, 4);
  EXPECT_EQ(all[1].bodies, 2);
}

/// A grain, and a stream of 100 bodies a second, 50 in all, from this stage on; "": from the start.
Description poured(const std::string& from, const Description& stages) {
  Description d = one_grain();
  Description group = {{"type", "sphere"}, {"material", "grain"}};
  group["source"] = {{"type", "stream"},
                     {"number_rate", 100},
                     {"count", 50},
                     {"region", {{"type", "disc"}, {"centre", {0, 0, 1}}, {"radius", 0.1}}},
                     {"sizes", {{"type", "list"}, {"diameters", {2e-3}}}}};
  if (!from.empty()) group["stage"] = from;
  d["bodies"]["poured"] = group;
  d["stages"] = stages;
  return d;
}

TEST(ExpectedStages, CountStreamsAsTheyFlow) {
  const Description stages = Description::array({lasting("first", 0.25), lasting("second", 1)});
  const auto early = expected(poured("", stages), 1), late = expected(poured("second", stages), 1);
  EXPECT_EQ(early[0].arriving, 0u);
  EXPECT_EQ(early[0].bodies, 1 + 25);
  EXPECT_EQ(early[1].bodies, 1 + 50);
  EXPECT_DOUBLE_EQ(early[0].least_body_time, 0.25 + 0.5 * 100 * 0.25 * 0.25);
  // Full after 0.5 s, which is 0.25 s into the second stage.
  EXPECT_DOUBLE_EQ(early[1].least_body_time, 1 + 0.25 * 0.5 * (25 + 50) + 0.75 * 50);
  EXPECT_DOUBLE_EQ(early[1].most_body_time, early[1].least_body_time);
  EXPECT_EQ(late[0].bodies, 1);
  EXPECT_DOUBLE_EQ(late[0].least_body_time, 0.25);
  EXPECT_DOUBLE_EQ(late[1].least_body_time, 1 + 0.5 * 0.5 * 50 + 0.5 * 50);
}

TEST(ExpectedStages, CountStreamsBetweenTypicalAndLongestDurations) {
  Description stages =
      Description::array({stage("pour", {{"type", "at-rest"}, {"below", 0.01}}, 1), lasting("after", 1)});
  stages[0]["typical_time"] = 0.1;
  const auto all = expected(poured("", stages), 0);
  EXPECT_DOUBLE_EQ(all[0].least_body_time, 0.5 * 100 * 0.1 * 0.1);
  EXPECT_DOUBLE_EQ(all[0].most_body_time, 0.5 * 0.5 * 50 + 0.5 * 50);
  EXPECT_DOUBLE_EQ(all[1].least_body_time, 0.4 * 0.5 * (10 + 50) + 0.6 * 50);
  EXPECT_DOUBLE_EQ(all[1].most_body_time, 50) << "it ended in the first stage";
  EXPECT_DOUBLE_EQ(all[0].bodies, 10) << "after the typical duration";
}

TEST(ExpectedStreams, HaveTheRateAndLimitOfTheirBodies) {
  const Description stages = Description::array({lasting("first", 1), lasting("second", 1)});
  Description d = poured("", stages);
  auto all = streams(d);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].name, "poured");
  EXPECT_EQ(all[0].stage, "first");
  EXPECT_EQ(all[0].rate, 100);
  EXPECT_EQ(all[0].limit, 50);
  EXPECT_EQ(streams(poured("second", stages))[0].stage, "second");

  const double mass = 2600 * 4.0 / 3 * std::numbers::pi * 1e-9;
  Description& source = d["bodies"]["poured"]["source"];
  source.erase("number_rate"), source.erase("count");
  source["mass_rate"] = 40 * mass;
  all = streams(d);
  EXPECT_NEAR(all[0].rate, 40, 1e-9);
  EXPECT_TRUE(std::isinf(all[0].limit));
  EXPECT_NEAR(all[0].entered(10), 400, 1e-8);
  EXPECT_NEAR(all[0].body_time(1, 2), 60, 1e-8);

  d = poured("", stages);
  d["bodies"]["poured"]["type"] = "clump";
  d["bodies"]["poured"]["shape"] = boomerang();
  all = streams(d);
  EXPECT_EQ(all[0].rate, 300) << "three spheres each";
  EXPECT_EQ(all[0].limit, 150);
}

}  // namespace
}  // namespace grit::test::expected_stages_tests
