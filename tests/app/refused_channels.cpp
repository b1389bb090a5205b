// Channels and fields that descriptions name.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Descriptions, AreRefusedForChannelsThatNoProbeHas) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  for (const std::string does : {"check", "run"}) {
    const auto outcome = grit_in(
        folder.path(), {does, "two.json", "--set", R"(/output/picture={"x": "packing/time", "y": ["packing/nope"]})",
                        "--set", R"(/output/references={"a": {"of": "test/x", "value": 1}})", "--set",
                        R"(/output/summary=["packing/kinetic_energy", "packing/none"])"});
    EXPECT_EQ(outcome.status, 2) << does;
    EXPECT_THAT(
        outcome.err,
        AllOf(HasSubstr("--set: /output/picture/y/0: found \"packing/nope\", which is not a scalar channel of any "
                        "probe; allowed is one of packing/time, "),
              HasSubstr("/output/references/a/of: found \"test/x\""),
              HasSubstr("/output/summary/1: found \"packing/none\""), HasSubstr("3 problems")))
        << does;
  }
}

TEST(Descriptions, AreRefusedForFieldsThatNoProbeHas) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const std::string moved = R"(/probes/moved={"type": "displacements", "every_steps": 10})";
  const auto picture = [](const std::string& color) {
    return R"(/output/picture={"x": "packing/time", "y": ["packing/kinetic_energy"], "color": ")" + color + "\"}";
  };
  const auto refused = [&](const std::string& does, const std::vector<std::string>& sets) {
    std::vector<std::string> words{does, "two.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    return outcome.err;
  };
  for (const std::string does : {"check", "run"})
    EXPECT_THAT(
        refused(
            does,
            {moved, picture("moved/fluctuatoin"),
             R"(/output/color_scales=[{"of": "packing/void_ratoi", "high": 1}, {"of": "packing/stress/xx", "low": 0}])"}),
        AllOf(HasSubstr(
                  "--set: /output/picture/color: found \"moved/fluctuatoin\", which is not a field of bodies of any "
                  "probe; did you mean \"moved/fluctuation\"? Allowed is one of moved/fluctuation, "
                  "moved/fluctuation/x, moved/fluctuation/y, moved/fluctuation/z"),
              HasSubstr("/output/color_scales/0/of: found \"packing/void_ratoi\", which is not a field of any probe on "
                        "maps or bodies; did you mean \"packing/void_ratio\"? Allowed is one of "),
              HasSubstr("2 problems")))
        << does;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "results"));
  EXPECT_THAT(refused("check", {picture("packing/void_ratio")}),
              HasSubstr("found \"packing/void_ratio\", which is not a field of bodies of any probe; allowed is none "
                        "without probes that have such fields"));
  const std::string color = picture("moved/fluctuation");
  EXPECT_THAT(refused("check", {moved, color, "/probes/moved/frames=false"}),
              HasSubstr("found \"moved/fluctuation\" of a probe that is not in frames; allowed is a field of "
                        "a probe in frames: set /probes/moved/frames to true"));
  EXPECT_THAT(refused("check", {moved, color, "/output/frames=null"}),
              HasSubstr("found \"moved/fluctuation\" without frames, from which it is taken; allowed is a field "
                        "if /output/frames has an interval, e.g. every_time"));
  const std::string more =
      R"(/stages=[{"name": "part", "until": {"type": "steps", "value": 2}, "limit": 1}, {"name": "rest", "until": {"type": "steps", "value": 2}, "limit": 1}])";
  EXPECT_THAT(
      refused("check", {moved, color, more, R"(/probes/moved/stages=["part"])"}),
      HasSubstr("of a probe that does not sample in the last stage, after which the picture is drawn; allowed is "
                "a field of a probe that does: add \"rest\" to /probes/moved/stages"));
  EXPECT_THAT(refused("check", {picture("sped")}),
              HasSubstr("/output/picture/color: found \"sped\"; did you mean \"speed\"? Allowed is one of rotation, "
                        "displacement, speed, radius, group, or probe/field"));
  EXPECT_THAT(
      refused("check", {R"(/output/color_scales=[{"of": "speed"}, {"of": "speed", "low": 2, "high": 1}])"}),
      AllOf(HasSubstr("/output/color_scales/0/high: found neither low nor high; allowed is one of them, or both"),
            HasSubstr("/output/color_scales/1/high: found a value that is not above low; allowed is above low")));
  const auto fine = grit_in(folder.path(), {"run", "two.json", "--quiet", "--set", moved, "--set", color});
  EXPECT_EQ(fine.status, 0) << fine.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "results/two/picture.svg"));
}

TEST(Descriptions, MayNameTheTimeOfSamplesWhereverChannelsAreNamed) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  for (const std::string does : {"check", "run"}) {
    const auto outcome =
        grit_in(folder.path(),
                {does, "two.json", "--set", R"(/output/picture={"x": "packing/mean_stress", "y": ["packing/time"]})",
                 "--set", R"(/output/references={"a": {"of": "packing/time", "value": 1}})", "--set",
                 R"(/output/summary=["packing/time"])"});
    EXPECT_EQ(outcome.status, 0) << does << outcome.err;
    if (does == "run") EXPECT_THAT(outcome.out, StartsWith("packing/time: peak "));
  }
}

}  // namespace
}  // namespace grit
