// Speed against accuracy: `study` runs a study, `advise` applies it.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// Two grains part; the step varies, and whether there is damping. The seed changes nothing.
constexpr auto study = R"({
  "title": "two grains part",
  "scene": "two.json",
  "set": {"/stages/0/until": {"type": "time", "value": "20 us"}},
  "settings": {
    "safety": {"pointers": ["/time_step/safety"], "values": [0.8, 0.1, 0.01]},
    "damping": {"pointers": ["/engines/damping/coefficient"], "values": [0.5, 0], "usual": "0"}
  },
  "seeds": {"values": [1, 2]},
  "metrics": {"energy": {"type": "last", "of": "packing/kinetic_energy"}},
  "tolerance": 0.01
}
)";

class Studies : public testing::Test {
 protected:
  Studies() {
    auto scene = json::parse(two_grains);
    scene["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0}};
    scene["output"].erase("frames");
    scene["time_step"]["steps_per_impact"] = 0;  // the safety alone sets the step
    folder.write("two.json", scene.dump());
    folder.write("study.json", study);
  }
  Outcome grit(std::vector<std::string> words) { return grit_in(folder.path(), std::move(words)); }
  json result() const { return json::parse(text_of(folder / "results/study/study.json")); }
  OwnFolder folder;
};

TEST_F(Studies, RefuseVariantsOfOneFolder) {
  json two = json::parse(study);
  two["settings"] = {{"safety",
                      {{"pointers", {"/time_step/safety"}},
                       {"values", {0.8, 0.1, 0.05, 0.01}},
                       {"labels", {"a", "b c", "b/c", "d"}}}}};
  folder.write("study.json", two.dump(1));
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--dry-run"}, {"--only", "runs/usual/seed-1"}}) {
    std::vector<std::string> words{"study", "study.json"};
    words.insert(words.end(), more.begin(), more.end());
    const auto refused = grit(words);
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err,
                AllOf(ContainsRegex("study.json:[0-9]+: /settings: found the variants \"safety=b c\" and "
                                    "\"safety=b/c\", whose runs would both be in results/study/runs/safety=b_c; "
                                    "allowed is levels whose"),
                      HasSubstr("1 problem in the description")));
    EXPECT_FALSE(std::filesystem::exists(folder / "results"));
  }
  two["settings"]["safety"]["labels"] = {"a", "b", std::string(260, 'c'), "d"};
  folder.write("study.json", two.dump(1));
  const auto refused = grit({"study", "study.json"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("whose folder would have a name of 267 bytes; allowed is up to 255"));
}

TEST_F(Studies, AreRunEvaluatedAndNotRunAgain) {
  const auto first = grit({"study", "study.json", "--jobs", "2"});
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("8 of 8 runs to do"));
  EXPECT_THAT(first.out, AllOf(HasSubstr("  usual: "), HasSubstr("  safety=0.1: "), HasSubstr("within 1.0 %"),
                               HasSubstr("Nothing is random in this scene: the seed has no effect"),
                               HasSubstr("page: results/study/study.html")));
  const auto all = result();
  ASSERT_EQ(all.at("variants").size(), 4u);
  const auto error = [&](std::size_t variant) {
    return all.at("variants")[variant].at("metrics").at("energy").at("error").get<double>();
  };
  EXPECT_EQ(all.at("parts"),
            json({"bodies grains: sphere", "contacts linear-rolling", "engine damping: local-damping", "stage part"}));
  EXPECT_EQ(all.at("variants")[3].at("name"), "finest");
  EXPECT_EQ(error(3), 0);
  EXPECT_GT(error(0), error(2)) << "a longer step is further off";
  EXPECT_GT(error(1), 0.1) << "damping takes energy away";
  EXPECT_GT(all.at("variants")[3].at("steps"), all.at("variants")[0].at("steps"));
  EXPECT_THAT(text_of(folder / "results/study/study.html"), HasSubstr("two grains part"));
  EXPECT_THAT(text_of(folder / "results/study/study.csv"), HasSubstr("\"safety=0.1\""));

  const auto second = grit({"study", "study.json"});
  EXPECT_EQ(second.status, 0);
  EXPECT_THAT(second.err, HasSubstr("0 of 8 runs to do"));
  EXPECT_EQ(second.out, first.out);
  // What is missing is run again; what another description made, if that is wanted.
  folder.write("results/study/runs/usual/seed-1/run.json", R"({"status": "done"})");
  folder.write("study.json", std::string(study).replace(std::string(study).find("0.1,"), 4, "0.2,"));
  EXPECT_THAT(
      grit({"study", "study.json", "--dry-run"}).out,
      AllOf(HasSubstr("usual, seed 1\n"), HasSubstr("safety=0.2, seed 2\n"), HasSubstr("3 of 8 runs are missing")));
}

TEST_F(Studies, ReplaceRunsOfAnotherDescriptionIfThatIsWanted) {
  ASSERT_EQ(grit({"study", "study.json"}).status, 0);
  const auto page = text_of(folder / "results/study/study.html");
  const std::string run = "results/study/runs/finest/seed-2/run.json";
  const auto kept = text_of(folder / run);
  auto scene = json::parse(text_of(folder / "two.json"));
  scene["materials"]["sand"]["density"] = 1000;
  folder.write("two.json", scene.dump());
  const std::string why =
      "results/study: holds 8 runs of another description, another grit or another build of a plugin, the first in "
      "results/study/runs/usual/seed-1; give --overwrite to replace them, or choose another folder with --out\n";
  const auto refused = grit({"study", "study.json"});
  EXPECT_EQ(refused.status, 5);
  EXPECT_THAT(refused.err, HasSubstr(why));
  EXPECT_EQ(text_of(folder / "results/study/study.html"), page);
  EXPECT_EQ(text_of(folder / run), kept);
  EXPECT_THAT(grit({"study", "study.json", "--dry-run"}).out,
              HasSubstr("8 of them replace runs of another description, and need --overwrite\n"));
  EXPECT_EQ(grit({"study", "study.json", "--overwrite"}).status, 0);
  EXPECT_EQ(json::parse(text_of(folder / run))["description"]["materials"]["sand"]["density"], 1000);
}

TEST_F(Studies, ReportFailedVariants) {
  const auto outcome = grit({"study", "study.json"});
  ASSERT_EQ(outcome.status, 0);
  auto changed = json::parse(study);
  changed["settings"]["travel"] = {{"pointers", {"/guards/travel"}}, {"values", {1e-9, 0.05}}, {"usual", "0.05"}};
  folder.write("study.json", changed.dump());
  const auto failing = grit({"study", "study.json"});
  EXPECT_EQ(failing.status, 0) << failing.err;
  EXPECT_THAT(failing.out, HasSubstr("more than /guards/travel 1e-09"));
  EXPECT_THAT(text_of(folder / "results/study/study.html"), HasSubstr("more than /guards/travel 1e-09"));
}

TEST_F(Studies, EndWithStatus4IfTheReferenceFails) {
  auto changed = json::parse(study);
  changed["settings"]["travel"] = {{"pointers", {"/guards/travel"}}, {"values", {0.05, 1e-9}}};
  folder.write("study.json", changed.dump());
  const auto outcome = grit({"study", "study.json"});
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.out, HasSubstr("there is no reference"));
}

TEST_F(Studies, ReportMetricsThatCannotBeEvaluated) {
  auto changed = json::parse(study);
  folder.write("lab.csv", "x,y\n500,1\n1000,2\n");
  changed["metrics"]["begin"] = {{"type", "minimum"}, {"of", "packing/kinetic_energy"}};
  changed["metrics"]["lab"] = {
      {"type", "curve"}, {"of", "packing/kinetic_energy"}, {"curve", {{"file", "lab.csv"}, {"x", "x"}, {"y", "y"}}}};
  folder.write("study.json", changed.dump());
  const auto some = grit({"study", "study.json"});
  EXPECT_EQ(some.status, 0);
  EXPECT_THAT(some.err, AllOf(HasSubstr("grit: not evaluated: begin: its reference is 0"),
                              HasSubstr("grit: not evaluated: lab: no run overlaps the range of its reference")));
  EXPECT_THAT(some.out, HasSubstr("safety=0.1: "));
  const json metrics = result().at("metrics");
  EXPECT_THAT(metrics.at("lab").at("not_charted").get<std::string>(), HasSubstr("check the units"));
  EXPECT_GT(metrics.at("energy").at("scale"), 0);
  changed["metrics"].erase("energy");
  folder.write("study.json", changed.dump());
  const auto none = grit({"study", "study.json"});
  EXPECT_EQ(none.status, 4);
  EXPECT_THAT(none.out, HasSubstr("No metric could be evaluated."));
  const auto advice = grit({"advise", "two.json", "--study", "results/study/study.json"});
  EXPECT_EQ(advice.status, 5);
  EXPECT_THAT(advice.err, HasSubstr("has no errors of any metric"));
}

TEST_F(Studies, AreOneAtATimeInAFolder) {
  auto changed = json::parse(study);
  changed["set"]["/stages/0/until"]["value"] = "1 s";
  changed["set"]["/stages/0/limit"] = "2 s";
  folder.write("long.json", changed.dump());
  Program first(grit_with({"study", "long.json", "--jobs", "1"}), folder.path());
  ASSERT_TRUE(first.wait_for("running"));
  const auto names = [&] {
    std::vector<std::string> all;
    for (const auto& one : std::filesystem::recursive_directory_iterator(folder / "results"))
      if (one.path().string().find("usual/seed-1") == std::string::npos) all.push_back(one.path());
    return all;
  };
  const auto before = names();
  for (const char* option : {"--quiet", "--collect"}) {
    const auto second = grit({"study", "long.json", option});
    EXPECT_EQ(second.status, 5);
    EXPECT_THAT(second.err, HasSubstr("results/long: another 'grit study'"));
  }
  EXPECT_EQ(names(), before);
  EXPECT_EQ(grit({"study", "long.json", "--dry-run"}).status, 0);
  first.interrupt();
  EXPECT_EQ(first.finish().status, 130);
}

TEST_F(Studies, BeginNothingThatCannotBeRun) {
  auto changed = json::parse(study);
  changed["settings"]["safety"]["pointers"] = {"/time_step/safty"};
  folder.write("typo.json", changed.dump());
  const auto typo = grit({"study", "typo.json"});
  EXPECT_EQ(typo.status, 2);
  EXPECT_THAT(typo.err, AllOf(HasSubstr("typo.json, usual: /time_step/safty"), HasSubstr("did you mean \"safety\"")));
  const auto description = grit({"study", "two.json"});
  EXPECT_EQ(description.status, 2);
  EXPECT_THAT(
      description.err,
      HasSubstr("/contacts: found a description of a simulation; allowed is a study, which names a description in "
                "\"scene\" and varies it. 'grit run two.json' runs this one\n"));
  folder.write("key.json", R"({"scene": "two.json", "setting": {}})");
  const auto key = grit({"study", "key.json"});
  EXPECT_EQ(key.status, 2);
  EXPECT_THAT(key.err, AllOf(HasSubstr("key.json:1: /setting"), HasSubstr("settings")));
  changed = json::parse(study);
  changed["metrics"]["energy"]["of"] = "walls/force";
  folder.write("probe.json", changed.dump());
  const auto probe = grit({"study", "probe.json"});
  EXPECT_EQ(probe.status, 2);
  EXPECT_THAT(probe.err,
              HasSubstr("probe.json:1: /metrics/energy/of: found the probe \"walls\", which is not in the scene; "
                        "allowed is one of packing"));
  changed["metrics"]["energy"] = {
      {"type", "curve"}, {"of", "packing/kinetic_energy"}, {"curve", {{"file", "none.csv"}, {"x", "x"}, {"y", "y"}}}};
  folder.write("file.json", changed.dump());
  const auto file = grit({"study", "file.json"});
  EXPECT_EQ(file.status, 2);
  EXPECT_THAT(file.err, AllOf(HasSubstr("file.json:1: /metrics/energy/curve/file: "),
                              HasSubstr("none.csv: cannot be read: No such file or directory; allowed is the path")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
  EXPECT_EQ(grit({"study"}).status, 1);
  for (const char* jobs : {"0", "-1", "2x"}) {
    const auto number = grit({"study", "study.json", "--jobs", jobs});
    EXPECT_EQ(number.status, 1);
    EXPECT_THAT(number.err, HasSubstr("--jobs takes a number from 1 to 1024, not \"" + std::string(jobs) + '"'));
  }
  changed = json::parse(study);
  changed["settings"]["damping"]["pointers"] = {"/time_step/safety"};
  folder.write("twice.json", changed.dump());
  const auto twice = grit({"study", "twice.json"});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.err, HasSubstr("/settings/safety/pointers/0: found /time_step/safety, of which "
                                   "/settings/damping/pointers/0 changes /time_step/safety"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
  changed = json::parse(study);
  changed["settings"]["duration"] = {{"pointers", {"/stages/0/until/value"}}, {"values", {"20 us", "0.02 ms"}}};
  folder.write("same.json", changed.dump());
  const auto same = grit({"study", "same.json", "--dry-run"});
  EXPECT_EQ(same.status, 2);
  EXPECT_THAT(same.err, HasSubstr("same.json:1: /settings: found usual and duration=0.02 ms, which are the same run; "
                                  "allowed are levels with different values"));
  const auto both = grit({"study", "study.json", "--dry-run", "--collect"});
  EXPECT_EQ(both.status, 1);
  EXPECT_THAT(both.err, HasSubstr("--collect starts none; give one of them"));
}

TEST_F(Studies, CheckChannelsBeforeAnyRun) {
  auto changed = json::parse(study);
  changed["metrics"]["energy"]["of"] = "packing/kinetic_enrgy";
  changed["metrics"]["late"] = {{"type", "last"}, {"of", "packing/kinetic_energy"}, {"against", "packing/tme"}};
  folder.write("study.json", changed.dump(2));
  const auto outcome = grit({"study", "study.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(
      outcome.err,
      AllOf(ContainsRegex("study.json:[0-9]+: /metrics/energy/of: found \"packing/kinetic_enrgy\", which is not a "
                          "channel of the probe; did you mean \"packing/kinetic_energy\"\\? Allowed is one of"),
            HasSubstr("/metrics/late/against: found \"packing/tme\""), HasSubstr("did you mean \"packing/time\"?")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
  changed["metrics"].erase("late");
  changed["metrics"]["energy"]["of"] = "packing/stress";
  folder.write("study.json", changed.dump());
  const auto wide = grit({"study", "study.json"});
  EXPECT_EQ(wide.status, 2);
  EXPECT_THAT(wide.err, HasSubstr("/metrics/energy/of: found \"packing/stress\", which has several values per sample"));
  changed["metrics"]["energy"] = {
      {"type", "value"}, {"of", "packing/kinetic_energy"}, {"at", "10 mm"}, {"value", "2 deg"}};
  folder.write("study.json", changed.dump());
  const auto unit = grit({"study", "study.json"});
  EXPECT_EQ(unit.status, 2);
  EXPECT_THAT(
      unit.err,
      AllOf(HasSubstr("/metrics/energy/value: found the text \"2 deg\"; allowed is a number in J, or a text with "
                      "a number and one of J, mJ"),
            HasSubstr("/metrics/energy/at: found the text \"10 mm\"; allowed is a number in s"),
            HasSubstr("2 problems")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST_F(Studies, LocateAProbeThatDoesNotFitTheScene) {
  auto scene = json::parse(text_of(folder / "two.json"));
  scene["probes"]["force"] = {{"type", "walls"}, {"every_steps", 10}, {"walls", {"plat"}}};
  folder.write("two.json", scene.dump(2));
  const std::string text = text_of(folder / "two.json");
  const auto line = 1 + std::ranges::count(text.substr(0, text.find("\"walls\": [")), '\n');
  const auto outcome = grit({"study", "study.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("two.json:" + std::to_string(line) +
                                     ": /probes/force/walls: found \"plat\", which is not a wall"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST_F(Studies, RunAgainWhatHasLostItsSeries) {
  ASSERT_EQ(grit({"study", "study.json", "--quiet"}).status, 0);
  const std::string run = "results/study/runs/usual/seed-1";
  std::filesystem::remove(folder / (run + "/series.h5"));
  const auto drawn = grit({"study", "study.json", "--collect"});
  EXPECT_EQ(drawn.status, 0);
  EXPECT_THAT(drawn.err, AllOf(HasSubstr(run + ": the run is done, but its series.h5 is missing"),
                               HasSubstr("the run counts as missing")));
  EXPECT_THAT(drawn.out, HasSubstr("7 of 8 runs are done; 1 missing: usual, seed 1."));
  const auto outcome = grit({"study", "study.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(run + ": the run is done, but its series.h5 is missing or unreadable; it is "
                                                 "run again"),
                                 HasSubstr("1 of 8 runs to do")));
  EXPECT_THAT(grit({"study", "study.json", "--dry-run"}).out, HasSubstr("0 of 8 runs are missing"));
}

/// The results of the study with costs and errors of our own.
class Advised : public Studies {
 protected:
  void make(json changed) {
    folder.write("study.json", changed.dump());
    const auto outcome = grit({"study", "study.json", "--quiet"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    evaluated = result();
    // Costs of such short runs are noise.
    for (auto& effect : evaluated["effects"])
      effect["cost"] = effect["setting"] == "damping" ? 1.25
                       : effect["level"] == "0.8"     ? 0.01
                                                      : 0.1,
      effect["cost_standard_error"] = 0.0;
    folder.write("results/study/study.json", evaluated.dump());
  }
  std::string advise(const std::vector<std::string>& more) {
    std::vector<std::string> words{"advise",  "two.json",
                                   "--study", "results/study/study.json",
                                   "--set",   R"(/stages/0/until={"type": "time", "value": "20 us"})"};
    words.insert(words.end(), more.begin(), more.end());
    const auto outcome = grit(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  }
  json evaluated;
};

TEST_F(Advised, ByWhatIsFinerAndCheaperWhateverStays) {
  make(json::parse(study));
  const std::vector<std::string> coarse{"--set", "/time_step/safety=0.8", "--set", "/engines/damping/coefficient=0.5"};
  EXPECT_THAT(
      advise(coarse),
      AllOf(
          HasSubstr("    → 0: finer and 1.25 ± 0.00 times cheaper, is the finest level studied\n"),
          HasSubstr("beyond the tolerance already: damping 0.5; 0, which is finer, is within it and 1.25 ± 0.00 times "
                    "cheaper\n"),
          ContainsRegex("beyond the tolerance already: safety 0.8; 0.1?1?, which is finer, is within it and 10+.00 ± "
                        "0.00 times more expensive\n"),
          HasSubstr("no coarser level of the study is known to be cheaper\n"),
          HasSubstr("combined, about 1.2 times cheaper\n"), HasSubstr("too large\n"), Not(HasSubstr("costs more"))));
  // A pointer stands once in the command, with its last value.
  EXPECT_THAT(advise(coarse), HasSubstr(" --set /time_step/safety=0.8 --set /engines/damping/coefficient=0\n"));
}

TEST_F(Advised, WhenNothingCanBeRelaxedReportsWhatWouldAllowIt) {
  auto changed = json::parse(study);
  changed["metrics"]["grains"] = {{"type", "last"}, {"of", "packing/time"}};
  make(changed);
  for (auto& effect : evaluated["effects"]) {
    if (effect["setting"] != "safety") continue;
    const bool fine = effect["level"] == "0.1";
    effect["metrics"]["energy"] = {{"error", fine ? 0.1 : 0.4}, {"standard_error", 0.012}};
    effect["metrics"]["grains"] = {{"error", fine ? 0.005 : 0.3}, {"standard_error", 0.02}};
  }
  folder.write("results/study/study.json", evaluated.dump());
  const auto out = advise({"--set", "/time_step/safety=0.01", "--tolerance", "1%"});
  EXPECT_THAT(
      out, AllOf(HasSubstr("no setting can be relaxed\n  metrics that exclude coarser levels, each level on its own: "
                           "energy (2)\n"),
                 ContainsRegex("--study results/study/study.json --tolerance 12%\n      safety 0.1\n"),
                 ContainsRegex("--metric energy --tolerance 12%\n      safety 0.1\n"),
                 ContainsRegex("--metric grains --tolerance 3%\n      safety 0.1\n")));
  EXPECT_THAT(advise({"--set", "/time_step/safety=0.01", "--tolerance", "3%", "--metric", "grains"}),
              HasSubstr("    → 0.1: 10.00 ± 0.00 times cheaper"))
      << "as it says";
  // What stays takes all of the tolerance.
  evaluated["effects"][0]["cost"] = 0.8;
  folder.write("results/study/study.json", evaluated.dump());
  EXPECT_THAT(
      advise({"--set", "/time_step/safety=0.01", "--set", "/engines/damping/coefficient=0.5", "--tolerance", "15%"}),
      AllOf(HasSubstr("within the tolerance on its own, but not together with the other settings: safety 0.1\n"),
            ContainsRegex("the largest change of these: damping 0.5 changes energy by ")));
}

TEST_F(Advised, ReportsUnevaluatedMetricsAndIdenticalSamples) {
  auto changed = json::parse(study);
  changed["metrics"]["begin"] = {{"type", "minimum"}, {"of", "packing/kinetic_energy"}};
  changed["metrics"]["lab"] = {{"type", "last"}, {"of", "packing/kinetic_energy"}, {"value", 1000}};
  const std::vector<std::string> fine{"--set", "/time_step/safety=0.01"};
  make(changed);
  const auto two = advise(fine);
  EXPECT_THAT(
      two, AllOf(HasSubstr("begin could not be evaluated: its reference is 0"),
                 HasSubstr("lab deviates from its own reference by more than the tolerance in every variant, 100.0 % "
                           "± 0.0 % at best"),
                 HasSubstr("Nothing is random in this scene: the seed has no effect, all samples are identical")));
  EXPECT_THAT(advise({"--set", "/time_step/safety=0.01", "--metric", "energy"}),
              AllOf(Not(HasSubstr("begin")), Not(HasSubstr("lab"))))
      << "they are not selected";
  // One sample gives the same.
  changed["seeds"]["values"] = {1};
  make(changed);
  const auto one = advise(fine);
  EXPECT_THAT(one, HasSubstr("Nothing is random in this scene: one sample is sufficient."));
  const auto from = [](const std::string& out) { return out.substr(out.find("\n\n")); };
  EXPECT_EQ(from(one), from(two));
}

TEST_F(Studies, ThatGiveNoAdviceReportWhyAndWhatToDo) {
  const auto outcome = grit({"advise", std::string(GRIT_SOURCE_DIR) + "/sims/triaxial/quick.json"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("triaxial.json: is a sweep, of other parameters than numerical settings"),
                                 HasSubstr("run a study of your scene that varies numerical settings")));
}

TEST_F(Studies, AreInterruptedAndContinued) {
  auto changed = json::parse(study);
  changed["set"]["/stages/0/until"]["value"] = "1 s";
  changed["set"]["/stages/0/limit"] = "2 s";
  folder.write("long.json", changed.dump());
  Program program(grit_with({"study", "long.json", "--jobs", "2"}), folder.path());
  ASSERT_TRUE(program.wait_for("running"));
  program.interrupt();
  const auto outcome = program.finish();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.err, HasSubstr("run the same command again to continue"));
  EXPECT_THAT(grit({"study", "long.json", "--dry-run"}).out, HasSubstr("8 of 8 runs are missing"));
}

TEST_F(Studies, ContinueRunsThatWereInterrupted) {
  auto changed = json::parse(study);
  changed["set"]["/stages/0/until"]["value"] = "2 ms";
  changed["settings"] = {{"safety", {{"pointers", {"/time_step/safety"}}, {"values", {0.8, 0.0005}}}}};
  changed["seeds"]["values"] = {1};
  folder.write("study.json", changed.dump());
  // The same command as the study's, which interrupts its runs when it is interrupted.
  const std::string finest = "results/study/runs/finest/seed-1";
  Program program(
      grit_with({"run", "two.json", "--out", finest, "--overwrite", "--quiet", "--no-report", "--set", "/seed=1",
                 "--set", "/time_step/safety=0.0005", "--set", R"(/stages/0/until={"type": "time", "value": "2 ms"})"}),
      folder.path());
  Outcome interrupted;
  ASSERT_NO_FATAL_FAILURE(interrupt_after(program, folder / (finest + "/series.h5"), interrupted));
  const auto run = [&] { return json::parse(text_of(folder / (finest + "/run.json"))); };
  ASSERT_EQ(run().at("status"), "interrupted");
  const auto outcome = grit({"study", "study.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("2 of 2 runs to do"));
  EXPECT_EQ(run().at("status"), "done");
  EXPECT_EQ(run().at("resumed"), 1);
}

TEST_F(Studies, ContinueRunsThatWereKilled) {
  auto changed = json::parse(study);
  changed["set"]["/stages/0/until"]["value"] = "2 ms";
  changed["set"]["/output/checkpoint_every"] = "20 ms";
  changed["settings"] = {{"safety", {{"pointers", {"/time_step/safety"}}, {"values", {0.8, 0.0002}}}}};
  changed["seeds"]["values"] = {1};
  folder.write("study.json", changed.dump());
  const std::string finest = "results/study/runs/finest/seed-1";
  const auto run = [&] { return json::parse(text_of(folder / (finest + "/run.json"))); };
  const auto kill_one = [&] {
    Program program(
        grit_with({"run", "two.json", "--out", finest, "--overwrite", "--quiet", "--no-report", "--threads", "1",
                   "--set", "/seed=1", "--set", "/time_step/safety=0.0002", "--set", "/output/checkpoint_every=20 ms",
                   "--set", R"(/stages/0/until={"type": "time", "value": "2 ms"})"}),
        folder.path());
    const auto given_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!std::filesystem::exists(folder / (finest + "/checkpoint.h5")))
      ASSERT_LT(std::chrono::steady_clock::now(), given_up);
    program.interrupt(SIGKILL);
    ASSERT_EQ(program.finish().status, -SIGKILL);
    ASSERT_EQ(run().at("status"), "running");
  };
  kill_one();
  const auto outcome = grit({"study", "study.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("2 of 2 runs to do"));
  EXPECT_EQ(run().at("status"), "done");
  EXPECT_EQ(run().at("resumed"), 1);
  // Without a checkpoint of this build it starts again.
  kill_one();
  folder.write(finest + "/checkpoint.h5", "half of one");
  const auto again = grit({"study", "study.json"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("1 of 2 runs to do"));
  EXPECT_EQ(run().at("status"), "done");
  EXPECT_EQ(run().value("resumed", 0), 0);
}

TEST_F(Studies, RunAgainWhatAnotherBuildOfAPluginMade) {
  ASSERT_EQ(grit({"study", "study.json", "--quiet"}).status, 0);
  const std::string path = "results/study/runs/usual/seed-1/run.json";
  const auto original = nlohmann::ordered_json::parse(text_of(folder / path));
  const auto missing_with = [&](auto change) {
    auto run = original;
    change(run);
    folder.write(path, run.dump());
    return grit({"study", "study.json", "--dry-run"}).out;
  };
  EXPECT_THAT(missing_with([](auto&) {}), HasSubstr("0 of 8 runs are missing"));
  EXPECT_THAT(missing_with([](auto& run) {
                for (auto& plugin : run["plugins"])
                  if (plugin["kind"] == "contact") plugin["build"]["checksum"] = 1;
              }),
              HasSubstr("1 of 8 runs are missing"));
  EXPECT_THAT(missing_with([](auto& run) {
                for (auto& plugin : run["plugins"]) plugin["file"] = "elsewhere";
              }),
              HasSubstr("0 of 8 runs are missing"));
  EXPECT_THAT(missing_with([](auto& run) { run.erase("plugins"); }), HasSubstr("1 of 8 runs are missing"));
}

TEST_F(Studies, TouchNoFileThatTheyDidNotWrite) {
  for (const std::string name : {"study.json", "study.csv", "study.html", "runs/usual/seed-1/log.txt"}) {
    folder.write("results/study/" + name, "mine");
    const auto refused = grit({"study", "study.json"});
    EXPECT_EQ(refused.status, 5) << name;
    EXPECT_THAT(refused.err, HasSubstr("results/study/" + name + ": "));
    EXPECT_EQ(text_of(folder / ("results/study/" + name)), "mine");
    std::filesystem::remove_all(folder / "results/study");
  }
  for (const std::string name : {"study.json", "study.csv"}) {
    std::filesystem::create_directories(folder / "results/study");
    ASSERT_EQ(::mkfifo((folder / ("results/study/" + name)).c_str(), 0600), 0);
    EXPECT_EQ(grit({"study", "study.json"}).status, 5) << "a named pipe, which may have no writer";
    std::filesystem::remove_all(folder / "results/study");
  }
}

TEST_F(Studies, KeepPagesThatTheyDidNotWriteBesideTheirOwnResults) {
  ASSERT_EQ(grit({"study", "study.json", "--quiet"}).status, 0);
  ASSERT_EQ(grit({"study", "study.json", "--quiet"}).status, 0) << "its own page is replaced";
  folder.write("results/study/study.html", "mine");
  for (const char* option : {"--quiet", "--collect"}) {
    const auto refused = grit({"study", "study.json", option});
    EXPECT_EQ(refused.status, 5) << option;
    EXPECT_THAT(refused.err, HasSubstr("results/study/study.html: grit did not write this file"));
    EXPECT_EQ(text_of(folder / "results/study/study.html"), "mine");
  }
}

TEST_F(Studies, KeepRunsThatNoStudyBegan) {
  const std::string usual = "results/study/runs/usual/seed-1";
  const auto expect_kept = [&](const std::string& named, const std::string& run) {
    const auto before = text_of(folder / (run + "/run.json"));
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"study", "study.json"}, {"study", "study.json", "--only", "runs/usual/seed-1"}}) {
      const auto refused = grit(words);
      EXPECT_EQ(refused.status, 5) << words.back() << refused.err;
      EXPECT_THAT(refused.err, AllOf(HasSubstr(named + ": no study "), HasSubstr("--out")));
    }
    EXPECT_EQ(text_of(folder / (run + "/run.json")), before);
    EXPECT_FALSE(std::filesystem::exists(folder / "results/study/runs/finest/seed-1")) << "nothing was begun";
  };
  ASSERT_EQ(grit({"run", "two.json", "--out", usual, "--quiet"}).status, 0);
  expect_kept(usual, usual);
  folder.write(usual + "/log.txt", "mine");
  expect_kept(usual, usual);
  std::filesystem::remove_all(folder / usual);
  ASSERT_EQ(grit({"run", "two.json", "--out", "mine", "--quiet"}).status, 0);
  std::filesystem::create_directory_symlink(folder / "mine", folder / usual);
  expect_kept(usual, "mine");
  std::filesystem::remove_all(folder / "results/study/runs/usual");
  std::filesystem::create_directories(folder / "others");
  std::filesystem::rename(folder / "mine", folder / "others/seed-1");
  std::filesystem::create_directory_symlink(folder / "others", folder / "results/study/runs/usual");
  expect_kept("results/study/runs/usual", "others/seed-1");
}

TEST_F(Studies, AreNotCollectedWithoutAnyRun) {
  const auto outcome = grit({"study", "study.json", "--collect"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("results/study: has no runs of the study"), HasSubstr("omit --collect")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST_F(Studies, AreCollectedFromRunsOfAnOlderGrit) {
  ASSERT_EQ(grit({"study", "study.json", "--quiet"}).status, 0);
  const std::string path = "results/study/runs/usual/seed-1/run.json";
  auto run = nlohmann::ordered_json::parse(text_of(folder / path));
  run["grit"]["revision"] = "older", run["description"]["guards"].erase("travel");
  folder.write(path, run.dump());
  std::filesystem::remove(folder / "results/study/study.json");
  EXPECT_THAT(grit({"study", "study.json", "--dry-run"}).out, HasSubstr("1 of 8 runs are missing"));
  const auto drawn = grit({"study", "study.json", "--collect"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(result().at("revisions").size(), 2u);
  EXPECT_EQ(nlohmann::ordered_json::parse(text_of(folder / path)).at("grit").at("revision"), "older");
  run["description"]["time_step"]["safety"] = 0.7;
  folder.write(path, run.dump());
  const auto other = grit({"study", "study.json", "--collect"});
  EXPECT_EQ(other.status, 0);
  EXPECT_THAT(other.err, AllOf(HasSubstr("usual/seed-1: holds a run of another description"),
                               HasSubstr("/time_step/safety"), HasSubstr("the run counts as missing")));
  EXPECT_THAT(other.out, HasSubstr("7 of 8 runs are done; 1 missing: usual, seed 1."));
}

TEST_F(Studies, GiveAdvice) {
  ASSERT_EQ(grit({"study", "study.json", "--quiet"}).status, 0);
  const std::string result = "results/study/study.json";
  // Costs of such short runs are noise.
  auto evaluated = this->result();
  for (auto& effect : evaluated["effects"])
    effect["cost"] = effect["setting"] == "damping" ? 1.0
                     : effect["level"] == "0.8"     ? 0.01
                                                    : 0.1,
    effect["cost_standard_error"] = 0.0;
  folder.write(result, evaluated.dump());
  const std::vector<std::string> same_run = {"--set", R"(/stages/0/until={"type": "time", "value": "20 us"})"};
  const auto advise = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"advise", "two.json", "--study", result};
    words.insert(words.end(), same_run.begin(), same_run.end());
    words.insert(words.end(), more.begin(), more.end());
    return grit(words);
  };
  const auto fine = advise({"--set", "/time_step/safety=0.01", "--tolerance", "1%"});
  ASSERT_EQ(fine.status, 0) << fine.err;
  EXPECT_THAT(fine.out, AllOf(HasSubstr("safety: 0.01 here"), HasSubstr("→ 0.1: 10.00 ± 0.00 times cheaper"),
                              HasSubstr(" --set /time_step/safety=0.1\n"), HasSubstr("too large"), HasSubstr(result)));
  const auto coarse = advise({"--set", "/time_step/safety=0.8", "--tolerance", "0.01"});
  EXPECT_THAT(coarse.out, AllOf(HasSubstr("no cheaper level was studied"),
                                HasSubstr("no coarser level of the study is known to be cheaper")));
  EXPECT_THAT(advise({"--set", "/time_step/safety=0.3"}).out,
              HasSubstr("a value that was not studied; studied values are 0.8, 0.1, 0.01"));
  EXPECT_THAT(fine.out, HasSubstr("grit run two.json --set '/stages/0/until="))
      << "what was set for the advice belongs to the command";
  EXPECT_THAT(advise({"--set", "/engines/damping/coefficient=0.5"}).out,
              AllOf(HasSubstr("beyond the tolerance already: damping 0.5; "),
                    HasSubstr("beyond the tolerance already: safety 0.8; ")));
  // For present levels as for cheaper ones: "too large" is not "inconclusive".
  const auto with_safety = [&](json of_coarse, json of_fine) {
    auto changed = evaluated;
    for (auto& effect : changed["effects"])
      for (auto& metric : effect["metrics"])
        metric.update(effect["level"] == "0.8" ? of_coarse : effect["level"] == "0.1" ? of_fine : json::object());
    folder.write(result, changed.dump());
    const auto outcome = advise({"--set", "/time_step/safety=0.8", "--tolerance", "2%"});
    folder.write(result, evaluated.dump());
    return outcome.out;
  };
  const json unsure = {{"error", 0.03}, {"standard_error", 0.06}}, large = {{"error", 0.03}, {"standard_error", 0.001}},
             small = {{"error", 0.001}, {"standard_error", 0.001}};
  EXPECT_THAT(with_safety(unsure, small),
              AllOf(ContainsRegex("safety: 0.8 here; changes .* by 3.0 % ± 6.0 %, inconclusive"),
                    HasSubstr("inconclusive already: safety;"), Not(HasSubstr("beyond the tolerance"))));
  EXPECT_THAT(with_safety(large, small),
              AllOf(ContainsRegex("safety: 0.8 here; changes .* by 3.0 % ± 0.1 %, too large\n"),
                    HasSubstr("beyond the tolerance already: safety 0.8; 0.1, which is finer, is within it and 10.00 ± "
                              "0.00 times more expensive\n"),
                    Not(HasSubstr("inconclusive"))));
  EXPECT_THAT(with_safety(unsure, large),
              AllOf(ContainsRegex("0.8 here; changes .* by 3.0 % ± 6.0 %, too large: 0.1, which is finer, changes"),
                    HasSubstr("beyond the tolerance already: safety 0.8; 0.01, which is finer"),
                    Not(HasSubstr("inconclusive already"))));
  EXPECT_EQ(advise({"--tolerance", "much"}).status, 1);
  EXPECT_EQ(advise({"--tolerance", "5"}).status, 1) << "500 %";
  EXPECT_EQ(advise({"--tolerance", "-2%"}).status, 1);
  folder.write("it's two.json", text_of(folder / "two.json"));
  EXPECT_THAT(grit({"advise", "it's two.json", "--study", result, "--set", "/time_step/safety=0.01", "--tolerance",
                    "1%", "--set", "/title=it's"})
                  .out,
              HasSubstr("grit run \"it's two.json\" --set \"/title=it's\" --set /time_step/safety=0.1\n"));
  EXPECT_THAT(fine.out, HasSubstr("of a scene with the same components"));
  const auto other = advise({"--set", R"(/engines/gravity={"type": "gravity"})"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(
      other.err,
      AllOf(HasSubstr(result + ": is a study of a scene without a scenario, but two.json is a scene"),
            HasSubstr("(the study has no \"engine gravity: gravity\")"), HasSubstr("run a study of your own scene")));
  const auto sheared =
      grit({"advise", std::string(GRIT_SOURCE_DIR) + "/sims/direct-shear/quick.json", "--study", result});
  EXPECT_EQ(sheared.status, 2);
  EXPECT_THAT(sheared.err,
              HasSubstr("quick.json is a scene of the scenario \"direct-shear\", so that it does not apply"));
  EXPECT_EQ(sheared.out, "");
  evaluated["purpose"] = "sweep";
  folder.write("sand.json", evaluated.dump());
  const auto sand = grit({"advise", "two.json", "--study", "sand.json"});
  EXPECT_EQ(sand.status, 1);
  EXPECT_THAT(sand.err, HasSubstr("is a sweep, of other parameters than numerical settings"));
  evaluated.erase("title");
  folder.write("half.json", evaluated.dump());
  for (const char* no_study : {"two.json", "half.json", "none.json", "results"}) {
    const auto outcome = grit({"advise", "two.json", "--study", no_study});
    EXPECT_EQ(outcome.status, 5) << no_study;
    EXPECT_THAT(outcome.err, HasSubstr("'grit study'"));
  }
  const auto none = grit({"advise", "two.json"});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.err, AllOf(HasSubstr("no scenario"), HasSubstr("--study")));
}

TEST_F(Studies, AdviseOnScenesOfTheSameComponentsWithoutAScenario) {
  for (const auto& [scene, title] :
       {std::pair("column", "A column under gravity"), std::pair("oedometer", "Oedometric compr")}) {
    const std::string file = std::string(GRIT_SOURCE_DIR) + "/sims/" + scene + "/quick.json";
    const auto own = grit({"advise", file});
    EXPECT_EQ(own.status, 0) << own.err;
    EXPECT_THAT(own.out, HasSubstr(std::string(", by the study \"") + title));
    folder.write("mine.json",
                 json{{"extends", file}, {"materials", {{"sand", {{"friction_angle", "30 deg"}}}}}}.dump());
    EXPECT_THAT(grit({"advise", "mine.json"}).out, HasSubstr(title));
  }
  const json lid = {{"type", "plane"}, {"point", {0, 0, 0.1}}, {"normal", {0, 0, -1}}, {"material", "sand"}};
  folder.write("other.json", json{{"extends", std::string(GRIT_SOURCE_DIR) + "/sims/column/quick.json"},
                                  {"walls", {{"left", nullptr}, {"lid", lid}}},
                                  {"probes", nullptr},
                                  {"output", nullptr}}
                                 .dump());
  const auto other = grit({"advise", "other.json"});
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.err, AllOf(HasSubstr("no scenario"), HasSubstr("(the closest study is \"A column under gravity"),
                               HasSubstr(": the description has no \"wall left: plane\", the study has no \"wall lid: "
                                         "plane\")")));
}

/// A grit with its own installed studies.
class ShippedStudies : public Studies {
 protected:
  ShippedStudies() {
    std::filesystem::create_directories(folder / "own");
    std::filesystem::copy(lib / "libgrit.so", folder / "own");
    std::filesystem::copy(lib / "studies", folder / "own/studies");
  }
  Outcome column(const std::string& command, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"env",
                                   "LD_LIBRARY_PATH=" + (folder / "own").string(),
                                   "GRIT_PLUGIN_PATH=" + lib.string(),
                                   GRIT_BINARY,
                                   command,
                                   std::string(GRIT_SOURCE_DIR) + "/sims/column/quick.json"};
    words.insert(words.end(), more.begin(), more.end());
    return Program(words, folder.path()).finish();
  }
  const std::filesystem::path lib = std::filesystem::path(GRIT_BINARY).parent_path().parent_path() / "lib/grit";
};

TEST_F(ShippedStudies, ThatCannotBeReadAreOmittedByName) {
  const auto whole = column("advise");
  EXPECT_EQ(whole.status, 0) << whole.err;
  EXPECT_EQ(whole.err, "");
  folder.write("own/studies/broken.json", R"({"title": "half a)");
  for (const char* command : {"check", "advise"}) {
    const auto outcome = column(command);
    EXPECT_EQ(outcome.status, 0) << command << ": " << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("omitted: " + (folder / "own/studies/broken.json").string()),
                                   HasSubstr("is not a study.json"), Not(HasSubstr("column.json"))));
    if (command == std::string("advise")) EXPECT_EQ(outcome.out, whole.out);
  }
}

TEST_F(ShippedStudies, ReportAnExcessDepth) {
  const std::string file = "own/studies/column.json";
  // Sets the error of the least depth, relative to the usual one, for all metrics.
  const auto changes_by = [&](double error, double standard_error) {
    auto result = json::parse(text_of(folder / file));
    for (auto& effect : result.at("effects"))
      if (effect.at("setting") == "depth")
        for (auto& metric : effect.at("metrics")) metric["error"] = error, metric["standard_error"] = standard_error;
    folder.write(file, result.dump());
  };
  const auto check = [&](const std::string& depth, int count) {
    const auto outcome =
        column("check", {"--set", "/domain/high/1=" + depth, "--set", "/bodies/sand/source/high/1=" + depth, "--set",
                         "/bodies/sand/source/count=" + std::to_string(count)});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  constexpr auto reported = "within the scatter";
  changes_by(0.01, 0.01);
  EXPECT_THAT(check("20 mm", 3000),
              HasSubstr("  /domain/high/1: 20 mm deep; by \"A column under gravity: what the settings cost and what "
                        "they change\" 6 mm changes "));
  EXPECT_THAT(check("20 mm", 3000), HasSubstr(" by 1.0 ± 1.0 %, which is within the scatter between samples, and is "));
  EXPECT_THAT(check("10 mm", 1500), Not(HasSubstr(reported))) << "less than twice as much";
  changes_by(0.02, 0.005);
  EXPECT_THAT(check("20 mm", 3000), Not(HasSubstr(reported))) << "the change is resolved";
  changes_by(0.02, 0.1);
  EXPECT_THAT(check("20 mm", 3000), Not(HasSubstr(reported))) << "inconclusive";
}

}  // namespace
}  // namespace grit
