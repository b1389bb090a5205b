// Components are made once and follow the description.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "counted_components.hpp"

namespace grit::test {
namespace {

using testing::HasSubstr;

TEST(LiveComponents, EnginesKeepTheirInstanceWhileTheirTypeStays) {
  Description d = counted();
  for (const char* name : {"a", "b", "c", "d"}) d["stages"].push_back(stage_of(name, 1));
  auto& stages = d["stages"];
  stages[0]["change"] = {{"engines", {{"tally", {{"strength", 2}, {"limit", 5}, {"shape", {1, 2, 3}}}}}}};
  stages[1]["change"] = {{"engines", {{"tally", {{"limit", nullptr}}}}}};
  stages[2]["change"] = {
      {"engines", {{"tally", {{"type", "local-damping"}, {"strength", nullptr}, {"shape", nullptr}}}}}};
  stages[3]["change"] = {{"engines", {{"tally", nullptr}, {"other", {{"type", "tally"}}}}}};
  const Scene scene = scene_of(d);
  LiveScene live(scene);
  const auto engine = [&](const char* name) { return live.components().engines.at(name); };
  const auto first = engine("tally");
  const auto& tally = dynamic_cast<const Tally&>(*first);
  EXPECT_EQ(tally.strength, 1);
  live.begin_stage();
  EXPECT_EQ(engine("tally"), first);
  EXPECT_EQ(tally.strength, 2);
  EXPECT_EQ(tally.limit, 5);
  EXPECT_EQ(tally.shape, Vec3(1, 2, 3));
  live.begin_stage();
  EXPECT_EQ(engine("tally"), first);
  EXPECT_FALSE(tally.limit) << "null resets it";
  EXPECT_EQ(tally.strength, 2);
  live.begin_stage();
  EXPECT_NE(engine("tally"), first) << "another type";
  live.begin_stage();
  EXPECT_FALSE(live.components().engines.contains("tally"));
  EXPECT_TRUE(live.components().engines.contains("other"));
}

TEST(LiveComponents, RampsSetNumbersOfLiveInstances) {
  Description d = counted();
  d["stages"] = Description::array({stage_of("a", 1), stage_of("b", 1)});
  d["stages"][0]["ramps"] =
      Description::array({ramp_of("/engines/tally/strength", 0, 8, 1, 4), ramp_of("/engines/tally/shape/1", 1, 2, 1, 1),
                          ramp_of("/materials/grain/friction_angle", 0, 0.5, 1, 2)});
  d["stages"][1]["change"] = {{"engines", {{"tally", {{"strength", 1}}}}}};
  const Scene scene = scene_of(d);
  LiveScene live(scene);
  const auto& tally = dynamic_cast<const Tally&>(*live.components().engines.at("tally"));
  live.begin_stage();
  const int made = counts().engines;
  for (const std::size_t k : {1u, 2u, 3u, 4u}) {
    EXPECT_TRUE(live.advance_ramps(k));
    EXPECT_EQ(tally.strength, 2.0 * static_cast<double>(k));
  }
  EXPECT_FALSE(live.advance_ramps(4)) << "nothing new is due";
  live.advance_ramps(5);
  EXPECT_EQ(tally.shape, Vec3(0, 2, 0));
  const auto friction = [&] {
    ContactLaw& law = *live.components().law;
    law.mix(std::vector<std::string>{"grain"}, 1);
    return law.mixed(0, 0, false);
  };
  const auto none = friction();
  live.advance_ramps(6);
  const auto some = friction();
  live.advance_ramps(7);
  const auto more = friction();
  EXPECT_NE(none, some);
  EXPECT_NE(some, more);
  EXPECT_EQ(counts().engines, made) << "none was made again";
  live.begin_stage();
  EXPECT_EQ(tally.strength, 1) << "the value before the ramp, which set it from outside";
  EXPECT_EQ(friction(), more) << "the end value of a ramp is kept";
}

TEST(LiveComponents, AdvancesToTheStateOfARun) {
  Description d = counted();
  d["stages"] = Description::array({stage_of("a", 1), stage_of("b", 1)});
  d["stages"][0]["ramps"] = Description::array({ramp_of("/engines/tally/strength", 0, 8, 1, 4)});
  d["stages"][1]["ramps"] = Description::array({ramp_of("/engines/tally/strength", 8, 0, 1, 4)});
  const Scene scene = scene_of(d);
  LiveScene live(scene);
  live.go_to(1, 1);
  const auto& tally = dynamic_cast<const Tally&>(*live.components().engines.at("tally"));
  EXPECT_EQ(tally.strength, 6);
  live.advance_ramps(2);
  EXPECT_EQ(tally.strength, 4);
}

TEST(LiveComponents, AGeometryIsPreparedOnceAndReplacedIfItChanges) {
  Description d = counted();
  for (const char* name : {"a", "b", "c"}) d["stages"].push_back(stage_of(name, 1));
  d["stages"][0]["change"] = {{"walls", {{"square", {{"motion", {{"velocity", {0, 0, 1}}}}}}}}};
  d["stages"][0]["ramps"] = Description::array({ramp_of("/walls/square/motion/velocity/0", 0, 1, 1, 5)});
  d["stages"][1]["change"] = {{"walls", {{"square", {{"height", 2}}}}}};
  d["stages"][2]["ramps"] = Description::array({ramp_of("/walls/square/height", 2, 4, 1, 2)});
  const Scene scene = scene_of(d);
  counts() = {};
  LiveScene live(scene);
  EXPECT_EQ(counts().prepared, 4)
      << "at the start of the run, at changes by stages, and at the start and end of a ramp";
  const auto square = [&] { return live.components().geometries.at("square"); };
  const auto first = square();
  live.begin_stage();
  for (std::size_t k = 1; k <= 5; ++k) live.advance_ramps(k);
  EXPECT_EQ(square(), first) << "a change of motion is no change of shape";
  EXPECT_EQ(counts().prepared, 4);
  live.begin_stage();
  EXPECT_NE(square(), first);
  EXPECT_EQ(square()->bounds().low.z(), 2);
  EXPECT_EQ(first->bounds().low.z(), 0) << "shapes do not change";
  live.begin_stage();
  live.advance_ramps(1);
  EXPECT_EQ(square()->bounds().low.z(), 3);
  live.advance_ramps(2);
  EXPECT_EQ(square()->bounds().low.z(), 4);
}

// ---- faults found when components are made

std::string refusal(const Description& plain) {
  const Scene scene = scene_of(plain);
  try {
    const LiveScene live(scene);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "";
}

TEST(LiveComponents, FaultsHaveThePositionOfTheirComponent) {
  Description d = counted();
  d["stages"] = Description::array({stage_of("a", 1), stage_of("b", 1)});
  EXPECT_EQ(refusal(d), "");
  d["walls"]["square"]["spoilt"] = "key";
  EXPECT_EQ(refusal(d), "test: /walls/square/spoilt: found a spoilt square; allowed is a whole one");
  d["walls"]["square"]["spoilt"] = "all";
  d["walls"]["other"] = d["walls"]["square"];
  EXPECT_EQ(refusal(d),
            "test: /walls/other: found nothing to stand on\ntest: /walls/square: found nothing to stand on");
  d["walls"].erase("other"), d["walls"]["square"]["spoilt"] = "";
  d["stages"][1]["change"] = {{"walls", {{"square", {{"spoilt", "key"}}}}}};
  EXPECT_EQ(refusal(d), "test: /stages/1/change/walls/square/spoilt: found a spoilt square; allowed is a whole one");
}

}  // namespace
}  // namespace grit::test
