// Runs and how they end: exit status 0, 4, 5 and 130.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <unistd.h>

#include <map>
#include <nlohmann/json.hpp>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

const std::string hdf5_signature = "\x89HDF\r\n\x1a\n";

class Runs : public testing::Test {
 protected:
  Runs() { folder.write("two.json", two_grains); }
  Outcome grit(std::vector<std::string> words) const { return grit_in(folder.path(), std::move(words)); }
  json run_json(const std::string& results) const { return json::parse(text_of(folder / (results + "/run.json"))); }
  /// Of all files below a folder.
  std::map<std::string, std::string> contents(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / name))
      if (entry.is_regular_file()) files[entry.path().string()] = text_of(entry.path());
    return files;
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }

  OwnFolder folder;
};

TEST_F(Runs, LeaveResults) {
  const auto outcome = grit({"run", "two.json", "--threads", "1"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("two.json: two grains\n2 bodies, 1 thread, results in results/two\n"),
                                 HasSubstr("stage \"part\" ended")));
  EXPECT_THAT(outcome.out, AllOf(StartsWith("packing/kinetic_energy: peak "), HasSubstr("200 steps of 2 bodies in "),
                                 testing::ContainsRegex(" in [0-9.]+ s, [0-9.e-]+ s of it for steps: [0-9.]+ M "
                                                        "particle-steps/s \\(search"),
                                 EndsWith("results: results/two\nreport: results/two/report.html\n")));
  const auto run = run_json("results/two");
  EXPECT_EQ(run.at("status"), "done");
  EXPECT_EQ(run.at("steps"), 200);
  EXPECT_EQ(run.at("bodies"), 2);
  EXPECT_EQ(run.at("threads"), 1);
  for (const char* name : {"series.h5", "frames/000000.h5"})
    EXPECT_THAT(text_of(folder / (std::string("results/two/") + name)), StartsWith(hdf5_signature));
  for (const char* name : {"frames.xdmf", "description.json", "packing.txt"})
    EXPECT_TRUE(exists(std::string("results/two/") + name)) << name;
}

TEST_F(Runs, CanBeRunAgainFromWhatTheyLeave) {
  ASSERT_EQ(grit({"run", "two.json", "--out", "first"}).status, 0);
  const auto again = grit({"run", "first/description.json", "--out", "second"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(text_of(folder / "first/packing.txt"), text_of(folder / "second/packing.txt"));
  EXPECT_EQ(run_json("first").at("description"), run_json("second").at("description"));
}

TEST_F(Runs, PrintOnlyResultsIfQuiet) {
  const auto outcome = grit({"run", "two.json", "--quiet"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("results: results/two"));
}

TEST_F(Runs, WarnOfStreamsThatAreBlockedAlsoIfQuiet) {
  auto scene = json::parse(two_grains);
  scene["materials"]["sand"]["contact_modulus"] = 1e6;
  scene["engines"]["gravity"] = {{"type", "gravity"}};
  scene["bodies"]["poured"] = {{"type", "sphere"}, {"material", "sand"}};
  scene["bodies"]["poured"]["source"] = {{"type", "stream"},
                                         {"number_rate", 2000},
                                         {"region", {{"type", "disc"}, {"centre", {0, 0, 0.05}}, {"radius", 0.002}}},
                                         {"sizes", {{"type", "list"}, {"diameters", {0.002}}}}};
  scene["stages"][0]["until"] = {{"type", "time"}, {"value", 0.02}};
  folder.write("blocked.json", scene.dump());
  const auto outcome = grit({"run", "blocked.json", "--quiet", "--no-report"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const std::string warning =
      "bodies of the stream \"poured\" find no room, the next with a diameter of 0.002 m in a "
      "region 0.004 m wide: enlarge the region (/bodies/poured/source/region), ";
  EXPECT_THAT(outcome.err, StartsWith("grit: warning: blocked.json: " + warning));
  ASSERT_EQ(run_json("results/blocked").at("warnings").size(), 1u);
  EXPECT_THAT(run_json("results/blocked").at("warnings").at(0).get<std::string>(), StartsWith(warning));
  ASSERT_EQ(grit({"run", "two.json"}).status, 0);
  EXPECT_THAT(run_json("results/two").at("warnings"), IsEmpty());
}

TEST_F(Runs, TakeSets) {
  ASSERT_EQ(grit({"run", "two.json", "--out", "set", "--set", "/stages/0/until/value=20", "--set", "/seed=5"}).status,
            0);
  EXPECT_EQ(run_json("set").at("steps"), 20);
  EXPECT_EQ(run_json("set").at("seed"), 5);
  EXPECT_EQ(run_json("set").at("description").at("stages").at(0).at("until").at("value"), 20);
}

TEST_F(Runs, ReportCurvesWithoutAValueAtTheEnd) {
  auto scene = json::parse(two_grains);
  const auto curve = [](const char* formula) { return json{{"formula", formula}}; };
  scene["probes"]["test"] = {{"type", "formula"},
                             {"every_steps", 50},
                             {"curves",
                              {{"gone", curve("step < 200 ? 2 : 0 / 0")},
                               {"never", curve("0 / 0")},
                               {"late", curve("step > 0 ? 3 : 0 / 0")}}}};
  scene["output"]["summary"] = {"test/gone", "test/never", "test/late"};
  folder.write("undefined.json", scene.dump());
  const auto outcome = grit({"run", "undefined.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("test/gone: peak 2, not defined at the end\n"
                                      "test/never: not defined at the end\n"
                                      "test/late: peak 3, final 3\n"));
}

TEST_F(Runs, ReportCurvesInReadableUnits) {
  auto scene = json::parse(two_grains);
  scene["probes"]["test"] = {{"type", "formula"},
                             {"every_steps", 50},
                             {"curves",
                              {{"angle", {{"formula", "step > 0 ? 0.5 * _pi : _pi"}, {"unit", "rad"}}},
                               {"stress", {{"formula", "step > 0 ? 2e5 : 0"}, {"unit", "Pa"}}}}}};
  scene["output"]["summary"] = {"test/angle", "test/stress"};
  folder.write("units.json", scene.dump());
  const auto outcome = grit({"run", "units.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("test/angle: peak 180°, final 90°\ntest/stress: peak 200 kPa, final 200 kPa\n"));
}

TEST_F(Runs, DoNotReplaceOthersWithoutOverwrite) {
  ASSERT_EQ(grit({"run", "two.json"}).status, 0);
  const auto before = text_of(folder / "results/two/run.json");
  const auto refused = grit({"run", "two.json"});
  EXPECT_EQ(refused.status, 5);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("results/two holds the results of a run"), HasSubstr("--out"), HasSubstr("--overwrite")));
  EXPECT_EQ(text_of(folder / "results/two/run.json"), before);
  EXPECT_EQ(grit({"run", "two.json", "--overwrite"}).status, 0);
  EXPECT_NE(text_of(folder / "results/two/run.json"), before);
}

TEST_F(Runs, KeepOldResultsUntilNothingCanBeRefused) {
  ASSERT_EQ(grit({"run", "two.json"}).status, 0);
  const auto before = contents("results/two");
  for (const std::string set :
       {R"(/output/summary=["packing/nothing"])", R"(/engines/field={"type": "force-field", "x": "x +"})",
        R"(/engines/field={"type": "force-field", "x": "nothing"})",
        R"(/probes/cells={"type": "stress", "every_steps": 50, "region_low": [0, 0, 0], "region_high": [1, 1, 1]})",
        R"(/time_step/value=1)", R"(/bodies/grains/source/bodies/1/position=[0, 0, 0])"}) {
    const auto refused = grit({"run", "two.json", "--overwrite", "--set", set});
    EXPECT_EQ(refused.status, 2) << set << refused.err;
    EXPECT_EQ(contents("results/two"), before) << set;
  }
  const auto refused =
      shell(folder.path(), "ulimit -S -v 1500000; \"" GRIT_BINARY "\" run two.json --overwrite --quiet --threads 1000");
  EXPECT_NE(refused.status, 0);
  EXPECT_EQ(contents("results/two"), before) << "threads: " << refused.err;
}

TEST_F(Runs, TouchNoFileThatTheyDidNotWrite) {
  for (const std::string name :
       {"frames/photo.jpg", "frames/000001.h5", "run.json", "description.json", "series.h5", "checkpoint.h5",
        "packing.txt", "picture.svg", "report.html", "frames.xdmf", "grains.pvd", "run.json.part"}) {
    folder.write("mine/" + name, "mine");
    for (const char* option : {"--quiet", "--overwrite", "--resume"}) {
      const auto refused = grit({"run", "two.json", "--out", "mine", option});
      EXPECT_EQ(refused.status, 5) << name << ' ' << option << refused.err;
      EXPECT_THAT(refused.err, HasSubstr("mine/" + name)) << option;
    }
    EXPECT_EQ(text_of(folder / ("mine/" + name)), "mine") << name;
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "mine"))
      files += entry.is_regular_file() ? 1 : 0;
    EXPECT_EQ(files, 1u) << name << ": nothing was added";
    std::filesystem::remove_all(folder / "mine");
  }
  folder.write("mine/photo.jpg", "mine"), std::filesystem::create_directory(folder / "mine/frames");
  EXPECT_EQ(grit({"run", "two.json", "--out", "mine"}).status, 0) << "other names are no obstacle";
  EXPECT_EQ(text_of(folder / "mine/photo.jpg"), "mine");
}

TEST_F(Runs, ReplaceWhatARunThatBrokeOffAtOnceLeft) {
  ASSERT_EQ(grit({"run", "two.json"}).status, 0);
  auto begun = text_of(folder / "results/two/run.json");
  begun.replace(begun.find("done"), 4, "running");
  const std::string part = begun.substr(0, 512), lost;  // a machine that stops leaves empty files
  for (const std::map<std::string, std::string>& left : std::vector<std::map<std::string, std::string>>{
           {{"run.json.part", ""}},
           {{"run.json.part", part}},
           {{"run.json", lost}},
           {{"run.json", begun}, {"description.json.part", ""}},
           {{"run.json", lost}, {"description.json", lost}, {"series.journal", lost}, {"series.h5", lost}}}) {
    for (const auto& [name, text] : left) folder.write("left/" + name, text);
    const auto outcome = grit({"run", "two.json", "--out", "left", "--overwrite"});
    EXPECT_EQ(outcome.status, 0) << left.rbegin()->first << outcome.err;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "left"))
      EXPECT_THAT(entry.path().string(), Not(EndsWith(".part")));
    std::filesystem::remove_all(folder / "left");
    for (const auto& [name, text] : left) folder.write("left/" + name, text);
    const auto resumed = grit({"run", "--resume", "left"});
    EXPECT_NE(resumed.status, 0) << left.rbegin()->first;
    if (!left.contains("description.json"))
      EXPECT_THAT(resumed.err, HasSubstr("start the run again with its description: 'grit run FILE --out left "
                                         "--overwrite'"));
    std::filesystem::remove_all(folder / "left");
  }
}

TEST_F(Runs, LeaveNothingOnADiskThatIsFullAtOnce) {
  std::filesystem::create_directory(folder / "small");
  const std::string in_a_small_disk = "unshare -rm bash -c 'mount -t tmpfs -o size=";
  if (shell(folder.path(), in_a_small_disk + "8k tmpfs small'").status != 0) GTEST_SKIP() << "no mounts for this user";
  for (const char* size : {"4k", "8k", "12k", "16k", "20k", "24k"}) {
    const auto outcome = shell(folder.path(), in_a_small_disk + size +
                                                  " tmpfs small && ! \"" GRIT_BINARY
                                                  "\" run two.json --set /output/frames=null --out small/results && "
                                                  "test -z \"$(ls small)\" && mount -o remount,size=4m small && "
                                                  "\"" GRIT_BINARY "\" run two.json --out small/results --overwrite'");
    EXPECT_EQ(outcome.status, 0) << size << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("No space left on device")) << size;
  }
}

TEST_F(Runs, KeepTheFilesOfOthersInAFolderThatIsOverwritten) {
  ASSERT_EQ(grit({"run", "two.json"}).status, 0);
  const auto before = text_of(folder / "results/two/run.json");
  const auto description = text_of(folder / "results/two/description.json");
  const auto refused = [&](const std::string& name) {
    const auto outcome = grit({"run", "two.json", "--overwrite"});
    EXPECT_EQ(outcome.status, 5) << name;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("results/two/" + name), HasSubstr("--out DIR")));
    EXPECT_EQ(text_of(folder / "results/two/run.json"), before) << name;
    EXPECT_TRUE(exists("results/two/series.h5") && exists("results/two/frames/000000.h5")) << name;
  };
  folder.write("results/two/frames/photo.jpg", "mine");
  refused("frames/photo.jpg");
  std::filesystem::remove(folder / "results/two/frames/photo.jpg");
  folder.write("results/two/report.html", "mine");
  refused("report.html");
  std::filesystem::remove(folder / "results/two/report.html");
  auto edited = json::parse(description);
  edited["seed"] = 7;
  folder.write("results/two/description.json", edited.dump());
  refused("description.json");
  folder.write("results/two/description.json", description);
  EXPECT_EQ(grit({"run", "two.json", "--overwrite"}).status, 0);
}

TEST_F(Runs, DoNotReplaceWhatTheyRead) {
  folder.write("description.json", two_grains);
  auto refused = grit({"run", "description.json", "--out", "."});
  EXPECT_EQ(refused.status, 5);
  EXPECT_EQ(text_of(folder / "description.json"), two_grains);

  ASSERT_EQ(grit({"run", "two.json"}).status, 0);
  const auto packing = text_of(folder / "results/two/packing.txt"), run = text_of(folder / "results/two/run.json");
  const std::string source = R"(/bodies/grains/source={"type": "file", "path": "results/two/packing.txt"})";
  folder.write("child.json", R"({"extends": "results/two/description.json"})");
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"results/two/description.json"},
                                             {"child.json"},
                                             {"two.json", "--set", source},
                                             {"two.json", "--set", R"(/begin={"from": "results/two"})", "--set",
                                              R"(/bodies/grains/source={"type": "sample"})"}}) {
    auto all = words;
    all.insert(all.begin(), "run"), all.insert(all.end(), {"--out", "results/two", "--overwrite"});
    refused = grit(all);
    EXPECT_EQ(refused.status, 5) << words.back() << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("this run reads it and would replace it")) << words.back();
  }
  EXPECT_EQ(text_of(folder / "results/two/packing.txt"), packing);
  EXPECT_EQ(text_of(folder / "results/two/run.json"), run);
}

TEST_F(Runs, AreRefusedWhereAnotherOneWrites) {
  ASSERT_EQ(grit({"run", "two.json"}).status, 0);
  const auto before = text_of(folder / "results/two/run.json");
  const int other = ::open((folder / "results/two").c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"run", "two.json"}, {"run", "two.json", "--overwrite"}, {"run", "--resume", "results/two"}}) {
    const auto refused = grit(words);
    EXPECT_EQ(refused.status, 5) << words.back();
    EXPECT_EQ(refused.err, "grit: results/two: another run is writing there; wait for it, or choose another folder\n")
        << words.back();
  }
  ::close(other);
  EXPECT_EQ(text_of(folder / "results/two/run.json"), before);
  EXPECT_EQ(grit({"run", "two.json", "--overwrite"}).status, 0);
}

TEST_F(Runs, RunOneAfterTheOther) {
  folder.write("other.json", two_grains);
  EXPECT_EQ(grit({"run", "two.json", "other.json", "--out", "both"}).status, 0);
  EXPECT_EQ(run_json("both/two").at("status"), "done");
  EXPECT_EQ(run_json("both/other").at("status"), "done");
}

TEST_F(Runs, AreAllReadBeforeTheFirstBegins) {
  folder.write("bad.json", "{\"sede\": 1}");
  EXPECT_EQ(grit({"run", "two.json", "bad.json"}).status, 2);
  EXPECT_FALSE(exists("results"));
}

TEST_F(Runs, ContinueWithTheNextWhenNumericsFail) {
  auto scene = json::parse(two_grains);
  scene["guards"]["travel"] = 1e-6;
  folder.write("tight.json", scene.dump());
  const auto outcome = grit({"run", "tight.json", "two.json"});
  EXPECT_EQ(outcome.status, 4);
  EXPECT_EQ(run_json("results/tight").at("status"), "failed");
  EXPECT_EQ(run_json("results/two").at("status"), "done");
}

TEST_F(Runs, StopWhenAGuardTrips) {
  const auto outcome = grit({"run", "two.json", "--set", "/guards/travel=1e-6"});
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("grit: two.json: step "), HasSubstr("stage \"part\": body "),
                                 HasSubstr("more than /guards/travel 1e-06")));
  const auto run = run_json("results/two");
  EXPECT_EQ(run.at("status"), "failed");
  EXPECT_THAT(run.at("message").get<std::string>(), HasSubstr("/guards/travel"));
}

TEST_F(Runs, StopWhenAStageDoesNotEnd) {
  const auto outcome = grit({"run", "two.json", "--set", "/stages/0/limit=1e-6"});
  EXPECT_EQ(outcome.status, 4);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("stage \"part\" did not end within its limit"), HasSubstr("/stages/0/limit")));
}

TEST_F(Runs, RefuseATimeStepAboveTheCriticalOne) {
  const auto outcome = grit({"run", "two.json", "--set", "/time_step/value=1"});
  EXPECT_NE(outcome.status, 0);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("critical"), HasSubstr("allow_unstable")));
}

TEST_F(Runs, NeedAWritableFolder) {
  auto outcome = grit({"run", "two.json", "--out", "two.json/results"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, HasSubstr("two.json/results: cannot create the results folder: Not a directory"));
  if (::geteuid() == 0) return;  // root may write to any folder
  std::filesystem::create_directory(folder / "closed");
  std::filesystem::permissions(folder / "closed",
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  outcome = grit({"run", "two.json", "--out", "closed/results"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, HasSubstr("Permission denied"));
}

TEST_F(Runs, ReportAFullDisk) {
  std::filesystem::create_directory(folder / "small");
  const std::string in_a_small_disk = "unshare -rm bash -c 'mount -t tmpfs -o size=48k tmpfs small && ";
  if (shell(folder.path(), in_a_small_disk + "true'").status != 0) GTEST_SKIP() << "no mounts for this user";
  const auto outcome = shell(folder.path(), in_a_small_disk + "\"" GRIT_BINARY
                                                              "\" run two.json --out small/results "
                                                              "--set /output/frames/every_steps=50'");
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("small/results/"), HasSubstr("No space left on device"),
                    HasSubstr("\n  free space on the disk, or remove the cause, then run it again, as there is "
                              "no checkpoint yet: 'grit run --overwrite two.json'\n")));
}

TEST_F(Runs, ContinueAfterADiskWasFull) {
  std::filesystem::create_directory(folder / "small");
  const std::string in_a_small_disk = "unshare -rm bash -c 'mount -t tmpfs -o size=400k tmpfs small && ";
  if (shell(folder.path(), in_a_small_disk + "true'").status != 0) GTEST_SKIP() << "no mounts for this user";
  const auto outcome = shell(
      folder.path(), in_a_small_disk + "\"" GRIT_BINARY
                                       "\" run two.json --out small/results --set /output/checkpoint_every=1e-6 --set "
                                       "/output/frames/every_steps=50 --set "
                                       "\"/output/frames/formats=[\\\"vtk\\\", \\\"lammps-dump\\\"]\" --set "
                                       "/stages/0/until/value=2000'");  // 41 frames: at least 335 kB
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("No space left on device"),
                    HasSubstr("\n  free space on the disk, or remove the cause, then continue from the last "
                              "checkpoint: 'grit run --resume small/results'\n")));
}

TEST_F(Runs, ReplaceNoFileThatAppearsWhileTheyRun) {
  for (const std::string name : {"frames/000001.h5", "packing.txt"}) {
    Program program(grit_with({"run", "two.json", "--overwrite", "--set", "/stages/0/until/value=2000000", "--set",
                               "/stages/0/limit=\"2000 h\"", "--set", "/output/frames/every_steps=2000000", "--set",
                               "/probes/packing/every_steps=100000"}),
                    folder.path());
    ASSERT_TRUE(program.wait_for("1/1 part"));
    folder.write("results/two/" + name, "mine");
    const auto outcome = program.finish();
    EXPECT_EQ(outcome.status, 5) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("results/two/" + name + ": "),
                                   HasSubstr("move it away, then continue from the last checkpoint: 'grit run --resume "
                                             "results/two'")));
    EXPECT_EQ(text_of(folder / ("results/two/" + name)), "mine");
    if (name.starts_with("frames"))
      EXPECT_EQ(grit({"run", "--resume", "results/two"}).status, 5) << "it is still there";
    EXPECT_EQ(text_of(folder / ("results/two/" + name)), "mine");
    std::filesystem::remove(folder / ("results/two/" + name));
    const auto resumed = grit({"run", "--resume", "results/two"});
    EXPECT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_THAT(resumed.err, HasSubstr("continues from step 2000000"));
    EXPECT_EQ(run_json("results/two").at("steps"), 2000000);
  }
}

TEST_F(Runs, ReportThatTheirSeriesWereRemoved) {
  Program program(
      grit_with({"run", "two.json", "--set", "/stages/0/until/value=1000000000", "--set", "/stages/0/limit=\"2000 h\"",
                 "--set", "/output/frames/every_steps=1000000000", "--set", "/probes/packing/every_steps=10000"}),
      folder.path());
  ASSERT_TRUE(program.wait_for("1/1 part"));
  std::filesystem::remove(folder / "results/two/series.h5");
  program.interrupt();
  const auto outcome = program.finish();
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("results/two/series.h5: was removed or replaced during the run"));
}

class Interrupted : public Runs, public testing::WithParamInterface<int> {};

TEST_P(Interrupted, RunsAreSaved) {
  ::signal(GetParam(), SIG_DFL);  // a program that nohup started, these tests for one, keeps SIGHUP ignored
  Program program(
      grit_with({"run", "two.json", "--out", "results/two of them", "--set",
                 R"(/stages/0/until={"type": "time", "value": "1000 h"})", "--set", "/stages/0/limit=\"2000 h\"",
                 "--set", "/output/frames/every_steps=100000000", "--set", "/probes/packing/every_steps=10000"}),
      folder.path());
  ASSERT_TRUE(program.wait_for("1/1 part"));  // the first report of progress
  program.interrupt(GetParam());
  const auto outcome = program.finish();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.err,
              HasSubstr("interrupted; the results are saved in results/two of them; continue with 'grit run "
                        "--resume \"results/two of them\"'"));
  EXPECT_THAT(outcome.out, HasSubstr("results: results/two of them"));
  const auto run = run_json("results/two of them");
  EXPECT_EQ(run.at("status"), "interrupted");
  EXPECT_GT(run.at("steps"), 0);
  EXPECT_THAT(text_of(folder / "results/two of them/series.h5"), StartsWith(hdf5_signature));
  EXPECT_TRUE(exists("results/two of them/frames/000000.h5"));
  EXPECT_TRUE(exists("results/two of them/packing.txt"));
  EXPECT_THAT(outcome.out, HasSubstr("report: results/two of them/report.html"));
  EXPECT_THAT(text_of(folder / "results/two of them/report.html"),
              AllOf(HasSubstr(">interrupted</span>"), HasSubstr("Interrupted in stage "), HasSubstr("(1 of 1), "),
                    HasSubstr("'grit run --resume &quot;results/two of them&quot;' continues it.")));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "results"))
    EXPECT_THAT(entry.path().string(), Not(EndsWith(".part")));
}

INSTANTIATE_TEST_SUITE_P(By, Interrupted, testing::Values(SIGINT, SIGTERM, SIGHUP, SIGXCPU), [](const auto& info) {
  return info.param == SIGINT    ? "CtrlC"
         : info.param == SIGTERM ? "Termination"
         : info.param == SIGHUP  ? "Hangup"
                                 : "ComputingTime";
});

TEST_F(Runs, GoOnWithoutAReaderOfTheirOutput) {
  const auto outcome = shell(folder.path(),
                             "mkfifo output; exec 3<>output 4>output 3<&-;"  // a pipe whose reader has ended
                             " \"" GRIT_BINARY "\" run two.json >&4 2>&4");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(run_json("results/two").at("status"), "done");
  EXPECT_TRUE(exists("results/two/report.html"));
}

TEST_F(Runs, WriteNoMessagesIntoResultsWhenTheirOutputIsClosed) {
  const auto outcome = shell(folder.path(), "\"" GRIT_BINARY "\" run two.json 0<&- >&- 2>&-");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(grit({"report", "results/two"}).status, 0);
  EXPECT_EQ(run_json("results/two").at("status"), "done");
}

TEST_F(Runs, AreSavedWhenCtrlCEndsTheReaderOfTheirOutputFirst) {
  Program program({"bash", "-c",
                   "mkfifo output; exec 3<>output 4>output; \"" GRIT_BINARY
                   "\" run two.json --set '/stages/0/until={\"type\": \"time\", \"value\": \"1000 h\"}' --set "
                   "'/stages/0/limit=\"2000 h\"' --set /output/frames/every_steps=100000000 --set "
                   "/probes/packing/every_steps=10000 >&4 2>&4 3<&- & "
                   "while read -r line <&3; do [[ $line == *'1/1 part'* ]] && break; done; "
                   "exec 3<&- 4>&-; kill -INT $!; wait $!"},
                  folder.path());
  EXPECT_EQ(program.finish().status, 130);
  EXPECT_EQ(run_json("results/two").at("status"), "interrupted");
  EXPECT_TRUE(exists("results/two/report.html"));
}

TEST_F(Runs, ReportAFileBeyondTheAllowedSize) {
  // Larger than all of series.h5 (0.38 MB), which a slow disk has written before the first checkpoint; smaller than
  // frames.xdmf (1.03 MB). The unit is 512 or 1024 bytes.
  const auto outcome = shell(folder.path(), "ulimit -f 900; \"" GRIT_BINARY
                                            "\" run two.json --set /output/checkpoint_every=1e-6 --set "
                                            "/stages/0/until/value=2000 --set /output/frames/every_steps=5");
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("frames.xdmf: cannot write: File too large"),
                                 HasSubstr("continue from the last checkpoint: 'grit run --resume results/two'")));
  EXPECT_EQ(grit({"run", "--resume", "results/two"}).status, 0);
}

TEST_F(Runs, EndAtOnceWhileTheirBodiesArePlaced) {
  auto scene = json::parse(two_grains);
  // Close to the densest random cloud, so that grains find no place for long.
  scene["bodies"]["grains"]["source"] = {{"type", "cloud"},
                                         {"low", {0, 0, 0}},
                                         {"high", {0.0656, 0.0656, 0.0656}},
                                         {"count", 200000},
                                         {"sizes", {{"type", "list"}, {"diameters", {0.001}}}}};
  folder.write("dense.json", scene.dump());
  Program program(grit_with({"run", "dense.json"}), folder.path());
  ASSERT_TRUE(program.wait_for("dense.json: two grains"));
  program.interrupt();
  const auto outcome = program.finish();
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("interrupted before the run began; nothing was written"),
                                 Not(HasSubstr("200000 bodies"))));
  EXPECT_FALSE(exists("results"));
}

TEST_F(Runs, ReportThreadsThatCannotStart) {
  const std::string limited = "ulimit -S -v 1500000; \"" GRIT_BINARY "\" ";
  if (shell(folder.path(), limited + "--version").status != 0) GTEST_SKIP() << "too little memory for this build";
  const auto outcome = shell(folder.path(), limited + "run two.json --quiet --threads 1000");
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("cannot start 1000 threads, only "), HasSubstr("--threads")));
  EXPECT_FALSE(exists("results"));
}

TEST_F(Runs, StepOnADevice) {
  const auto outcome = grit({"run", "two.json", "--device", "emulated"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(run_json("results/two").at("engine"), "emulated device");
  EXPECT_EQ(grit({"run", "two.json", "--out", "cpu"}).status, 0);
  EXPECT_EQ(run_json("cpu").at("engine"), "cpu");
  const auto unknown = grit({"run", "two.json", "--device", "fpga"});
  EXPECT_EQ(unknown.status, 1);
  EXPECT_THAT(unknown.err, HasSubstr("--device takes none, gpu or emulated, not \"fpga\""));
}

TEST_F(Runs, OnADeviceAreRefusedForAnyStage) {
  auto scene = json::parse(two_grains);
  scene["stages"].push_back(scene["stages"][0]);
  scene["stages"][1]["name"] = "growth", scene["stages"][1]["growth"] = {{"rate", 0.1}};
  folder.write("grow.json", scene.dump());
  const auto outcome = grit({"check", "grow.json", "--device", "emulated"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("/stages: devices cannot let bodies grow yet; run it without --device"));
  EXPECT_EQ(grit({"check", "grow.json"}).status, 0);
}

TEST_F(Runs, AnInterruptedOneKeepsTheOthersFromBeginning) {
  folder.write("other.json", two_grains);
  Program program(grit_with({"run", "two.json", "other.json", "--set", "/stages/0/until/value=1000000000", "--set",
                             "/stages/0/limit=\"2000 h\"", "--set", "/output/frames/every_steps=1000000000", "--set",
                             "/probes/packing/every_steps=10000"}),
                  folder.path());
  ASSERT_TRUE(program.wait_for("1/1 part"));
  program.interrupt();
  EXPECT_EQ(program.finish().status, 130);
  EXPECT_FALSE(exists("results/other"));
}

}  // namespace
}  // namespace grit
