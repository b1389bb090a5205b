// What `check` reports of a run: time step, memory, time, frames, bodies.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

TEST(Check, ReportsTheRun) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto outcome = grit_in(folder.path(), {"check", "two.json", "--threads", "1"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("two.json: two grains"), HasSubstr("linear-rolling"), HasSubstr("time step: "),
                    HasSubstr("critical"), HasSubstr("memory: "), HasSubstr("bodies: 2"),
                    HasSubstr("contacts of pairs at the start: 1"), HasSubstr("estimated time on 1 thread "),
                    HasSubstr("frames: about 3 of "), HasSubstr(" are free on this disk\n")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST(Check, EstimatesRanks) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto outcome = grit_in(folder.path(), {"check", "two.json", "--threads", "1", "--ranks", "8"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  // Two bodies of which each rank keeps 340 bytes, and 360 on one of eight ranks.
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("memory of each of 8 ranks: about 770 bytes when dense\n"),
                                 HasSubstr("estimated time on 8 ranks of 1 thread ")));
  const auto none = grit_in(folder.path(), {"check", "two.json", "--ranks", "0"});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.err, HasSubstr("--ranks takes a number from 1 to 1024, not \"0\""));
}

TEST(Check, CountsTheStepsOfEachStageAndRefusesThoseThatNeverEnd) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["output"].erase("frames");
  scene["stages"][1] = {{"name", "wait"}, {"limit", 1e300}, {"until", {{"type", "time"}, {"value", 0.01}}}};
  folder.write("two.json", scene.dump());
  const auto grit = [&](const char* command, const std::vector<std::string>& sets) {
    std::vector<std::string> words{command, "two.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words);
  };
  const auto finer = grit("check", {"/time_step/value=1e-6", R"(/stages/1/change={"time_step": {"value": 1e-9}})"});
  EXPECT_EQ(finer.status, 0) << finer.err;
  EXPECT_THAT(finer.out, AllOf(HasSubstr("0.0002 s, 200 steps"), HasSubstr("0.01 s, 10000000 steps")));
  for (const char* command : {"check", "run"}) {
    for (const char* set : {"/stages/1/until/value=1e15", "/materials/sand/contact_modulus=1e40"}) {
      const auto endless = grit(command, {set});
      EXPECT_EQ(endless.status, 2) << command << ' ' << set;
      EXPECT_THAT(endless.err, HasSubstr("/stages/1/until: time never reaches ")) << command << ' ' << set;
    }
    const auto stiff = grit(command, {"/materials/sand/contact_modulus=1e300"});
    EXPECT_EQ(stiff.status, 2) << command;
    EXPECT_THAT(stiff.err, HasSubstr("/time_step: time does not advance in steps of 0 s; check the units of "));
  }
}

TEST(Check, ReportsTheSpeedThatShortensTheTimeStep) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto speed = [&](const std::string& set) {
    const std::string out = grit_in(folder.path(), {"check", "two.json", "--set", set}).out;
    std::smatch found;
    return std::regex_search(out, found, std::regex("shorter where bodies or walls are faster than ([0-9.e+-]+) m/s"))
               ? std::stod(found[1])
               : 0;
  };
  const double usual = speed("/seed=1");
  EXPECT_GT(usual, 0);
  EXPECT_NEAR(speed("/time_step/max_displacement=4e-6") / usual, 1e-4, 1e-6) << "the default is 0.04";
  EXPECT_EQ(speed("/time_step/value=1e-6"), 0) << "it stays as prescribed";
}

TEST(Check, ReportsTheNumberAndSizeOfFrames) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto frames = [&](const std::string& set) {
    const std::string out = grit_in(folder.path(), {"check", "two.json", "--set", set}).out;
    const auto at = out.find("\nframes: ");
    return at == std::string::npos ? "" : out.substr(at + 1, out.find('\n', at + 1) - at - 1);
  };
  EXPECT_THAT(frames("/seed=1"),
              testing::MatchesRegex("frames: about 3 of [0-9.]+ kB each, [0-9.]+ kB in all; .*B are free on this disk"))
      << "at the steps 0, 100 and 200, as a run writes them";
  EXPECT_THAT(frames("/output/frames={\"every_steps\": 1}"), HasSubstr("about 201 of "));
  EXPECT_THAT(frames("/stages/0/until={\"type\": \"unbalanced-force\", \"below\": 1e-3}"),
              HasSubstr("frames: at most "));
  EXPECT_EQ(frames("/output/frames=null"), "");
  ASSERT_EQ(grit_in(folder.path(), {"run", "two.json"}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "results/two/frames/000002.h5"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/two/frames/000003.h5"));
}

TEST(Check, ReportsBodiesInsertedLater) {
  const OwnFolder folder;
  json scene = json::parse(two_grains);
  scene["bodies"]["late"] = scene["bodies"]["grains"];
  scene["bodies"]["late"]["stage"] = "part";
  folder.write("later.json", scene.dump());
  const auto outcome = grit_in(folder.path(), {"check", "later.json"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("bodies: 2, contacts of pairs at the start: 1\n  2 more in the stage part\n"));
}

TEST(Descriptions, CheckEstimatesFromTypicalTimesOfStages) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto check = [&](const std::string& set) {
    const auto outcome = grit_in(folder.path(), {"check", "two.json", "--threads", "1", "--set",
                                                 R"(/stages/0/until={"type": "unbalanced-force", "below": 0.01})",
                                                 "--set", "/stages/0/limit=36000 s", "--set", set});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const auto found = [](const std::string& text, const std::string& pattern) {
    std::smatch match;
    EXPECT_TRUE(std::regex_search(text, match, std::regex(pattern))) << text;
    return match.empty() ? -1.0 : std::stod(match[1]);
  };
  const std::string usual = check("/stages/0/typical_time=3600 s"), unusual = check("/seed=2");
  EXPECT_THAT(usual, HasSubstr("part            usually 3600 s, "));
  EXPECT_THAT(usual, HasSubstr(" (ends by its condition, 36000 s at most)\n"));
  EXPECT_THAT(unusual, HasSubstr("part            at most 36000 s, "));
  const double hours = found(usual, "particle-steps/s: ([0-9.]+) h");
  EXPECT_GT(hours, 0);
  EXPECT_NEAR(found(usual, "at most ([0-9.]+) h "), 10 * hours, 0.06);
  EXPECT_NEAR(found(unusual, "at most ([0-9.]+) h "), 10 * hours, 0.06);
  EXPECT_EQ(found(unusual, "particle-steps/s: ([0-9.]+) h"), 0) << "nothing is known of it";
}

}  // namespace
}  // namespace grit
