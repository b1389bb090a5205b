// `calibrate` finds parameters whose runs meet targets.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// Grains that fall freely, slowed down by local damping λ: after a time t each has the velocity g (1 − λ) t.
constexpr auto fall = R"({
  "contacts": {"type": "linear-rolling"},
  "materials": {"sand": {"density": 2600, "contact_modulus": "1 MPa"}},
  "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
    "type": "cloud", "low": [0, 0, 0], "high": ["20 mm", "20 mm", "20 mm"], "count": 36,
    "sizes": {"type": "uniform", "smallest": "1.5 mm", "largest": "2.5 mm"}}}},
  "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.1}},
  "stages": [{"name": "fall", "until": {"type": "time", "value": "10 ms"}, "limit": "1 s"}],
  "probes": {"packing": {"type": "packing", "every_time": "1 ms"}}
}
)";

/// Mean kinetic energy with this damping, with the mean mass of grains whose diameter is uniform from 1.5 to 2.5 mm.
double energy(double damping) {
  const double mean_cube = (std::pow(2.5e-3, 4) - std::pow(1.5e-3, 4)) / 4 / 1e-3,
               mass = 36 * 2600 * std::numbers::pi / 6 * mean_cube, velocity = 9.81 * (1 - damping) * 0.01;
  return 0.5 * mass * velocity * velocity;
}

class Calibrations : public testing::Test {
 protected:
  Calibrations() {
    folder.write("fall.json", fall);
    calibration = {
        {"title", "damping of a fall"},
        {"base", "fall.json"},
        {"parameters",
         {{"damping", {{"pointers", {"/engines/damping/coefficient"}}, {"range", {0, 0.9}}, {"start", 0.2}}}}},
        {"targets",
         {{"energy",
           {{"type", "last"},
            {"of", "packing/kinetic_energy"},
            {"value", energy(0.5)},
            {"tolerance", 0.02 * energy(0.5)}}}}},
        {"samples", {{"count", 2}}},
        {"optimizer", {{"trials", 20}}}};
    write();
  }
  void write() { folder.write("damping.json", calibration.dump()); }
  Outcome grit(std::vector<std::string> words) { return grit_in(folder.path(), std::move(words)); }
  json result() const { return json::parse(text_of(folder / "results/damping/calibration.json")); }
  /// What is reported, with exit status 2, for another value at a pointer; no folder is made.
  std::string fault(const std::string& pointer, const json& value) {
    const json before = calibration;
    calibration[json::json_pointer(pointer)] = value;
    write();
    const auto refused = grit({"calibrate", "damping.json"});
    EXPECT_EQ(refused.status, 2) << pointer << refused.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "results")) << pointer;
    calibration = before;
    write();
    return refused.err;
  }
  OwnFolder folder;
  json calibration;
};

TEST_F(Calibrations, FindAParameterAndWriteADescriptionWithIt) {
  const auto plan = grit({"calibrate", "damping.json", "--dry-run", "--jobs", "2"});
  ASSERT_EQ(plan.status, 0) << plan.err;
  EXPECT_THAT(plan.out,
              AllOf(HasSubstr("at most 50 runs: 20 trials of the search and 5 around its optimum, 2 runs each"),
                    HasSubstr(" a run, at most ")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));

  const auto first = grit({"calibrate", "damping.json", "--jobs", "2"});
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("damping of a fall: at most 25 trials of 2 runs, results in results/damping"));
  EXPECT_THAT(first.out, AllOf(HasSubstr("  damping: 0."),
                               ContainsRegex("energy: [0-9.]+ ± [0-9.e-]+ µJ, target 0.5011 ± 0.01 µJ, misfit"),
                               HasSubstr("All targets are met within tolerance and scatter."),
                               HasSubstr("fitted description: results/damping/fitted.json"),
                               HasSubstr("page: results/damping/calibration.html")));
  const json optimum = result().at("optimum");
  const double found = optimum.at("parameters").at("damping").at("value"),
               error = optimum.at("parameters").at("damping").at("standard_error");
  EXPECT_NEAR(found, 0.5, 3 * error);
  EXPECT_LT(error, 0.1);
  EXPECT_THAT(text_of(folder / "results/damping/calibration.html"),
              AllOf(HasSubstr("damping of a fall"), HasSubstr("<th>energy [µJ]</th>"), Not(HasSubstr("Correlation"))));

  // The fitted description is ready to run.
  const json fitted = json::parse(text_of(folder / "results/damping/fitted.json"));
  EXPECT_EQ(fitted.at("extends"), "../../fall.json");
  EXPECT_EQ(fitted.at("engines").at("damping").at("coefficient"), found);
  ASSERT_EQ(grit({"run", "results/damping/fitted.json", "--out", "fitted", "--quiet"}).status, 0);
  const auto run = json::parse(text_of(folder / "fitted/run.json"));
  EXPECT_EQ(run.at("description").at("engines").at("damping").at("coefficient"), found);

  // As if it had been interrupted: what is missing is run again, and the optimum is the same.
  const std::string folder_of_first = "results/damping/trials/0001/seed-1/run.json";
  const auto kept = std::filesystem::last_write_time(folder / folder_of_first);
  std::filesystem::remove_all(folder / "results/damping/trials/0003");
  std::filesystem::remove(folder / "results/damping/calibration.json");
  const auto second = grit({"calibrate", "damping.json"});
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_EQ(result().at("optimum").at("parameters"), optimum.at("parameters"));
  EXPECT_EQ(std::filesystem::last_write_time(folder / folder_of_first), kept) << "run once";
  EXPECT_TRUE(std::filesystem::exists(folder / "results/damping/trials/0003/seed-2/run.json"));

  // Another calibration does not replace it by itself.
  calibration["parameters"]["damping"]["start"] = 0.4;
  write();
  const auto other = grit({"calibrate", "damping.json"});
  EXPECT_EQ(other.status, 5);
  EXPECT_THAT(other.err, AllOf(HasSubstr("holds another calibration"), HasSubstr("--overwrite")));
  EXPECT_EQ(std::filesystem::last_write_time(folder / folder_of_first), kept);
  EXPECT_EQ(grit({"calibrate", "damping.json", "--overwrite"}).status, 0);
  EXPECT_EQ(result().at("trials")[0].at("values"), json({0.4}));
}

TEST_F(Calibrations, KeepFilesOfTheUser) {
  const std::string trials = "results/damping/trials/";
  folder.write(trials + "0001/seed-1/log.txt", "mine");
  const auto refused = grit({"calibrate", "damping.json", "--overwrite"});
  EXPECT_EQ(refused.status, 5);
  EXPECT_THAT(refused.err,
              HasSubstr(trials + "0001/seed-1/log.txt: no study or calibration wrote this file, which would "
                                 "be replaced"));
  std::filesystem::remove(folder / (trials + "0001/seed-1/log.txt"));
  const std::vector<std::string> own{"notes.txt", "lab/measured.csv", "0099/seed-1/data.csv", "0001/note.txt",
                                     "0001/seed-1/note.txt"};
  for (const auto& file : own) folder.write(trials + file, "mine");
  for (int times = 0; times < 2; ++times) ASSERT_EQ(grit({"calibrate", "damping.json", "--overwrite"}).status, 0);
  for (const auto& file : own) EXPECT_EQ(text_of(folder / (trials + file)), "mine") << file;
  // Runs of trials that there are no more are removed.
  calibration["optimizer"]["trials"] = 1;
  write();
  ASSERT_EQ(grit({"calibrate", "damping.json", "--overwrite"}).status, 0);
  const std::size_t last = result().at("trials").size();
  EXPECT_LT(last, 9u);
  EXPECT_FALSE(std::filesystem::exists(folder / (trials + "000" + std::to_string(last + 1))));
}

TEST_F(Calibrations, AreInterruptedAndContinued) {
  auto scene = json::parse(fall);
  scene["stages"][0]["until"]["value"] = "100 s", scene["stages"][0]["limit"] = "200 s";
  folder.write("fall.json", scene.dump());
  Program running(grit_with({"calibrate", "damping.json", "--jobs", "1"}), folder.path());
  ASSERT_TRUE(running.wait_for("results in"));
  while (!std::filesystem::exists(folder / "results/damping/trials/0001/seed-1/run.json")) std::this_thread::yield();
  const auto second = grit({"calibrate", "damping.json"});
  EXPECT_EQ(second.status, 5);
  EXPECT_THAT(second.err, HasSubstr("another 'grit calibrate'"));
  running.interrupt();
  const auto outcome = running.finish();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; run the same command again to continue"));
  EXPECT_THAT(text_of(folder / "results/damping/trials/0001/seed-1/run.json"), HasSubstr("interrupted"));
}

TEST_F(Calibrations, EndIfTheBaseIsEdited) {
  auto scene = json::parse(fall);
  scene["stages"][0]["until"]["value"] = "60 ms";
  folder.write("fall.json", scene.dump());
  Program running(grit_with({"calibrate", "damping.json", "--jobs", "1"}), folder.path());
  ASSERT_TRUE(running.wait_for("results in"));
  while (!std::filesystem::exists(folder / "results/damping/trials/0001/seed-1/run.json")) std::this_thread::yield();
  scene["bodies"]["grains"]["source"]["count"] = 20;
  folder.write("fall.json", scene.dump());
  const auto outcome = running.finish();
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, HasSubstr("fall.json: was edited while the calibration ran"));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/damping/fitted.json"));
}

TEST_F(Calibrations, LeaveNoRunsWhenKilled) {
  auto scene = json::parse(fall);
  scene["stages"][0]["until"]["value"] = "100 s", scene["stages"][0]["limit"] = "200 s";
  folder.write("fall.json", scene.dump());
  Program running(grit_with({"calibrate", "damping.json", "--jobs", "1"}), folder.path());
  ASSERT_TRUE(running.wait_for("results in"));
  const auto run = folder / "results/damping/trials/0001/seed-1/run.json";
  while (!std::filesystem::exists(run)) std::this_thread::yield();
  running.interrupt(SIGKILL);
  EXPECT_EQ(running.finish().status, -SIGKILL);
  const auto status = [&] { return json::parse(text_of(run)).at("status"); };
  while (status() == "running") std::this_thread::yield();
  EXPECT_EQ(status(), "interrupted") << "it has saved its state";
}

TEST_F(Calibrations, RefuseParametersOnWhichNoRunDepends) {
  const auto pointer = [&](const char* to) { return fault("/parameters/damping/pointers", {to}); };
  EXPECT_THAT(pointer("/materials/snd/rolling_limit"),
              HasSubstr("damping.json:1: /parameters/damping/pointers/0: /materials/snd: no body and no wall uses it; "
                        "allowed is a value that changes the run"));
  EXPECT_THAT(fault("/parameters/damping", {{"pointers", {"/title"}}, {"range", {"2 deg", "9 deg"}}}),
              HasSubstr("/parameters/damping/pointers/0: /title: no run depends on it"));
  EXPECT_THAT(pointer("/materials/sand/twisting_limit"),
              HasSubstr("/parameters/damping/pointers/0: /materials/sand/twisting_limit: "));
  EXPECT_THAT(fault("/parameters/damping/pointers", {"/engines/damping/coefficient", "/materials/snd/rolling_limit"}),
              AllOf(HasSubstr("/parameters/damping/pointers/1: "), HasSubstr("grit: 1 problem")));
  const auto dry = grit({"calibrate", "damping.json", "--dry-run"});
  EXPECT_THAT(dry.err, Not(HasSubstr("without effect")));
  EXPECT_EQ(dry.status, 0);
  // Together they have an effect, though not where both are 0.
  for (const char* name : {"stiffness", "limit"})
    calibration["parameters"][name] = {
        {"pointers", {std::string("/materials/sand/rolling_") + name}}, {"range", {0, 1}}, {"start", 0}};
  calibration["set"] = {{"/materials/snd/friction_angle", "30 deg"}};
  write();
  const auto both = grit({"calibrate", "damping.json", "--dry-run"});
  EXPECT_EQ(both.status, 0) << both.err;
  EXPECT_THAT(both.err,
              HasSubstr("grit: warning: damping.json:1: /set/~1materials~1snd~1friction_angle: without effect: "
                        "/materials/snd: no body and no wall uses it"));
}

TEST_F(Calibrations, RefuseValuesThatMustBeWhole) {
  calibration["parameters"]["damping"] = {
      {"pointers", {"/bodies/grains/source/count"}}, {"range", {20, 60}}, {"start", 40}};
  write();
  const auto refused = grit({"calibrate", "damping.json", "--dry-run"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("damping.json:1: /parameters/damping/pointers/0: /bodies/grains/source/count: "
                              "found the number 44.7214; allowed is an integer. "),
                    HasSubstr("vary the value in a study")));
}

TEST_F(Calibrations, ReadTargetsInTheUnitOfTheirChannel) {
  calibration["targets"]["energy"].update({{"value", "0.004 mJ"}, {"tolerance", "0.1 uJ"}});
  write();
  EXPECT_EQ(grit({"calibrate", "damping.json", "--dry-run"}).status, 0);
  EXPECT_THAT(
      fault("/targets/energy/value", "3 mm"),
      AllOf(HasSubstr("damping.json:1: /targets/energy/value: found the text \"3 mm\"; allowed is a number in J"),
            HasSubstr("mJ")));
  EXPECT_THAT(fault("/targets/energy/value", 1e160), HasSubstr("/targets/energy/value: found 1e+160"));
}

TEST_F(Calibrations, RefuseWhatCannotBeRun) {
  EXPECT_THAT(fault("/parameters/damping/pointers", {"/engines/dampng/coefficient"}),
              AllOf(HasSubstr("damping.json:1: /parameters/damping/pointers/0: /engines/dampng"), HasSubstr("type")));
  EXPECT_THAT(
      fault("/parameters/damping/range", {0.2, 1.5}),
      AllOf(HasSubstr("/parameters/damping/pointers/0: /engines/damping/coefficient: found"), HasSubstr("1.5")));
  EXPECT_THAT(fault("/parameters/damping/range", {0.9, 0.2}), HasSubstr("which is empty"));
  EXPECT_THAT(fault("/parameters/damping/start", 2), HasSubstr("allowed is a value from 0 to 0.9"));
  EXPECT_THAT(fault("/samples/pointer", "/sed"), HasSubstr("/samples/pointer: /sed: unknown key"));
  EXPECT_THAT(fault("/targets/energy/of", "packing/energy"),
              AllOf(HasSubstr("damping.json:1: /targets/energy/of: found \"packing/energy\", which is not a channel"),
                    HasSubstr("packing/kinetic_energy")));
  EXPECT_THAT(fault("/targets/energy/of", "walls/force"), HasSubstr("which is not in the scene"));
  const auto curve = [&](const std::string& rows) {
    folder.write("lab.csv", rows);
    return fault("/targets/energy", {{"type", "curve"},
                                     {"of", "packing/kinetic_energy"},
                                     {"curve", {{"file", "lab.csv"}, {"x", "t"}, {"y", "e"}}},
                                     {"tolerance", 1}});
  };
  EXPECT_THAT(curve("t,f\n0,1\n1,2\n"), AllOf(HasSubstr("damping.json:1: /targets/energy/curve/file: "),
                                              HasSubstr("lab.csv:1: there is no column \"e\"")));
  EXPECT_THAT(curve("t,e\n0,1\n1,much\n"), HasSubstr("lab.csv:3: column \"e\" is \"much\""));
  EXPECT_THAT(curve("t,e\n0,1\n"), HasSubstr("fewer than two points"));
  EXPECT_EQ(grit({"calibrate"}).status, 1);
  EXPECT_EQ(grit({"calibrate", "none.json"}).status, 5);
}

TEST_F(Calibrations, EndWithStatus4IfAllTrialsFail) {
  calibration["set"] = {{"/guards/travel", 1e-12}};
  calibration["optimizer"]["trials"] = 3;
  write();
  const auto outcome = grit({"calibrate", "damping.json"});
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("grit: warning: trial 1 (damping=0.2) failed, seed 1: "),
                                 HasSubstr("/guards/travel"), HasSubstr("all 3 trials failed")));
  EXPECT_EQ(text_of(folder / "results/damping/calibration.html"), "") << "there is no optimum to show";
}

TEST_F(Calibrations, KeepFilesThatNoneWrote) {
  for (const char* name : {"calibration.json", "fitted.json", "calibration.html"}) {
    folder.write(std::string("results/damping/") + name, "mine");
    const auto refused = grit({"calibrate", "damping.json", "--overwrite"});
    EXPECT_EQ(refused.status, 5) << name;
    EXPECT_THAT(refused.err, AllOf(HasSubstr(name), Not(HasSubstr("trial 1"))));
    EXPECT_EQ(text_of(folder / (std::string("results/damping/") + name)), "mine");
    std::filesystem::remove(folder / (std::string("results/damping/") + name));
  }
  ASSERT_EQ(grit({"run", "fall.json", "--out", "results/damping/trials/0001/seed-1", "--quiet"}).status, 0);
  const auto refused = grit({"calibrate", "damping.json", "--overwrite"});
  EXPECT_EQ(refused.status, 5);
  EXPECT_THAT(refused.err, HasSubstr("results/damping/trials/0001/seed-1: no study or calibration began this run"));
}

TEST_F(Calibrations, KeepToFoldersOfTheirOwn) {
  const auto refused = [&](const std::vector<std::string>& words, const char* whose) {
    const auto outcome = grit(words);
    EXPECT_EQ(outcome.status, 5) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(std::string("holds the results of a ") + whose), HasSubstr("--out")));
  };
  ASSERT_EQ(grit({"run", "fall.json", "--out", "one", "--quiet"}).status, 0);
  refused({"calibrate", "damping.json", "--out", "one"}, "run");
  EXPECT_FALSE(std::filesystem::exists(folder / "one/trials"));
  calibration["optimizer"]["trials"] = 1;
  write();
  ASSERT_EQ(grit({"calibrate", "damping.json", "--quiet"}).status, 0);
  refused({"run", "fall.json", "--out", "results/damping"}, "calibration");
  refused({"run", "fall.json", "--out", "results/damping", "--overwrite"}, "calibration");
  EXPECT_FALSE(std::filesystem::exists(folder / "results/damping/run.json"));
  folder.write("study.json", R"({"scene": "fall.json", "purpose": "sweep", "seeds": {"values": [1]},
    "settings": {"damping": {"pointers": ["/engines/damping/coefficient"], "values": [0.1, 0.2]}},
    "metrics": {"energy": {"type": "last", "of": "packing/kinetic_energy"}}})");
  ASSERT_EQ(grit({"study", "study.json", "--quiet"}).status, 0);
  refused({"calibrate", "damping.json", "--out", "results/study"}, "study");
  refused({"run", "fall.json", "--out", "results/study"}, "study");
  refused({"study", "study.json", "--out", "results/damping"}, "calibration");
  refused({"study", "study.json", "--out", "one"}, "run");
}

}  // namespace
}  // namespace grit
