// Runs that are interrupted or killed and resumed: --resume.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "output/read_frames.hpp"
#include "output/read_results.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Grains falling into a box, some seconds; probes that keep data between samples.
constexpr auto falling = R"({
  "title": "grains that fall",
  "contacts": {"type": "linear-rolling"},
  "materials": {"sand": {"density": 2600, "contact_modulus": "10 MPa"}},
  "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
    "type": "cloud", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "20 mm"], "count": 60,
    "sizes": {"type": "uniform", "smallest": "2 mm", "largest": "2.5 mm"}}}},
  "walls": {"box": {"type": "box", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "30 mm"], "open": ["z_high"], "material": "sand"}},
  "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.05}},
  "stages": [
    {"name": "fall", "until": {"type": "steps", "value": 200000}, "limit": "10 h"},
    {"name": "on", "until": {"type": "steps", "value": 20000}, "limit": "10 h"}],
  "probes": {
    "packing": {"type": "packing", "every_steps": 2500},
    "energy": {"type": "energy", "every_steps": 3500},
    "force-chains": {"type": "force-chains", "every_steps": 3850}},
  "output": {"frames": {"every_steps": 4500, "formats": ["vtk", "lammps-dump"]}, "checkpoint_every": 0, "summary": ["energy/friction"],
             "picture": {"x": "packing/time", "y": ["packing/coordination_number"], "color": "speed"}}
}
)";

class Resume : public testing::Test {
 protected:
  Resume() { folder.write("fall.json", falling); }
  static std::vector<std::string> run(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> words{"run", "fall.json", "--no-report", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  Outcome grit(std::vector<std::string> words) const { return grit_in(folder.path(), std::move(words)); }
  json run_json(const std::string& results) const { return json::parse(text_of(folder / (results + "/run.json"))); }

  /// Stops a run in its first stage.
  void interrupt(const std::string& out, std::vector<std::string> more = {}) const {
    Program program(grit_with(run(out, std::move(more))), folder.path());
    Outcome outcome;
    ASSERT_NO_FATAL_FAILURE(interrupt_after(program, folder / (out + "/frames/000001.h5"), outcome));
    EXPECT_THAT(outcome.err, HasSubstr("'grit run --resume " + out + "'"));
  }
  /// Kills a run after it has written a new checkpoint.
  void kill(const std::string& out, std::vector<std::string> more = {}) const {
    const auto path = folder / (out + "/checkpoint.h5");
    const auto written = [&] {
      struct stat file {};
      return ::stat(path.c_str(), &file) == 0 ? std::pair(file.st_ino, file.st_mtim.tv_nsec) : std::pair<ino_t, long>();
    };
    const auto before = written();
    more.insert(more.end(), {"--set", "/output/checkpoint_every=0.05", "--quiet"});
    Program program(grit_with(run(out, std::move(more))), folder.path());
    const auto anew = [&] { return written() != before && written() != std::pair<ino_t, long>(); };
    ASSERT_NO_FATAL_FAILURE(wait_until(anew, "another checkpoint"));
    program.interrupt(SIGKILL);
    ASSERT_EQ(program.finish().status, -SIGKILL);
  }
  /// Series, frames and grains, to the last bit.
  void expect_same_results(const std::string& a, const std::string& b) const {
    const SeriesFile first_series(folder / a), other_series(folder / b);
    const auto names = first_series.channels();
    ASSERT_EQ(names, other_series.channels());
    ASSERT_GT(names.size(), 20u);
    const auto same = [](const std::vector<double>& x, const std::vector<double>& y) {
      return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
    };
    for (const auto& name : names) {
      const auto x = first_series.channel(name), y = other_series.channel(name);
      EXPECT_GT(x.samples, 50u);
      EXPECT_TRUE(same(x.values, y.values)) << name << ": " << x.samples << " and " << y.samples << " samples";
    }
    const auto frames = frame_files(folder / a), others = frame_files(folder / b);
    ASSERT_EQ(frames.size(), others.size());
    ASSERT_GT(frames.size(), 8u);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Frame x = read_frame(frames[i]), y = read_frame(others[i]);
      EXPECT_EQ(x.step, y.step);
      EXPECT_EQ(x.id, y.id);
      EXPECT_TRUE(same(x.position, y.position) && same(x.velocity, y.velocity) &&
                  same(x.normal_force, y.normal_force) && x.body_a == y.body_a)
          << frames[i];
      for (const char* end : {"_grains.vtp", "_walls.vtp", ".dump"}) {
        const auto file = "/frames/" + frames[i].stem().string() + end;
        EXPECT_EQ(text_of(folder / (a + file)), text_of(folder / (b + file))) << file;
      }
    }
    for (const char* file : {"/packing.txt", "/frames.xdmf", "/grains.pvd", "/walls.pvd"})
      EXPECT_EQ(text_of(folder / (a + file)), text_of(folder / (b + file))) << file;
    const auto first = run_json(a), second = run_json(b);
    for (const char* key : {"status", "steps", "time", "rebuilds", "contacts_per_body", "bodies"})
      EXPECT_EQ(first.at(key), second.at(key)) << key;
    for (const char* probe : {"packing", "energy", "force-chains"})
      EXPECT_EQ(first.at("probes").at(probe).at("samples"), second.at("probes").at(probe).at("samples")) << probe;
    ASSERT_EQ(first.at("stages").size(), second.at("stages").size());
    for (std::size_t i = 0; i < first.at("stages").size(); ++i)
      for (const char* key : {"name", "reached", "step"})
        EXPECT_EQ(first.at("stages").at(i).at(key), second.at("stages").at(i).at(key));
  }

  OwnFolder folder;
};

TEST_F(Resume, GivesTheSameAsARunThatWasNeverStopped) {
  const auto whole = grit(run("whole"));
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "whole/checkpoint.h5"));

  interrupt("part");
  EXPECT_EQ(run_json("part").at("status"), "interrupted");
  EXPECT_TRUE(std::filesystem::exists(folder / "part/checkpoint.h5"));
  const auto rest = grit({"run", "part", "--resume", "--no-report", "--threads", "2"});
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_THAT(rest.err, AllOf(HasSubstr("continues from step "), HasSubstr("stage \"fall\"")));
  EXPECT_THAT(rest.out, HasSubstr(whole.out.substr(0, whole.out.find('\n')))) << "largest value of all";
  EXPECT_EQ(run_json("part").at("resumed"), 1);
  expect_same_results("whole", "part");

  const auto again = grit(run("part", {"--resume"}));
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out, "part: already complete\n");
}

/// Such a law is asked how far it reaches before there are bodies.
TEST_F(Resume, ContinuesWithALawThatActsAcrossGaps) {
  const std::vector<std::string> cohesive{"--set", R"(/contacts={"type": "linear-cohesive"})",
                                          "--set", "/materials/sand/tensile_strength=\"600 Pa\"",
                                          "--set", "/stages/0/until/value=40000"};
  const auto whole = grit(run("whole", cohesive));
  ASSERT_EQ(whole.status, 0) << whole.err;
  interrupt("part", cohesive);
  const auto rest = grit({"run", "part", "--resume", "--no-report"});
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_EQ(text_of(folder / "part/packing.txt"), text_of(folder / "whole/packing.txt"));
}

/// The plane is drawn in the box of the first bodies, which a resumed run does not make again.
TEST_F(Resume, DrawsAnUnboundedPlaneAsBefore) {
  const std::vector<std::string> on_a_plane{"--set", "/walls/box=null", "--set",
                                            R"(/walls/floor={"type": "plane", "material": "sand"})"};
  ASSERT_EQ(grit(run("whole", on_a_plane)).status, 0);
  interrupt("part", on_a_plane);
  ASSERT_EQ(grit({"run", "part", "--resume", "--no-report"}).status, 0);
  const auto walls = text_of(folder / "whole/frames/000005_walls.vtp");
  EXPECT_THAT(walls, HasSubstr("NumberOfPolys=\"2\""));
  expect_same_results("whole", "part");
}

TEST_F(Resume, ContinuesAKilledRun) {
  ASSERT_EQ(grit(run("whole")).status, 0);
  kill("killed");
  EXPECT_EQ(run_json("killed").at("status"), "running");
  kill("killed", {"--resume"});
  kill("killed", {"--resume", "--threads", "2"});
  const auto rest = grit(run("killed", {"--resume"}));
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_EQ(run_json("killed").at("resumed"), 3);
  expect_same_results("whole", "killed");
}

TEST_F(Resume, NeedsNoWholeSeries) {
  ASSERT_EQ(grit(run("whole")).status, 0);
  kill("killed");
  const auto series = folder / "killed/series.h5";
  std::filesystem::resize_file(series, std::filesystem::file_size(series) / 3);
  kill("killed", {"--resume"});
  std::filesystem::remove(series);
  const auto rest = grit(run("killed", {"--resume"}));
  ASSERT_EQ(rest.status, 0) << rest.err;
  expect_same_results("whole", "killed");
  EXPECT_FALSE(std::filesystem::exists(folder / "killed/series.journal"));
}

TEST_F(Resume, GoesOnFromTheCheckpointBeforeIfTheLastIsDamaged) {
  ASSERT_EQ(grit(run("whole")).status, 0);
  kill("killed");
  kill("killed", {"--resume"});
  const auto last = folder / "killed/checkpoint.h5", before = folder / "killed/checkpoint-previous.h5";
  ASSERT_TRUE(std::filesystem::exists(before));
  std::filesystem::resize_file(last, std::filesystem::file_size(last) / 2);
  const auto rest = grit(run("killed", {"--resume"}));
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_THAT(rest.err,
              AllOf(HasSubstr("grit: warning: killed/checkpoint.h5: "),
                    HasSubstr("the run continues from the checkpoint before it, killed/checkpoint-previous.h5"),
                    HasSubstr("continues from step ")));
  expect_same_results("whole", "killed");
  EXPECT_FALSE(std::filesystem::exists(last) || std::filesystem::exists(before));
}

TEST_F(Resume, WritesAMissingPageOfACompleteRun) {
  ASSERT_EQ(grit(run("done", {"--set", "/stages/0/until/value=10", "--set", "/stages/1/until/value=10"})).status, 0);
  std::ofstream(folder / "done/checkpoint.h5") << "left by a run that was killed after its end";
  const auto again = grit({"run", "done", "--resume"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out, "done: already complete\nreport: done/report.html\n");
  EXPECT_TRUE(std::filesystem::exists(folder / "done/report.html"));
  EXPECT_FALSE(std::filesystem::exists(folder / "done/checkpoint.h5"));
}

TEST_F(Resume, StartsFromTheBeginningWithoutACheckpoint) {
  const auto outcome =
      grit(run("new", {"--resume", "--set", "/stages/0/until/value=10", "--set", "/stages/1/until/value=10"}));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no checkpoint in new: the run starts from the beginning"));
  EXPECT_EQ(run_json("new").at("resumed"), 0);
}

TEST_F(Resume, KeepsACompleteRunWhoseRunJsonIsLost) {
  ASSERT_EQ(grit(run("done", {"--set", "/stages/0/until/value=10", "--set", "/stages/1/until/value=10"})).status, 0);
  const std::string whole = text_of(folder / "done/run.json"), final_state = text_of(folder / "done/final.h5");
  auto other = json::parse(whole);
  other["status"] = "dune";
  for (const std::string& damaged : {whole.substr(0, whole.size() / 2), std::string(), other.dump()}) {
    folder.write("done/run.json", damaged);
    const auto outcome = grit({"run", "done", "--resume"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr("done: holds the final state of a run, but its run.json is missing or damaged"));
    EXPECT_EQ(text_of(folder / "done/final.h5"), final_state);
  }
  folder.write("done/run.json", whole);
  EXPECT_THAT(grit({"run", "done", "--resume"}).out, HasSubstr("done: already complete"));
}

TEST_F(Resume, LeavesNoPackingOfAnInterruptionIfTheRunFails) {
  interrupt("part");
  ASSERT_TRUE(std::filesystem::exists(folder / "part/packing.txt"));
  EXPECT_EQ(grit({"run", "part", "--resume", "--set", "/guards/travel=1e-9"}).status, 4);
  EXPECT_FALSE(std::filesystem::exists(folder / "part/packing.txt"));
}

TEST_F(Resume, RefusesAnotherRun) {
  interrupt("part");
  const auto before = text_of(folder / "part/run.json");
  const auto other = grit(run("part", {"--resume", "--set", "/seed=7"}));
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, AllOf(HasSubstr("part: holds a run of another description:\n  /seed: found 7, allowed 1"),
                               HasSubstr("'grit run --resume part'"), HasSubstr("--overwrite")));
  // A rebuilt plugin, in another copy of the installation.
  std::filesystem::copy(GRIT_PLUGIN_DIR, folder / "mine", std::filesystem::copy_options::recursive);
  std::ofstream(folder / "mine/probes/energy.so", std::ios::app) << "built again";
  auto words = grit_with(run("part", {"--resume"}));
  words.insert(words.begin(), {"env", "LD_LIBRARY_PATH=" + (folder / "mine").string()});
  const auto plugin = Program(words, folder.path()).finish();
  EXPECT_EQ(plugin.status, 3);
  EXPECT_THAT(plugin.err,
              AllOf(HasSubstr("written with other builds of plugins"), HasSubstr("/probe energy/build/checksum")));
  // Half of a checkpoint.
  const auto checkpoint = folder / "part/checkpoint.h5";
  std::filesystem::copy(checkpoint, folder / "whole.h5");
  std::filesystem::resize_file(checkpoint, std::filesystem::file_size(checkpoint) / 2);
  const auto half = grit({"run", "part", "--resume"});
  EXPECT_EQ(half.status, 5);
  EXPECT_THAT(half.err, AllOf(HasSubstr("part/checkpoint.h5"), HasSubstr("not a complete checkpoint")));
  EXPECT_EQ(text_of(folder / "part/run.json"), before) << "nothing was changed";
  std::filesystem::rename(folder / "whole.h5", checkpoint);
  EXPECT_EQ(grit({"run", "part", "--resume", "--no-report"}).status, 0);
}

TEST_F(Resume, NamesStagesThatAreNewMissingMovedOrChanged) {
  const std::vector<std::string> brief{"--set", "/stages/0/until/value=10", "--set", "/stages/1/until/value=10"};
  ASSERT_EQ(grit(run("done", brief)).status, 0);
  const auto refusal = [&](const std::string& set) {
    auto more = brief;
    more.insert(more.end(), {"--resume", "--set", set});
    const auto outcome = grit(run("done", more));
    EXPECT_EQ(outcome.status, 2) << set;
    return outcome.err;
  };
  const auto stage = [](const std::string& name, int steps = 10) {
    return R"({"name": ")" + name + R"(", "until": {"type": "steps", "value": )" + std::to_string(steps) +
           R"(}, "limit": "10 h"})";
  };
  const std::string why =
      "\n  --resume continues with the same stages; it cannot go on with other stages yet: run all of "
      "them from the start in another folder (--out DIR)\n  continue with its own description ('grit run "
      "--resume done'), ";
  const std::string start = "done: holds a run of another description:\n  ";
  EXPECT_THAT(refusal("/stages/-=" + stage("b")),
              HasSubstr(start + "/stages/2: the stage \"b\" is new; the run has \"fall\", \"on\"" + why));
  EXPECT_THAT(refusal("/stages=[" + stage("fall") + "]"),
              HasSubstr(start + "/stages: the stage \"on\" of the run is missing" + why));
  EXPECT_THAT(refusal("/stages=[" + stage("on") + ", " + stage("fall") + "]"),
              HasSubstr(start + "/stages: found the order \"on\", \"fall\", allowed \"fall\", \"on\"" + why));
  EXPECT_THAT(refusal("/stages=[" + stage("first") + ", " + stage("fall") + ", " + stage("on", 11) + "]"),
              HasSubstr(start +
                        "/stages/0: the stage \"first\" is new; the run has \"fall\", \"on\"\n  "
                        "/stages/2/until/value: found 11, allowed 10" +
                        why));
  const auto changed = refusal("/stages/1/limit=\"11 h\"");
  EXPECT_THAT(changed, AllOf(HasSubstr(start + "/stages/1/limit: found 39600.0, allowed 36000.0\n"),
                             Not(HasSubstr("other stages"))));
  EXPECT_THAT(refusal(R"(/engines/none={"type": "gravity", "acceleration": [0, 0, 0]})"),
              AllOf(HasSubstr(start + "/engines/none: found {\"type\":\"gravity\""),
                    HasSubstr(", which the run does not have\n"), Not(HasSubstr("other stages"))));
  EXPECT_THAT(refusal("/engines/damping=null"), HasSubstr(start + "/engines/damping: missing; the run has {"));
}

TEST_F(Resume, ReportsInvalidRequests) {
  const auto both = grit(run("part", {"--resume", "--overwrite"}));
  EXPECT_EQ(both.status, 1);
  EXPECT_THAT(both.err, HasSubstr("--resume continues results, --overwrite replaces them"));
  std::filesystem::create_directory(folder / "empty");
  std::ofstream(folder / "empty/run.json") << "{}";
  EXPECT_THAT(grit({"run", "empty"}).err,
              HasSubstr("empty is a folder of results; give a description, or continue its run"));
  EXPECT_EQ(grit({"run", "empty"}).status, 1);
  EXPECT_EQ(grit({"run", "empty", "--resume", "--out", "x"}).status, 1);
  EXPECT_EQ(grit({"run", "empty", "--resume"}).status, 5);
}

TEST_F(Resume, KeepsTheCheckpointIfAGuardTrips) {
  const auto outcome =
      grit(run("failed", {"--set", "/output/checkpoint_every=1e-6", "--set", "/guards={\"travel\": 1e-3}"}));
  EXPECT_EQ(outcome.status, 4) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "failed/checkpoint.h5"));
  const auto again = grit({"run", "failed", "--resume", "--no-report"});
  EXPECT_EQ(again.status, 4);
  EXPECT_THAT(again.err,
              AllOf(HasSubstr("/guards/travel"),
                    HasSubstr("the last checkpoint is kept: change /guards/travel, to at most 0.05, and continue with "
                              "--resume")));
}

TEST_F(Resume, ContinuesWithOtherGuards) {
  const auto whole = [&](const char* name, const std::string& guards, bool resume) {
    auto words = run(name, {"--set", "/output/checkpoint_every=1e-6", "--set", "/guards=" + guards});
    if (resume) words.push_back("--resume");
    return grit(words);
  };
  EXPECT_EQ(whole("stopped", "{\"travel\": 1e-3}", false).status, 4);
  const auto on = whole("stopped", "{\"travel\": 0.05}", true);
  EXPECT_EQ(on.status, 0) << on.err;
  EXPECT_THAT(on.err, HasSubstr("continues from step"));
  EXPECT_EQ(whole("never", "{\"travel\": 0.05}", false).status, 0);
  expect_same_results("stopped", "never");
  EXPECT_EQ(whole("deep", "{\"overlap\": 1e-3}", false).status, 4);
  const auto deeper = whole("deep", "{\"overlap\": 0.4}", true);
  EXPECT_EQ(deeper.status, 0) << deeper.err;
  EXPECT_THAT(deeper.err, HasSubstr("continues from step"));
  expect_same_results("deep", "never");
  // A completed run met its own guards, not others.
  const auto done = whole("stopped", "{\"travel\": 0.04}", true);
  EXPECT_EQ(done.status, 2);
  EXPECT_THAT(done.err, HasSubstr("/guards/travel: found 0.04, allowed 0.05"));
}

TEST_F(Resume, GoesOnWithTheGuardThatItsAdviceNames) {
  const auto stopped = [&](const char* name, std::vector<std::string> sets) {
    sets.insert(sets.begin(), {"/output/checkpoint_every=1e-6", "/stages/0/until/value=40000",
                               "/stages/1/until/value=2000", "/guards/travel=1e-3"});
    std::vector<std::string> more;
    for (const auto& set : sets) more.insert(more.end(), {"--set", set});
    const auto outcome = grit(run(name, more));
    EXPECT_EQ(outcome.status, 4) << name << outcome.err;
    return outcome.err;
  };
  const auto on = [&](const char* name, const char* set) { return grit({"run", "--resume", name, "--set", set}); };
  EXPECT_THAT(stopped("usual", {}), HasSubstr("change /guards/travel, to at most 0.05, and continue with --resume"));
  const auto above = on("usual", "/guards/travel=0.1");
  EXPECT_EQ(above.status, 2);
  EXPECT_THAT(above.err, AllOf(HasSubstr("/guards/travel: found 0.1, allowed 0.001"),
                               HasSubstr("above 0.05, /guards/travel also sets the time step")));
  EXPECT_EQ(on("usual", "/guards/travel=0.05").status, 0);
  EXPECT_THAT(stopped("limited", {"/time_step/max_displacement=0.04"}),
              HasSubstr("change /guards/travel and continue with --resume"));
  EXPECT_EQ(on("limited", "/guards/travel=0.1").status, 0);
  EXPECT_THAT(stopped("deep", {"/guards/travel=0.05", "/guards/overlap=1e-3"}),
              HasSubstr("change /guards/overlap and continue with --resume"));
  EXPECT_EQ(on("deep", "/guards/overlap=0.2").status, 0);
  EXPECT_THAT(stopped("staged", {R"(/stages/0/change={"guards": {"travel": 1e-3}})"}),
              HasSubstr("--resume cannot go on with another /guards/travel, as it is set by a stage"));
}

}  // namespace
}  // namespace grit
