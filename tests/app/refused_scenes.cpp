// Descriptions that are read, but whose scene cannot be run: exit status 2, by `check` as by `run`.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

TEST(Descriptions, AreRefusedForAveragesOverTooManyCells) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto done = [&](const std::string& does, const std::string& type, const std::vector<std::string>& more) {
    std::vector<std::string> words{does, "two.json", "--set",
                                   "/probes/cells={\"type\": \"" + type +
                                       R"(", "every_steps": 50, "region_low": [0, 0, 0], "region_high": [1, 1, 1]})"};
    for (const std::string& set : more) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words);
  };
  for (const std::string type : {"stress", "void-ratio"}) {
    for (const std::string does : {"check", "run"}) {
      const auto outcome = done(does, type, {});
      EXPECT_EQ(outcome.status, 2) << does << type;
      EXPECT_THAT(outcome.err,
                  AllOf(HasSubstr("--set: /probes/cells/cell_step: found averaging cells every 1 mean diameters of "
                                  "0.002 m in a region of 1 x 1 x 1 m, whose edges divide it into up to 973.242 "
                                  "million parts; allowed is up to 8 million: a cell_step of at least 5.1, a "
                                  "depth_axis, or a smaller region\n"),
                        HasSubstr("1 problem")))
          << does << type;
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does << type;
    }
    EXPECT_EQ(done("check", type, {"/probes/cells/cell_step=5.1"}).status, 0) << type;
    const auto infinite = done("check", type, {"/probes/cells/region_high=[1e300, 1e300, 1e300]"});
    EXPECT_EQ(infinite.status, 2) << type;
    EXPECT_THAT(infinite.err, HasSubstr("or a smaller region")) << type;
  }
  EXPECT_EQ(done("check", "stress", {"/probes/cells/frames=false"}).status, 0) << "its channels need no cells";
  EXPECT_EQ(done("check", "stress", {"/output/frames=null"}).status, 0);
}

/// Faults that show only at the first step are located, too, and leave no folder behind.
TEST(Descriptions, AreRefusedForFaultsOfTheFirstInstant) {
  const std::string start = R"({
  "contacts": {"type": "linear-frictional"},
  "materials": {"sand": {"density": 2600}},
  "bodies": {
    "sand": {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": [
      {"position": [0, 0, 0.02], "radius": 0.005})";
  const std::string middle = R"(
    ]}}
  },
  "walls": {
    "floor": {"type": "plane", "material": "sand", "normal": [0, 0, )";
  const std::string end = R"(]}
  },
  "stages": [{"name": "fall", "until": {"type": "time", "value": 0.01}, "limit": 1}])";
  const auto expect = [&](const std::string& text, const std::string& problem) {
    const OwnFolder folder;
    folder.write("box.json", text);
    for (const std::string does : {"check", "run"}) {
      const auto outcome = grit_in(folder.path(), {does, "box.json"});
      EXPECT_EQ(outcome.status, 2) << does;
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(problem), HasSubstr("1 problem"))) << does;
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does;
    }
  };
  expect(start + middle + "-1" + end + "}",
         "box.json:10: /walls/floor: wall \"floor\" faces away from the bodies: 1 of 1 have their centres behind it");
  expect(start + R"(, {"position": [0, 0, 0.021], "radius": 0.005})" + middle + "1" + end + "}",
         "box.json:5: /bodies/sand: body 0 at (0, 0, 0.02) m overlaps body 1 by 1.8 of its radius");
  expect(start + middle + "1" + end + ",\n  \"time_step\": {\"value\": 1}}",
         "box.json:13: /time_step/value: the time step 1 s is above the critical one, ");
  expect(start + middle + "1" + end + ",\n  \"domain\": {\"low\": [-1, -1, 0], \"high\": [1, 1, 0.01]}}",
         "box.json:5: /bodies/sand: a body at (0, 0, 0.02) m is outside the domain");
  expect(start + R"(, {"position": [0, 0, 0.05], "radius": 0.005})" + middle + "1" + end +
             ",\n  \"domain\": {\"low\": [-1, -1, 0], \"high\": [1, 1, 0.01]}}",
         "box.json:5: /bodies/sand: 2 bodies, the first at (0, 0, 0.02) m, are outside the domain; enlarge /domain or "
         "move the bodies");
  expect(start + middle + "1" + end + ",\n  \"output\": {\"summary\": [\"packing/none\"]}}",
         "box.json:13: /output/summary/0: found \"packing/none\", which is not a scalar channel of any probe");
}

TEST(Descriptions, AreRefusedForTooManyMaterials) {
  std::string materials;
  for (int i = 0; i < 256; ++i) materials += (i > 0 ? ", " : "") + ("\"m" + std::to_string(i) + "\": {}");
  const OwnFolder folder;
  folder.write("many.json", R"({
  "contacts": {"type": "linear-frictional"},
  "materials": {)" + materials + R"(},
  "bodies": {"sand": {"type": "sphere", "material": "m0", "source": {"type": "list", "bodies": [
    {"position": [0, 0, 0], "radius": 0.005}]}}},
  "stages": [{"name": "fall", "until": {"type": "time", "value": 0.01}, "limit": 1}]
})");
  const auto outcome = grit_in(folder.path(), {"check", "many.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("many.json:3: /materials: found 256 materials; allowed is 255 or fewer"));
}

/// Before memory is taken or anything is written, by `check` too.
TEST(Descriptions, AreRefusedForMoreThanMemoryOrDiskHold) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto refused = [&](const std::vector<std::string>& sets, const std::string& problem) {
    for (const std::string does : {"check", "run"}) {
      std::vector<std::string> words{does, "two.json"};
      for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
      const auto outcome = grit_in(folder.path(), words);
      EXPECT_EQ(outcome.status, 2) << does << ' ' << sets.front();
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(problem),
                                     HasSubstr(" available: use fewer bodies, or a machine with "
                                               "more memory"),
                                     HasSubstr("1 problem")))
          << does << ' ' << sets.front();
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does << ' ' << sets.front();
    }
  };
  const std::string cloud = R"(/bodies/grains/source={"type": "cloud", "low": [0, 0, 0], "high": [9, 9, 9], "count":
      4000000000, "sizes": {"type": "uniform", "smallest": "1 mm", "largest": "2 mm"}})";
  const std::string many =
      "--set: /bodies/grains/source: found 4000000000 bodies, which need about 2.8 TB of memory "
      "with their contacts; allowed is up to ";
  refused({cloud}, many);
  refused({cloud, "/time_step/value=1e-7"}, many);
  refused({R"(/bodies/grains/source={"type": "lattice", "kind": "fcc", "low": [0, 0, 0], "high": [1000, 1000, 1000],
               "diameter": "1 mm"})"},
          "found 1000000000000000 bodies, which need about 700 PB of memory");
  refused({cloud, "/bodies/grains/type=clump", R"(/bodies/grains/shape={"type": "rod", "count": 3, "spacing": 0.5})"},
          "found 12000000000 bodies, which need about 8.4 TB of memory");
  refused({cloud, "/bodies/grains/stage=part"}, many);

  for (const std::string until : {R"({"type": "steps", "value": 10000000000000})", R"({"type": "time", "value": 1e9})"})
    for (const std::string does : {"check", "run"}) {
      const auto outcome =
          grit_in(folder.path(), {does, "two.json", "--set", R"(/output/frames={"every_steps": 1})", "--set",
                                  "/stages/0/until=" + until, "--set", "/stages/0/limit=1e10"});
      EXPECT_EQ(outcome.status, 2) << does << until;
      EXPECT_THAT(outcome.err,
                  AllOf(HasSubstr("--set: /output/frames: found at least "), HasSubstr(" frames of 8.18 kB each, "),
                        HasSubstr("; allowed is as many as fit on the disk of the results, which has "),
                        HasSubstr("1 problem")))
          << does << until;
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does << until;
    }
}

TEST(Descriptions, AreRefusedForBodiesThatTheArithmeticCannotHold) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  folder.write("tiny.txt", "0 0 0 1\n3 0 0 1e-320\n");
  const auto refused = [&](const std::vector<std::string>& sets, const std::string& problem) {
    for (const std::string does : {"check", "run"}) {
      std::vector<std::string> words{does, "two.json"};
      for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
      const auto outcome = grit_in(folder.path(), words);
      EXPECT_EQ(outcome.status, 2) << does << ' ' << sets.front();
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(problem), HasSubstr("1 problem"))) << does << ' ' << sets.front();
      EXPECT_FALSE(std::filesystem::exists(folder.path() / "results")) << does << ' ' << sets.front();
    }
  };
  const std::string first = "/bodies/grains/source/bodies/0/";
  refused({first + "radius=1e-320"},
          "/bodies/grains: found a radius of 1e-320 m; allowed is from 1e-15 to 1e+12 m; is the unit right?");
  refused({first + "radius=1e200"}, "/bodies/grains: found a radius of 1e+200 m; allowed is from 1e-15 to 1e+12 m");
  refused({first + "position=[1e308, 0, 0]"},
          "/bodies/grains: found a body at (1e+308, 0, 0) m; allowed are positions up to 1e+15 m from the origin along "
          "each axis; is the unit right?");
  refused({first + "position=[0, 0, -1e16]"}, "found a body at (0, 0, -1e+16) m");
  refused({"/materials/sand/density=1e-300"}, "/bodies/grains: found a body with a mass of 4.189e-309 kg");
  refused({R"(/bodies/grains/source={"type": "file", "path": "tiny.txt"})"},
          "/bodies/grains: found a radius of 1e-320 m");
  const auto cloud = [](const std::string& smallest) {
    return R"(/bodies/grains/source={"type": "cloud", "low": [0, 0, 0], "high": [1, 1, 1], "count": 9, "sizes":
              {"type": "list", "diameters": [0.001, )" +
           smallest + "]}}";
  };
  refused({cloud("1e-320")},
          "/bodies/grains: cloud: found diameters from 1e-320 to 0.001 m; allowed are 2e-15 to 2e+12 m");
  refused({R"(/bodies/poured={"type": "sphere", "material": "sand", "source": {"type": "stream", "number_rate": 100,
              "region": {"type": "disc", "centre": [0, 0, 1], "radius": "1 cm"},
              "sizes": {"type": "list", "diameters": [0.001, 1e-320]}}})"},
          "/bodies/poured: found a radius of ");
}

TEST(Descriptions, ProbesAndWallsThatDoNotFitTheSceneAreLocated) {
  const OwnFolder folder;
  folder.write("base.json", two_grains);
  folder.write("two.json", R"({
  "extends": "base.json",
  "walls": {"plate": {"type": "plane", "point": [0, 0, "-1 cm"], "normal": [0, 0, 1], "material": "sand"}},
  "probes": {
    "force": {
      "type": "walls",
      "every_steps": 10,
      "walls": ["plat"]
    },
    "curve": {"type": "formula", "every_steps": 10, "curves": {"speed": {
      "formula": "2 * plate_sped"
    }}}
  },
  "stages": [
    {"name": "part", "until": {"type": "steps", "value": 200}, "limit": "1 s"},
    {"name": "shake", "until": {"type": "steps", "value": 20}, "limit": "1 s", "change": {"walls": {"plate": {"motion": {
      "oscillation": {"amplitude": [0, 0, "1 um"], "frequency": "1e9 Hz"}
    }}}}}
  ]
})");
  const std::string curve = R"(/probes/curve/curves/speed/formula="plate_force_x")",
                    plate = R"(/probes/force/walls=[])";
  const auto refusal = [&](const std::string& does, const std::vector<std::string>& sets) {
    std::vector<std::string> words{does, "two.json"};
    if (does == "run") words.insert(words.end(), {"--out", "out", "--overwrite"});
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 2) << does;
    return outcome.err;
  };
  for (const std::string does : {"check", "run"}) {
    EXPECT_THAT(refusal(does, {curve}), HasSubstr("two.json:8: /probes/force/walls: found \"plat\", which is not a "
                                                  "wall; did you mean \"plate\"? Allowed is one of the walls plate\n"));
    EXPECT_THAT(
        refusal(does, {plate}),
        HasSubstr("two.json:11: /probes/curve/curves/speed/formula: found \"2 * plate_sped\": the unknown name"));
    EXPECT_THAT(refusal(does, {plate, R"(/probes/curve/curves/speed/formula="nothing")"}),
                HasSubstr("--set: /probes/curve/curves/speed/formula: found \"nothing\": the unknown name"));
    EXPECT_THAT(
        refusal(does, {plate, curve}),
        HasSubstr(
            "two.json:17: /stages/1/change/walls/plate/motion/oscillation: wall \"plate\": oscillates at 1e+09 Hz"));
    const auto ramped = refusal(
        does, {plate, curve, R"(/walls/plate/motion/oscillation={"amplitude": [0, 0, "1 um"], "frequency": 1})",
               R"(/stages/0/change={"walls": {"plate": {"motion": {"ramp_time": "1 us"}}}})",
               R"(/stages/0/ramps=[{"pointer": "/walls/plate/motion/oscillation/frequency", "from": 1, "to": 1e9,)"
               R"( "duration": 1e-4, "increments": 2}])"});
    EXPECT_THAT(ramped, HasSubstr("--set: /stages/0/ramps/0: wall \"plate\": oscillates at 5e+08 Hz"));
  }
  EXPECT_EQ(json::parse(text_of(folder / "out/run.json")).at("status"), "failed");
}

TEST(Descriptions, LetALaterServoPressOnTheSpecimenWhereItsPlaneHasNoArea) {
  const OwnFolder folder;
  folder.write("base.json", two_grains);
  folder.write("two.json", R"({
  "extends": "base.json",
  "domain": {"low": ["-1 cm", "-1 cm", "-1 cm"], "high": ["1 cm", "1 cm", "1 cm"], "periodic": [true, true, false]},
  "walls": {"lid": {"type": "plane", "point": [0, 0, "1 cm"], "normal": [0, 0, -1], "material": "sand"}},
  "stages": [
    {"name": "part", "until": {"type": "steps", "value": 20}, "limit": "1 s"},
    {"name": "press", "until": {"type": "steps", "value": 20}, "limit": "1 s", "change": {"walls": {"lid": {"motion": {
      "servo": {"axis": "z", "pressure": "1 kPa", "max_velocity": "1 mm/s"}
    }}}}}
  ]
})");
  const auto bare = grit_in(folder.path(), {"check", "two.json"});
  EXPECT_EQ(bare.status, 2);
  EXPECT_THAT(bare.err, HasSubstr("two.json:8: /stages/1/change/walls/lid/motion/servo: found a servo pressure on a "
                                  "geometry without an area"));
  const std::string area = R"(/stages/1/change/walls/lid/motion/servo/area="specimen")";
  const auto open = grit_in(folder.path(), {"check", "two.json", "--set", area, "--set", "/domain={}"});
  EXPECT_EQ(open.status, 2);
  EXPECT_THAT(open.err, HasSubstr("two.json:8: /stages/1/change/walls/lid/motion/servo: found a servo on the "
                                  "cross-section of the specimen, which is open"));
  for (const std::string does : {"check", "run"}) {
    const auto outcome = grit_in(folder.path(), {does, "two.json", "--set", area});
    EXPECT_EQ(outcome.status, 0) << does << ": " << outcome.err;
  }
}

TEST(Descriptions, AreRefusedWhereAStageAddsOrTakesAwayAWall) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const std::string bottom = R"(/walls/bottom={"type": "plane", "point": [0, 0, "-2 mm"], "material": "sand"})";
  const auto outcome = [&](const std::string& walls) {
    return grit_in(folder.path(),
                   {"check", "two.json", "--set", bottom, "--set", "/stages/0/change={\"walls\": " + walls + '}'});
  };
  const auto taken = outcome(R"({"bottom": null})"), all = outcome("null"),
             added = outcome(R"({"a": {"type": "plane", "point": [0, 0, "-3 mm"], "material": "sand"}})");
  EXPECT_EQ(taken.status, 2);
  EXPECT_THAT(taken.err, HasSubstr("/stages/0/change/walls/bottom: found null, which would remove a wall; allowed"));
  EXPECT_EQ(all.status, 2);
  EXPECT_THAT(all.err, HasSubstr("/stages/0/change/walls: found null, which would remove a wall"));
  EXPECT_EQ(added.status, 2);
  EXPECT_THAT(added.err,
              HasSubstr("/stages/0/change/walls/a: found a wall that does not exist at the start of the run"));
  EXPECT_EQ(outcome(R"({"bottom": {"point": [0, 0, "-3 mm"]}})").status, 0);
  const auto list = outcome("[]");
  EXPECT_EQ(list.status, 2);
  EXPECT_THAT(list.err, testing::Not(HasSubstr("remove a wall")));
}

}  // namespace
}  // namespace grit
