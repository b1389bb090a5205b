// The model in run.json: what a run stores and computes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

class ModelOfARun : public testing::Test {
 protected:
  ModelOfARun() { folder.write("two.json", two_grains); }
  json of(std::vector<std::string> settings) {
    // One step, so that the grains are still in contact when memory is counted.
    std::vector<std::string> words{
        "run", "two.json", "--out", "results", "--overwrite", "--set", "/stages/0/until/value=1"};
    for (const auto& one : settings) words.insert(words.end(), {"--set", one});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(text_of(folder / "results/run.json")).at("model");
  }
  OwnFolder folder;
};

TEST_F(ModelOfARun, KeepsNoHistoryOfRollingWithoutRollingResistance) {
  const json with = of({"/contacts/type=linear-rolling"});
  EXPECT_THAT(with.at("law_parts"), ElementsAre("shear", "rolling"));
  EXPECT_EQ(with.at("contact_state").size(), 6u);
  const json without = of({"/contacts/type=linear-rolling", "/materials/sand/rolling_limit=0"});
  EXPECT_THAT(without.at("law_parts"), ElementsAre("shear"));
  EXPECT_EQ(without.at("contact_state").size(), 3u);
  EXPECT_LT(without.at("bytes"), with.at("bytes"));
}

TEST_F(ModelOfARun, IsNotOfMaterialsThatNothingIsOf) {
  const std::string law = "/contacts/type=linear-rolling", smooth = "/materials/sand/rolling_limit=0";
  // Before and after sand in the order of names, with a rolling limit by default.
  const std::string first = R"(/materials/rock={"density": 2600})", last = R"(/materials/steel={"density": 7800})";
  const json alone = of({law, smooth});
  const json beside = of({law, smooth, first, last});
  EXPECT_THAT(beside.at("materials"), ElementsAre("sand", "rock", "steel"));
  EXPECT_THAT(beside.at("law_parts"), ElementsAre("shear"));
  EXPECT_EQ(beside.at("contact_state"), alone.at("contact_state"));
  EXPECT_EQ(beside.at("bytes"), alone.at("bytes"));
}
TEST_F(ModelOfARun, IsNotOfWhatTwoWallsWouldDoToEachOther) {
  const std::string law = "/contacts/type=linear-rolling", smooth = "/materials/sand/rolling_limit=0",
                    rock = R"(/materials/rock={"density": 2600})",
                    floor = R"(/walls/floor={"type": "plane", "material": "rock", "point": [0, 0, -1]})";
  EXPECT_THAT(of({law, smooth, rock, floor}).at("law_parts"), ElementsAre("shear"));
  EXPECT_THAT(of({law, rock, floor}).at("law_parts"), ElementsAre("shear", "rolling"));
}

TEST_F(ModelOfARun, KnowsAMaterialThatAStageGivesAWall) {
  const json later = of({"/contacts/type=linear-rolling", "/materials/sand/rolling_limit=0",
                         R"(/materials/steel={"density": 7800})", R"(/interfaces/sand+steel={"rolling_limit": 0.3})",
                         R"(/walls/floor={"type": "plane", "material": "sand", "point": [0, 0, -1]})",
                         R"(/stages/0/change={"walls": {"floor": {"material": "steel"}}})"});
  EXPECT_THAT(later.at("law_parts"), ElementsAre("shear", "rolling"));
}

TEST_F(ModelOfARun, HasNoHistoryWithoutFriction) {
  for (const std::string law : {"linear-frictional", "linear-rolling"}) {
    const std::string type = "/contacts/type=" + law, no_rolling = "/materials/sand/rolling_stiffness=0";
    const auto sets = [&](const std::string& more) {
      return law == "linear-rolling" ? std::vector<std::string>{type, no_rolling, more}
                                     : std::vector<std::string>{type, more};
    };
    const json with = of(sets("/seed=1"));
    EXPECT_THAT(with.at("contact_state"), ElementsAre("shear_x", "shear_y", "shear_z")) << law;
    for (const char* off : {"/materials/sand/friction_angle=0", "/materials/sand/shear_to_normal_stiffness=0"}) {
      const json without = of(sets(off));
      EXPECT_THAT(without.at("contact_state"), IsEmpty()) << law << off;
      EXPECT_LT(without.at("bytes"), with.at("bytes")) << law << off;
    }
  }
}

TEST_F(ModelOfARun, KeepsTheHistoryOfEachSpringOnlyWhereItExists) {
  const std::string law = "/contacts/type=linear-rolling", smooth = "/materials/sand/friction_angle=0",
                    no_rolling = "/materials/sand/rolling_limit=0",
                    twists = R"(/materials/sand={"twisting_stiffness": 1, "twisting_limit": 0.2})";
  EXPECT_THAT(of({law, smooth}).at("contact_state"), ElementsAre("rolling_x", "rolling_y", "rolling_z"));
  // Twisting is compiled with all springs only.
  EXPECT_THAT(of({law, twists, no_rolling, smooth}).at("contact_state"),
              ElementsAre("shear_x", "shear_y", "shear_z", "rolling_x", "rolling_y", "rolling_z", "twisting"));
  const std::string hertz = "/contacts/type=hertz-mindlin",
                    rolls = R"(/materials/sand={"rolling_stiffness": 1, "rolling_limit": 0.2})";
  EXPECT_THAT(of({hertz, rolls, smooth}).at("contact_state"),
              ElementsAre("contact_radius", "rolling_x", "rolling_y", "rolling_z"));
  EXPECT_LT(of({law, smooth}).at("bytes"), of({law}).at("bytes"));
}

TEST_F(ModelOfARun, RotationsAndDisplacementsAreKeptOnlyOnDemand) {
  const json plain = of({"/seed=2"});
  EXPECT_THAT(plain.at("body_state"), IsEmpty());
  EXPECT_EQ(plain.at("gravity"), false);
  const std::pair<const char*, const char*> asked[] = {
      {"rotations", "rotation"}, {"displacements", "displacement"}, {"energy", "energy"}};
  for (const auto& [probe, state] : asked) {
    const json kept = of({"/seed=2", R"(/probes/asks={"type": ")" + std::string(probe) + R"(", "every_steps": 10})"});
    EXPECT_THAT(kept.at("body_state"), ElementsAre(state));
    if (probe != std::string("energy")) EXPECT_GT(kept.at("bytes"), plain.at("bytes")) << probe;
  }
  const json falls = of({R"(/engines/weight={"type": "gravity"})"});
  EXPECT_EQ(falls.at("gravity"), true);
}

TEST_F(ModelOfARun, KnowsWallsClumpsAndTheLoop) {
  const json plain = of({});
  EXPECT_EQ(plain.at("walls"), false);
  EXPECT_EQ(plain.at("one_material"), true);
  EXPECT_EQ(plain.at("periodic"), false);
  EXPECT_GE(plain.at("lanes"), 1);
  EXPECT_EQ(plain.at("precision"), "double");
  EXPECT_EQ(of({"/contacts/precision=single"}).at("precision"), "single");
  const json walled = of({R"(/walls/floor={"type": "plane", "material": "sand", "point": [0, 0, -1]})"});
  EXPECT_EQ(walled.at("walls"), true);
  const json clumped = of({R"(/bodies/grains/type="clump")", R"(/bodies/grains/shape={"type": "rod"})"});
  EXPECT_THAT(clumped.at("body_state"), ElementsAre("clump"));
  const json run = json::parse(text_of(folder / "results/run.json"));
  ASSERT_EQ(run.at("clumps").size(), 1u);
  const json clump = run.at("clumps").at("grains");
  EXPECT_EQ(clump.at("spheres"), 2);
  for (const char* error : {"mass_error", "centre_error", "inertia_error"}) {
    EXPECT_GT(clump.at(error), 0) << error;
    EXPECT_LT(clump.at(error), 1e-3) << error;
  }
}

TEST_F(ModelOfARun, CheckReportsTheErrorsOfClumps) {
  const auto outcome = grit_in(folder.path(), {"check", "two.json", "--set", R"(/bodies/grains/type="clump")", "--set",
                                               R"(/bodies/grains/shape={"type": "rod", "count": 3})"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("clumps grains: 2 of 3 spheres each; errors: mass "));
}

TEST_F(ModelOfARun, IsOfOneMaterialWhateverTheNamesOfWallMaterials) {
  const json before = of({R"(/materials/frame={"density": 2600})",
                          R"(/walls/floor={"type": "plane", "material": "frame", "point": [0, 0, -1]})"});
  EXPECT_THAT(before.at("materials"), ElementsAre("sand", "frame"));
  EXPECT_EQ(before.at("one_material"), true);
  const json mixture = of(
      {R"(/materials/frame={"density": 2600})",
       R"(/bodies/other={"type": "sphere", "material": "frame", "source": {"type": "list", "bodies": [{"position": [0, 0, 3], "radius": 0.1}]}})"});
  EXPECT_EQ(mixture.at("one_material"), false);
}

}  // namespace
}  // namespace grit
