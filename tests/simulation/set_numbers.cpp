// A number that is set again and again is set where it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "counted_components.hpp"
#include "support/notes.hpp"

namespace grit::test::set_numbers_tests {
namespace {

Description flying() {
  Description d = counted();
  d["walls"]["lid"] = {{"type", "square"}, {"material", "grain"}, {"height", 3}};
  d["walls"]["lid"]["motion"] = {{"follow", {{"wall", "square"}, {"axes", "z"}}}};
  d["stages"] = Description::array({stage_of("first", 500), stage_of("second", 500)});
  d["stages"][1]["change"] = {{"engines", {{"tally", {{"strength", 7}}}}}};
  return d;
}

struct Flying {
  Notes notes;
  Simulation simulation = recorded(scene_of(flying()), notes);
  const Tally& tally() { return dynamic_cast<const Tally&>(*live_of(simulation).components().engines.at("tally")); }
};

/// What is wrong with a value.
std::string refusal(Simulation& simulation, const std::string& pointer, const Description& value) {
  try {
    simulation.set(pointer, value);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "";
}

TEST(SetNumbers, MakeNoComponents) {
  Flying flying;
  Simulation& simulation = flying.simulation;
  for (const char* pointer : {"/engines/tally/strength", "/engines/tally/shape/1", "/walls/square/motion/velocity/2",
                              "/materials/grain/friction_angle", "/guards/travel"})
    simulation.set(pointer, 0.1);
  const Counts before = counts();
  for (int i = 1; i <= 300; ++i) {
    const double value = 1e-4 * i;
    for (const char* pointer : {"/engines/tally/strength", "/engines/tally/shape/1", "/walls/square/motion/velocity/2",
                                "/materials/grain/friction_angle", "/guards/travel"})
      simulation.set(pointer, value);
    simulation.step();
    ASSERT_EQ(flying.tally().strength, value);
    ASSERT_EQ(flying.tally().shape, Vec3(0, value, 0));
    ASSERT_EQ(simulation.world().walls()[1].velocity.z(), value);
  }
  EXPECT_EQ(counts().engines, before.engines);
  EXPECT_EQ(counts().geometries, before.geometries);
  EXPECT_EQ(live_of(simulation).now().guards.travel, 1e-4 * 300);
  EXPECT_EQ(live_of(simulation).now().materials.at("grain").values.at("friction_angle"), 1e-4 * 300);
}

TEST(SetNumbers, AreMixedByTheLaw) {
  Flying flying;
  const auto mixed = [&] { return live_of(flying.simulation).components().law->mixed(0, 0, false); };
  flying.simulation.set("/materials/grain/friction_angle", 0.2);
  const auto once = mixed();
  flying.simulation.set("/materials/grain/friction_angle", 0.4);
  const auto twice = mixed();
  EXPECT_NE(once, twice);
  flying.simulation.set("/materials/grain/friction_angle", 0.2);
  EXPECT_EQ(mixed(), once);
}

TEST(SetNumbers, AreRefusedLikeTheFirst) {
  struct Case {
    const char* pointer;
    double good;
    Description bad;
    const char* message;
  };
  const std::vector<Case> cases{
      {"/materials/grain/friction_angle", 0.3, 7.0,
       "set: /materials/grain/friction_angle: found 7 rad; did you mean \"7 deg\"? Allowed is from 0 rad to below "
       "1.5708 rad"},
      {"/guards/travel", 0.01, -1.0, "set: /guards/travel: found -1; allowed is above 0"},
      {"/walls/lid/motion/velocity/2", 0.0, 1.0,
       "set: /walls/lid/motion/follow: found the axis z controlled by velocity and follow; allowed is one of "
       "them per axis"},
      {"/engines/tally/strength", 2.0, "much",
       "set: /engines/tally/strength: found the text \"much\"; allowed is a number, or a text such as \"5 %\""}};
  for (const Case& one : cases) {
    Flying first, later;
    const std::string refused = refusal(first.simulation, one.pointer, one.bad);
    EXPECT_EQ(refused, one.message) << one.pointer;
    EXPECT_EQ(refusal(later.simulation, one.pointer, one.good), "");
    EXPECT_EQ(refusal(later.simulation, one.pointer, one.good), "");
    EXPECT_EQ(refusal(later.simulation, one.pointer, one.bad), refused) << one.pointer;
    EXPECT_EQ(refusal(later.simulation, one.pointer, one.good), "") << "and nothing was changed";
  }
}

TEST(SetNumbers, StayUntilAStageChangesThem) {
  Flying flying;
  for (const double strength : {2.0, 3.0, 4.0}) flying.simulation.set("/engines/tally/strength", strength);
  EXPECT_EQ(flying.tally().strength, 4);
  flying.simulation.run_stage();
  EXPECT_EQ(flying.tally().strength, 7);
  flying.simulation.set("/engines/tally/strength", 5);
  EXPECT_EQ(flying.tally().strength, 5);
  EXPECT_EQ(flying.tally().limit, std::nullopt);
}

TEST(SetNumbers, FollowAShapeThatIsMadeAnew) {
  Flying flying;
  for (const double height : {0.1, 0.2, 0.3}) {
    flying.simulation.set("/walls/square/height", height);
    EXPECT_EQ(live_of(flying.simulation).geometries().all().at("square")->bounds().low.z(), height);
  }
}

TEST(SetNumbers, TakeNoMemoryInCheckpoints) {
  const auto saved = [](int times) {
    Flying flying;
    for (int i = 0; i < times; ++i) {
      flying.simulation.set("/engines/tally/strength", 1.5 + i % 2);
      flying.simulation.set("/engines/tally/limit", 1.5 + i % 2);
      flying.simulation.set("/guards/travel", 0.015625);
    }
    flying.simulation.step(3);
    return flying.simulation.save();
  };
  EXPECT_EQ(saved(1000).state.size(), saved(10).state.size());
  Flying flying;
  flying.simulation.resume(saved(1000));
  EXPECT_EQ(flying.tally().strength, 2.5);
  EXPECT_EQ(flying.tally().limit, 2.5);
}

TEST(SetNumbers, GoOnFromACheckpointWithinARamp) {
  Description d = flying();
  d["stages"][0]["ramps"] = Description::array({ramp_of("/engines/tally/shape/0", 0, 8, 400e-6, 4)});
  Notes notes, other_notes;
  Simulation simulation = recorded(scene_of(d), notes), other = recorded(scene_of(d), other_notes);
  simulation.set("/engines/tally/strength", 2);
  simulation.step(150);  // the ramp has begun
  for (const double value : {3.0, 4.0, 5.0}) {
    simulation.set("/engines/tally/strength", value);
    simulation.set("/engines/tally/shape/1", value);
  }
  simulation.step(100);
  other.resume(simulation.save());
  const auto tally = [](Simulation& one) -> const Tally& {
    return dynamic_cast<const Tally&>(*live_of(one).components().engines.at("tally"));
  };
  EXPECT_EQ(tally(simulation).shape, Vec3(4, 5, 0));
  EXPECT_EQ(tally(other).shape, tally(simulation).shape);
  EXPECT_EQ(tally(other).strength, 5);
  simulation.step(200), other.step(200);
  EXPECT_EQ(tally(other).shape, Vec3(8, 5, 0));
  EXPECT_EQ(tally(other).shape, tally(simulation).shape);
}

}  // namespace
}  // namespace grit::test::set_numbers_tests
