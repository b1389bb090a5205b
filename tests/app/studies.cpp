// Speed against accuracy: `chart` runs a study, `advise` applies it.
#include <gmock/gmock.h>

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
  "figures": {"energy": {"type": "last", "of": "packing/kinetic_energy"}},
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
  json chart() const { return json::parse(text_of(folder / "results/study/chart.json")); }
  OwnFolder folder;
};

TEST_F(Studies, AreRunChartedAndNotRunAgain) {
  const auto first = grit({"chart", "study.json", "--jobs", "2"});
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("8 of 8 runs to do"));
  EXPECT_THAT(first.out, AllOf(HasSubstr("  usual: "), HasSubstr("  safety=0.1: "), HasSubstr("within 1.0 %"),
                               HasSubstr("Nothing is random in this scene: the seed changes nothing"),
                               HasSubstr("chart: results/study/chart.html")));
  const auto all = chart();
  ASSERT_EQ(all.at("variants").size(), 4u);
  const auto error = [&](int variant) {
    return all.at("variants")[variant].at("figures").at("energy").at("error").get<double>();
  };
  EXPECT_EQ(all.at("parts"),
            json({"bodies grains: sphere", "contacts linear-rolling", "engine damping: local-damping", "stage part"}));
  EXPECT_EQ(all.at("variants")[3].at("name"), "finest");
  EXPECT_EQ(error(3), 0);
  EXPECT_GT(error(0), error(2)) << "a longer step is further off";
  EXPECT_GT(error(1), 0.1) << "damping takes energy away";
  EXPECT_GT(all.at("variants")[3].at("steps"), all.at("variants")[0].at("steps"));
  EXPECT_THAT(text_of(folder / "results/study/chart.html"), HasSubstr("two grains part"));
  EXPECT_THAT(text_of(folder / "results/study/chart.csv"), HasSubstr("\"safety=0.1\""));

  const auto second = grit({"chart", "study.json"});
  EXPECT_EQ(second.status, 0);
  EXPECT_THAT(second.err, HasSubstr("0 of 8 runs to do"));
  EXPECT_EQ(second.out, first.out);
  // What is missing, and what another description made, is run again.
  folder.write("results/study/runs/usual/seed-1/run.json", R"({"status": "done"})");
  folder.write("study.json", std::string(study).replace(std::string(study).find("0.1,"), 4, "0.2,"));
  EXPECT_THAT(
      grit({"chart", "study.json", "--dry"}).out,
      AllOf(HasSubstr("usual, seed 1\n"), HasSubstr("safety=0.2, seed 2\n"), HasSubstr("3 of 8 runs are missing")));
}

TEST_F(Studies, TellWhereAVariantFails) {
  const auto outcome = grit({"chart", "study.json"});
  ASSERT_EQ(outcome.status, 0);
  auto changed = json::parse(study);
  changed["settings"]["travel"] = {{"pointers", {"/guards/travel"}}, {"values", {1e-9, 0.05}}, {"usual", "0.05"}};
  folder.write("study.json", changed.dump());
  const auto failing = grit({"chart", "study.json"});
  EXPECT_EQ(failing.status, 0) << failing.err;
  EXPECT_THAT(failing.out, HasSubstr("more than /guards/travel 1e-09"));
  EXPECT_THAT(text_of(folder / "results/study/chart.html"), HasSubstr("more than /guards/travel 1e-09"));
}

TEST_F(Studies, EndWithStatus4IfTheReferenceFails) {
  auto changed = json::parse(study);
  changed["settings"]["travel"] = {{"pointers", {"/guards/travel"}}, {"values", {0.05, 1e-9}}};
  folder.write("study.json", changed.dump());
  const auto outcome = grit({"chart", "study.json"});
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.out, HasSubstr("nothing to compare with"));
}

TEST_F(Studies, SayWhichFigureCannotBeCharted) {
  auto changed = json::parse(study);
  folder.write("lab.csv", "x,y\n500,1\n1000,2\n");
  changed["figures"]["begin"] = {{"type", "minimum"}, {"of", "packing/kinetic_energy"}};
  changed["figures"]["lab"] = {
      {"type", "curve"}, {"of", "packing/kinetic_energy"}, {"curve", {{"file", "lab.csv"}, {"x", "x"}, {"y", "y"}}}};
  folder.write("study.json", changed.dump());
  const auto some = grit({"chart", "study.json"});
  EXPECT_EQ(some.status, 0);
  EXPECT_THAT(some.err, AllOf(HasSubstr("grit: not charted: begin: its reference is 0"),
                              HasSubstr("grit: not charted: lab: no run has an abscissa in common")));
  EXPECT_THAT(some.out, HasSubstr("safety=0.1: "));
  const json figures = chart().at("figures");
  EXPECT_THAT(figures.at("lab").at("not_charted").get<std::string>(), HasSubstr("mind the units"));
  EXPECT_GT(figures.at("energy").at("scale"), 0);
  changed["figures"].erase("energy");
  folder.write("study.json", changed.dump());
  const auto none = grit({"chart", "study.json"});
  EXPECT_EQ(none.status, 4);
  EXPECT_THAT(none.out, HasSubstr("No figure could be charted."));
  const auto advice = grit({"advise", "two.json", "--study", "results/study/chart.json"});
  EXPECT_EQ(advice.status, 5);
  EXPECT_THAT(advice.err, HasSubstr("has no errors of any figure"));
}

TEST_F(Studies, AreOneAtATimeInAFolder) {
  auto changed = json::parse(study);
  changed["set"]["/stages/0/until"]["value"] = "1 s";
  changed["set"]["/stages/0/limit"] = "2 s";
  folder.write("long.json", changed.dump());
  Program first(grit_with({"chart", "long.json", "--jobs", "1"}), folder.path());
  ASSERT_TRUE(first.wait_for("at work"));
  const auto names = [&] {
    std::vector<std::string> all;
    for (const auto& one : std::filesystem::recursive_directory_iterator(folder / "results"))
      if (one.path().string().find("usual/seed-1") == std::string::npos) all.push_back(one.path());
    return all;
  };
  const auto before = names();
  for (const char* way : {"--quiet", "--draw"}) {
    const auto second = grit({"chart", "long.json", way});
    EXPECT_EQ(second.status, 5);
    EXPECT_THAT(second.err, HasSubstr("results/long: another 'grit chart'"));
  }
  EXPECT_EQ(names(), before);
  EXPECT_EQ(grit({"chart", "long.json", "--dry"}).status, 0);
  first.interrupt();
  EXPECT_EQ(first.finish().status, 130);
}

TEST_F(Studies, BeginNothingThatCannotBeRun) {
  auto changed = json::parse(study);
  changed["settings"]["safety"]["pointers"] = {"/time_step/safty"};
  folder.write("typo.json", changed.dump());
  const auto typo = grit({"chart", "typo.json"});
  EXPECT_EQ(typo.status, 2);
  EXPECT_THAT(typo.err, AllOf(HasSubstr("typo.json, usual: /time_step/safty"), HasSubstr("did you mean \"safety\"")));
  folder.write("key.json", R"({"scene": "two.json", "setting": {}})");
  const auto key = grit({"chart", "key.json"});
  EXPECT_EQ(key.status, 2);
  EXPECT_THAT(key.err, AllOf(HasSubstr("key.json:1: /setting"), HasSubstr("settings")));
  changed = json::parse(study);
  changed["figures"]["energy"]["of"] = "walls/force";
  folder.write("probe.json", changed.dump());
  const auto probe = grit({"chart", "probe.json"});
  EXPECT_EQ(probe.status, 2);
  EXPECT_THAT(probe.err,
              HasSubstr("probe.json:1: /figures/energy/of: found the probe \"walls\", which the scene lacks; "
                        "allowed is one of packing"));
  changed["figures"]["energy"] = {
      {"type", "curve"}, {"of", "packing/kinetic_energy"}, {"curve", {{"file", "none.csv"}, {"x", "x"}, {"y", "y"}}}};
  folder.write("file.json", changed.dump());
  const auto file = grit({"chart", "file.json"});
  EXPECT_EQ(file.status, 5);
  EXPECT_THAT(file.err, HasSubstr("none.csv: cannot be read"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
  EXPECT_EQ(grit({"chart"}).status, 1);
  for (const char* jobs : {"0", "-1", "2x"}) {
    const auto number = grit({"chart", "study.json", "--jobs", jobs});
    EXPECT_EQ(number.status, 1);
    EXPECT_THAT(number.err, HasSubstr("--jobs takes a number from 1 to 1024, not \"" + std::string(jobs) + '"'));
  }
  changed = json::parse(study);
  changed["settings"]["damping"]["pointers"] = {"/time_step/safety"};
  folder.write("twice.json", changed.dump());
  const auto twice = grit({"chart", "twice.json"});
  EXPECT_EQ(twice.status, 2);
  EXPECT_THAT(twice.err, HasSubstr("/settings/safety/pointers/0: found /time_step/safety, of which "
                                   "/settings/damping/pointers/0 changes /time_step/safety"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
  changed = json::parse(study);
  changed["settings"]["duration"] = {{"pointers", {"/stages/0/until/value"}}, {"values", {"20 us", "0.02 ms"}}};
  folder.write("same.json", changed.dump());
  const auto same = grit({"chart", "same.json", "--dry"});
  EXPECT_EQ(same.status, 2);
  EXPECT_THAT(same.err, HasSubstr("same.json:1: /settings: found usual and duration=0.02 ms, which run the same; "
                                  "allowed are levels that differ in more than how they are written"));
  const auto both = grit({"chart", "study.json", "--dry", "--draw"});
  EXPECT_EQ(both.status, 1);
  EXPECT_THAT(both.err, HasSubstr("--draw does none: give one of them"));
}

TEST_F(Studies, SayBeforeAnyRunWhichChannelThereIs) {
  auto changed = json::parse(study);
  changed["figures"]["energy"]["of"] = "packing/kinetic_enrgy";
  changed["figures"]["late"] = {{"type", "last"}, {"of", "packing/kinetic_energy"}, {"against", "packing/tme"}};
  folder.write("study.json", changed.dump(2));
  const auto outcome = grit({"chart", "study.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(
      outcome.err,
      AllOf(ContainsRegex("study.json:[0-9]+: /figures/energy/of: found \"packing/kinetic_enrgy\", a channel "
                          "that the probe lacks; did you mean \"packing/kinetic_energy\"\\? Allowed is one of"),
            HasSubstr("/figures/late/against: found \"packing/tme\""), HasSubstr("did you mean \"packing/time\"?")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
  changed["figures"].erase("late");
  changed["figures"]["energy"]["of"] = "packing/stress";
  folder.write("study.json", changed.dump());
  const auto wide = grit({"chart", "study.json"});
  EXPECT_EQ(wide.status, 2);
  EXPECT_THAT(wide.err, HasSubstr("/figures/energy/of: found \"packing/stress\", which has several numbers a sample"));
}

TEST_F(Studies, TellAProbeThatFitsNoSceneWhereItIsWritten) {
  auto scene = json::parse(text_of(folder / "two.json"));
  scene["probes"]["force"] = {{"type", "walls"}, {"every_steps", 10}, {"walls", {"plat"}}};
  folder.write("two.json", scene.dump(2));
  const std::string text = text_of(folder / "two.json");
  const auto line = 1 + std::count(text.begin(), text.begin() + text.find("\"walls\": ["), '\n');
  const auto outcome = grit({"chart", "study.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("two.json:" + std::to_string(line) + ": /probes/force/walls: there is no wall \"plat\""));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST_F(Studies, RunAgainWhatHasLostItsSeries) {
  ASSERT_EQ(grit({"chart", "study.json", "--quiet"}).status, 0);
  const std::string run = "results/study/runs/usual/seed-1";
  std::filesystem::remove(folder / (run + "/series.h5"));
  const auto drawn = grit({"chart", "study.json", "--draw"});
  EXPECT_EQ(drawn.status, 5);
  EXPECT_THAT(drawn.err, AllOf(HasSubstr(run + ": is a run that is done, whose series.h5 is gone"),
                               HasSubstr("the same command without --draw")));
  const auto outcome = grit({"chart", "study.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(run + ": is a run that is done, whose series.h5 is gone or cannot be read: "
                                                 "it is run again"),
                                 HasSubstr("1 of 8 runs to do")));
  EXPECT_THAT(grit({"chart", "study.json", "--dry"}).out, HasSubstr("0 of 8 runs are missing"));
}

/// The study's chart with costs and, by level of the safety, errors of our own.
class Advised : public Studies {
 protected:
  void make(json changed) {
    folder.write("study.json", changed.dump());
    const auto outcome = grit({"chart", "study.json", "--quiet"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    charted = chart();
    // Such short runs cost nothing but noise.
    for (auto& effect : charted["effects"])
      effect["cost"] = effect["setting"] == "damping" ? 1.25
                       : effect["level"] == "0.8"     ? 0.01
                                                      : 0.1,
      effect["cost_standard_error"] = 0.0;
    folder.write("results/study/chart.json", charted.dump());
  }
  std::string advise(const std::vector<std::string>& more) {
    std::vector<std::string> words{"advise",  "two.json",
                                   "--study", "results/study/chart.json",
                                   "--set",   R"(/stages/0/until={"type": "time", "value": "20 us"})"};
    words.insert(words.end(), more.begin(), more.end());
    const auto outcome = grit(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  }
  json charted;
};

TEST_F(Advised, ByWhatIsFinerAndCheaperWhateverStays) {
  make(json::parse(study));
  const std::vector<std::string> coarse{"--set", "/time_step/safety=0.8", "--set", "/engines/damping/coefficient=0.5"};
  EXPECT_THAT(
      advise(coarse),
      AllOf(
          HasSubstr("    → 0: finer and 1.25 ± 0.00 times cheaper, is the finest that was tried\n"),
          HasSubstr("beyond the tolerance as it is: damping 0.5; 0, which is finer, is within it and 1.25 ± 0.00 times "
                    "cheaper\n"),
          ContainsRegex("beyond the tolerance as it is: safety 0.8; 0.1?1?, which is finer, is within it and 10+.00 ± "
                        "0.00 times dearer\n"),
          HasSubstr("nothing coarser that the study tried is known to be cheaper\n"),
          HasSubstr("together about 1.2 times cheaper\n"), HasSubstr("too much\n"), Not(HasSubstr("costs more"))));
  // A pointer stands once in the command, with its last value.
  EXPECT_THAT(advise(coarse), HasSubstr(" --set /time_step/safety=0.8 --set /engines/damping/coefficient=0\n"));
}

TEST_F(Advised, OfWhatItTakesWhereNothingMayBeRelaxed) {
  auto changed = json::parse(study);
  changed["figures"]["grains"] = {{"type", "last"}, {"of", "packing/time"}};
  make(changed);
  for (auto& effect : charted["effects"]) {
    if (effect["setting"] != "safety") continue;
    const bool fine = effect["level"] == "0.1";
    effect["figures"]["energy"] = {{"error", fine ? 0.1 : 0.4}, {"standard_error", 0.012}};
    effect["figures"]["grains"] = {{"error", fine ? 0.005 : 0.3}, {"standard_error", 0.02}};
  }
  folder.write("results/study/chart.json", charted.dump());
  const auto out = advise({"--set", "/time_step/safety=0.01", "--tolerance", "1%"});
  EXPECT_THAT(out,
              AllOf(HasSubstr("nothing that the study tried may be relaxed\n  what decides against coarser levels, "
                              "each by itself: energy (2)\n"),
                    ContainsRegex("--study results/study/chart.json --tolerance 12%\n      safety 0.1\n"),
                    ContainsRegex("--figure energy --tolerance 12%\n      safety 0.1\n"),
                    ContainsRegex("--figure grains --tolerance 3%\n      safety 0.1\n")));
  EXPECT_THAT(advise({"--set", "/time_step/safety=0.01", "--tolerance", "3%", "--figure", "grains"}),
              HasSubstr("    → 0.1: 10.00 ± 0.00 times cheaper"))
      << "as it says";
  // What stays takes all of the tolerance.
  charted["effects"][0]["cost"] = 0.8;
  folder.write("results/study/chart.json", charted.dump());
  EXPECT_THAT(
      advise({"--set", "/time_step/safety=0.01", "--set", "/engines/damping/coefficient=0.5", "--tolerance", "15%"}),
      AllOf(HasSubstr("within the tolerance by itself, but not with what the other settings change: safety 0.1\n"),
            ContainsRegex("the largest of these is that of damping 0.5, which changes energy by ")));
}

TEST_F(Advised, TellsWhatOfFiguresAndSamplesIsNotTold) {
  auto changed = json::parse(study);
  changed["figures"]["begin"] = {{"type", "minimum"}, {"of", "packing/kinetic_energy"}};
  changed["figures"]["lab"] = {{"type", "last"}, {"of", "packing/kinetic_energy"}, {"value", 1000}};
  const std::vector<std::string> fine{"--set", "/time_step/safety=0.01"};
  make(changed);
  const auto two = advise(fine);
  EXPECT_THAT(two,
              AllOf(HasSubstr("nothing is known of begin, which counts but could not be charted: its reference is 0"),
                    HasSubstr("lab is at every level further than the tolerance from the reference of its own, 100.0 % "
                              "± 0.0 % at best"),
                    HasSubstr("Nothing is random in this scene: the seed changes nothing, samples are alike")));
  EXPECT_THAT(advise({"--set", "/time_step/safety=0.01", "--figure", "energy"}),
              AllOf(Not(HasSubstr("begin")), Not(HasSubstr("lab"))))
      << "they do not count";
  // One sample says as much.
  changed["seeds"]["values"] = {1};
  make(changed);
  const auto one = advise(fine);
  EXPECT_THAT(one, HasSubstr("Nothing is random in this scene: one sample is all that figures need."));
  const auto from = [](const std::string& out) { return out.substr(out.find("\n\n")); };
  EXPECT_EQ(from(one), from(two));
}

TEST_F(Studies, ThatAdviseNothingSayWhyAndWhatToDo) {
  const auto outcome = grit({"advise", std::string(GRIT_SOURCE_DIR) + "/sims/triaxial/quick.json"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("triaxial.json: its settings are what is modelled, not how it is computed"),
                                 HasSubstr("run a study of your scene that varies how it is computed")));
}

TEST_F(Studies, AreInterruptedAndGoOn) {
  auto changed = json::parse(study);
  changed["set"]["/stages/0/until"]["value"] = "1 s";
  changed["set"]["/stages/0/limit"] = "2 s";
  folder.write("long.json", changed.dump());
  Program program(grit_with({"chart", "long.json", "--jobs", "2"}), folder.path());
  ASSERT_TRUE(program.wait_for("at work"));
  program.interrupt();
  const auto outcome = program.finish();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.err, HasSubstr("the same command goes on"));
  EXPECT_THAT(grit({"chart", "long.json", "--dry"}).out, HasSubstr("8 of 8 runs are missing"));
}

TEST_F(Studies, GoOnWithRunsThatWereInterrupted) {
  auto changed = json::parse(study);
  changed["set"]["/stages/0/until"]["value"] = "2 ms";
  changed["settings"] = {{"safety", {{"pointers", {"/time_step/safety"}}, {"values", {0.8, 0.0005}}}}};
  changed["seeds"]["values"] = {1};
  folder.write("study.json", changed.dump());
  // As the study runs it, which asks its runs to stop when it is asked itself.
  const std::string finest = "results/study/runs/finest/seed-1";
  Program program(
      grit_with({"run", "two.json", "--out", finest, "--no-report", "--set", "/seed=1", "--set",
                 "/time_step/safety=0.0005", "--set", R"(/stages/0/until={"type": "time", "value": "2 ms"})"}),
      folder.path());
  ASSERT_TRUE(program.wait_for("part"));
  program.interrupt();
  ASSERT_EQ(program.finish().status, 130);
  const auto run = [&] { return json::parse(text_of(folder / (finest + "/run.json"))); };
  ASSERT_EQ(run().at("status"), "interrupted");
  const auto outcome = grit({"chart", "study.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("2 of 2 runs to do"));
  EXPECT_EQ(run().at("status"), "done");
  EXPECT_EQ(run().at("resumed"), 1);
}

TEST_F(Studies, GoOnWithRunsThatWereKilled) {
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
        grit_with({"run", "two.json", "--out", finest, "--overwrite", "--no-report", "--threads", "1", "--set",
                   "/seed=1", "--set", "/time_step/safety=0.0002", "--set", "/output/checkpoint_every=20 ms", "--set",
                   R"(/stages/0/until={"type": "time", "value": "2 ms"})"}),
        folder.path());
    ASSERT_TRUE(program.wait_for("part"));
    const auto given_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!std::filesystem::exists(folder / (finest + "/checkpoint.h5")))
      ASSERT_LT(std::chrono::steady_clock::now(), given_up);
    program.interrupt(SIGKILL);
    ASSERT_EQ(program.finish().status, -SIGKILL);
    ASSERT_EQ(run().at("status"), "running");
  };
  kill_one();
  const auto outcome = grit({"chart", "study.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("2 of 2 runs to do"));
  EXPECT_EQ(run().at("status"), "done");
  EXPECT_EQ(run().at("resumed"), 1);
  // From what is no checkpoint of this build it begins anew.
  kill_one();
  folder.write(finest + "/checkpoint.h5", "half of one");
  const auto anew = grit({"chart", "study.json"});
  EXPECT_EQ(anew.status, 0) << anew.err;
  EXPECT_THAT(anew.err, HasSubstr("1 of 2 runs to do"));
  EXPECT_EQ(run().at("status"), "done");
  EXPECT_EQ(run().value("resumed", 0), 0);
}

TEST_F(Studies, RunAgainWhatAnotherBuildOfAPluginMade) {
  ASSERT_EQ(grit({"chart", "study.json", "--quiet"}).status, 0);
  const std::string path = "results/study/runs/usual/seed-1/run.json";
  const auto original = nlohmann::ordered_json::parse(text_of(folder / path));
  const auto missing_with = [&](auto change) {
    auto run = original;
    change(run);
    folder.write(path, run.dump());
    return grit({"chart", "study.json", "--dry"}).out;
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

TEST_F(Studies, AreNotDrawnBeforeAnyOfThemWasRun) {
  const auto outcome = grit({"chart", "study.json", "--draw"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("results/study: has no runs of the study"), HasSubstr("leave out --draw")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST_F(Studies, AreDrawnAgainOfRunsByAnOlderGrit) {
  ASSERT_EQ(grit({"chart", "study.json", "--quiet"}).status, 0);
  const std::string path = "results/study/runs/usual/seed-1/run.json";
  auto run = nlohmann::ordered_json::parse(text_of(folder / path));
  run["grit"]["revision"] = "older", run["description"]["guards"].erase("travel");
  folder.write(path, run.dump());
  std::filesystem::remove(folder / "results/study/chart.json");
  EXPECT_THAT(grit({"chart", "study.json", "--dry"}).out, HasSubstr("1 of 8 runs are missing"));
  const auto drawn = grit({"chart", "study.json", "--draw"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(chart().at("revisions").size(), 2u);
  EXPECT_EQ(nlohmann::ordered_json::parse(text_of(folder / path)).at("grit").at("revision"), "older");
  run["description"]["time_step"]["safety"] = 0.7;
  folder.write(path, run.dump());
  const auto other = grit({"chart", "study.json", "--draw"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, AllOf(HasSubstr("usual/seed-1: holds a run of another description"),
                               HasSubstr("/time_step/safety"), HasSubstr("without --draw")));
}

TEST_F(Studies, GiveAdvice) {
  ASSERT_EQ(grit({"chart", "study.json", "--quiet"}).status, 0);
  const std::string chart = "results/study/chart.json";
  // Such short runs cost nothing but noise.
  auto charted = this->chart();
  for (auto& effect : charted["effects"])
    effect["cost"] = effect["setting"] == "damping" ? 1.0
                     : effect["level"] == "0.8"     ? 0.01
                                                    : 0.1,
    effect["cost_standard_error"] = 0.0;
  folder.write(chart, charted.dump());
  const std::vector<std::string> same_run = {"--set", R"(/stages/0/until={"type": "time", "value": "20 us"})"};
  const auto advise = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"advise", "two.json", "--study", chart};
    words.insert(words.end(), same_run.begin(), same_run.end());
    words.insert(words.end(), more.begin(), more.end());
    return grit(words);
  };
  const auto fine = advise({"--set", "/time_step/safety=0.01", "--tolerance", "1%"});
  ASSERT_EQ(fine.status, 0) << fine.err;
  EXPECT_THAT(fine.out, AllOf(HasSubstr("safety: 0.01 here"), HasSubstr("→ 0.1: 10.00 ± 0.00 times cheaper"),
                              HasSubstr(" --set /time_step/safety=0.1\n"), HasSubstr("too much"), HasSubstr(chart)));
  const auto coarse = advise({"--set", "/time_step/safety=0.8", "--tolerance", "0.01"});
  EXPECT_THAT(coarse.out, AllOf(HasSubstr("nothing cheaper was tried"),
                                HasSubstr("nothing coarser that the study tried is known to be cheaper")));
  EXPECT_THAT(advise({"--set", "/time_step/safety=0.3"}).out,
              HasSubstr("a value that the study did not try; it tried 0.8, 0.1, 0.01"));
  EXPECT_THAT(fine.out, HasSubstr("grit run two.json --set '/stages/0/until="))
      << "what was set for the advice belongs to the command";
  EXPECT_THAT(advise({"--set", "/engines/damping/coefficient=0.5"}).out,
              AllOf(HasSubstr("beyond the tolerance as it is: damping 0.5; "),
                    HasSubstr("beyond the tolerance as it is: safety 0.8; ")));
  // Of what is there as of what is cheaper: too much is not what cannot be told.
  const auto with_safety = [&](json of_coarse, json of_fine) {
    auto changed = charted;
    for (auto& effect : changed["effects"])
      for (auto& figure : effect["figures"])
        figure.update(effect["level"] == "0.8" ? of_coarse : effect["level"] == "0.1" ? of_fine : json::object());
    folder.write(chart, changed.dump());
    const auto outcome = advise({"--set", "/time_step/safety=0.8", "--tolerance", "2%"});
    folder.write(chart, charted.dump());
    return outcome.out;
  };
  const json untold = {{"error", 0.03}, {"standard_error", 0.06}}, much = {{"error", 0.03}, {"standard_error", 0.001}},
             little = {{"error", 0.001}, {"standard_error", 0.001}};
  EXPECT_THAT(with_safety(untold, little),
              AllOf(ContainsRegex("safety: 0.8 here; changes .* by 3.0 % ± 6.0 %, cannot be told"),
                    HasSubstr("cannot be told of as it is: safety;"), Not(HasSubstr("beyond the tolerance"))));
  EXPECT_THAT(
      with_safety(much, little),
      AllOf(ContainsRegex("safety: 0.8 here; changes .* by 3.0 % ± 0.1 %, too much\n"),
            HasSubstr("beyond the tolerance as it is: safety 0.8; 0.1, which is finer, is within it and 10.00 ± "
                      "0.00 times dearer\n"),
            Not(HasSubstr("cannot be told"))));
  EXPECT_THAT(with_safety(untold, much),
              AllOf(ContainsRegex("0.8 here; changes .* by 3.0 % ± 6.0 %, too much: 0.1, which is finer, changes"),
                    HasSubstr("beyond the tolerance as it is: safety 0.8; 0.01, which is finer"),
                    Not(HasSubstr("cannot be told of as it is"))));
  EXPECT_EQ(advise({"--tolerance", "much"}).status, 1);
  EXPECT_EQ(advise({"--tolerance", "5"}).status, 1) << "500 %";
  EXPECT_EQ(advise({"--tolerance", "-2%"}).status, 1);
  folder.write("it's two.json", text_of(folder / "two.json"));
  EXPECT_THAT(grit({"advise", "it's two.json", "--study", chart, "--set", "/time_step/safety=0.01", "--tolerance", "1%",
                    "--set", "/title=it's"})
                  .out,
              HasSubstr("grit run \"it's two.json\" --set \"/title=it's\" --set /time_step/safety=0.1\n"));
  EXPECT_THAT(fine.out, HasSubstr("whose scene has the same parts"));
  const auto other = advise({"--set", R"(/engines/gravity={"type": "gravity"})"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, AllOf(HasSubstr(chart + ": is of a scene without a scenario, and two.json is a scene without"),
                               HasSubstr("(there is no \"engine gravity: gravity\")"),
                               HasSubstr("run a study of your own scene")));
  const auto sheared =
      grit({"advise", std::string(GRIT_SOURCE_DIR) + "/sims/direct-shear/quick.json", "--study", chart});
  EXPECT_EQ(sheared.status, 2);
  EXPECT_THAT(sheared.err, HasSubstr("quick.json is the scenario \"direct-shear\", so that nothing may be relaxed"));
  EXPECT_EQ(sheared.out, "");
  charted["advice"] = false;
  folder.write("sand.json", charted.dump());
  const auto sand = grit({"advise", "two.json", "--study", "sand.json"});
  EXPECT_EQ(sand.status, 1);
  EXPECT_THAT(sand.err, HasSubstr("its settings are what is modelled, not how it is computed"));
  charted.erase("title");
  folder.write("half.json", charted.dump());
  for (const char* no_chart : {"two.json", "half.json", "none.json", "results"}) {
    const auto outcome = grit({"advise", "two.json", "--study", no_chart});
    EXPECT_EQ(outcome.status, 5) << no_chart;
    EXPECT_THAT(outcome.err, HasSubstr("'grit chart'"));
  }
  const auto none = grit({"advise", "two.json"});
  EXPECT_EQ(none.status, 1);
  EXPECT_THAT(none.err, AllOf(HasSubstr("no scenario"), HasSubstr("--study")));
}

TEST_F(Studies, AdviseOnScenesOfTheSamePartsWhereThereIsNoScenario) {
  for (const auto& [scene, title] :
       {std::pair("column", "A column under gravity"), std::pair("oedometer", "Oedometric compr")}) {
    const std::string file = std::string(GRIT_SOURCE_DIR) + "/sims/" + scene + "/quick.json";
    const auto own = grit({"advise", file});
    EXPECT_EQ(own.status, 0) << own.err;
    EXPECT_THAT(own.out, HasSubstr(std::string(", by ") + title));
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
  EXPECT_THAT(other.err, AllOf(HasSubstr("no scenario"), HasSubstr("(the nearest is of \"A column under gravity"),
                               HasSubstr(": here is no \"wall left: plane\", there is no \"wall lid: plane\")")));
}

/// A grit that came with studies of its own.
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

TEST_F(ShippedStudies, ThatCannotBeReadAreLeftOutByName) {
  const auto whole = column("advise");
  EXPECT_EQ(whole.status, 0) << whole.err;
  EXPECT_EQ(whole.err, "");
  folder.write("own/studies/broken.json", R"({"title": "half a)");
  for (const char* command : {"check", "advise"}) {
    const auto outcome = column(command);
    EXPECT_EQ(outcome.status, 0) << command << ": " << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("left out: " + (folder / "own/studies/broken.json").string()),
                                   HasSubstr("is no chart.json"), Not(HasSubstr("column.json"))));
    if (command == std::string("advise")) EXPECT_EQ(outcome.out, whole.out);
  }
}

TEST_F(ShippedStudies, SayWhereADepthIsMoreThanShows) {
  const std::string file = "own/studies/column.json";
  // What the least depth came to, against the usual one: all figures alike.
  const auto changes_by = [&](double error, double standard_error) {
    auto chart = json::parse(text_of(folder / file));
    for (auto& effect : chart.at("effects"))
      if (effect.at("setting") == "depth")
        for (auto& figure : effect.at("figures")) figure["error"] = error, figure["standard_error"] = standard_error;
    folder.write(file, chart.dump());
  };
  const auto check = [&](const std::string& depth, int count) {
    const auto outcome =
        column("check", {"--set", "/domain/high/1=" + depth, "--set", "/bodies/sand/grains/high/1=" + depth, "--set",
                         "/bodies/sand/grains/count=" + std::to_string(count)});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  constexpr auto told = "samples scatter";
  changes_by(0.01, 0.01);
  EXPECT_THAT(check("20 mm", 3000),
              HasSubstr("  /domain/high/1: 20 mm deep; by \"A column under gravity: what the settings cost and what "
                        "they change\" 6 mm changes "));
  EXPECT_THAT(check("20 mm", 3000), HasSubstr(" by 1.0 ± 1.0 %, which is within what samples scatter, and is "));
  EXPECT_THAT(check("10 mm", 1500), Not(HasSubstr(told))) << "less than twice as much";
  changes_by(0.02, 0.005);
  EXPECT_THAT(check("20 mm", 3000), Not(HasSubstr(told))) << "it shows";
  changes_by(0.02, 0.1);
  EXPECT_THAT(check("20 mm", 3000), Not(HasSubstr(told))) << "nobody can tell";
}

}  // namespace
}  // namespace grit
