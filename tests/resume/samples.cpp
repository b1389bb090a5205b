// Runs that begin from a prepared sample: the state of another run.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>
#include <utility>

#include "output/read_frames.hpp"
#include "output/read_results.hpp"
#include "storage/frame_state.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

/// Grains in a box under a lid that presses on them.
constexpr auto prepare = R"({
  "title": "a sample under a lid",
  "contacts": {"type": "linear-rolling"},
  "materials": {"sand": {"density": 2600, "contact_modulus": "10 MPa", "friction_angle": "30 deg", "rolling_stiffness": 0.3, "rolling_limit": 0.2}},
  "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
    "type": "cloud", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "20 mm"], "count": 80,
    "sizes": {"type": "uniform", "smallest": "2 mm", "largest": "2.5 mm"}}}},
  "walls": {
    "box": {"type": "box", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "30 mm"], "open": ["z_high"], "material": "sand"},
    "lid": {"type": "plane", "point": [0, 0, "25 mm"], "normal": [0, 0, -1], "area": "1e-4 m^2", "material": "sand",
            "motion": {"servo": {"pressure": "10 kPa", "max_velocity": "0.5 m/s"}}}},
  "engines": {"gravity": {"type": "gravity"}, "damping": {"type": "local-damping", "coefficient": 0.3}},
  "stages": [{"name": "press", "until": {"type": "all", "of": [{"type": "at-rest", "below": 1e-6}, {"type": "pressure", "wall": "lid", "value": "10 kPa", "within": 1e-3}]}, "limit": "4 s"}],
  "probes": {"walls": {"type": "walls", "every_time": "1 ms"}, "packing": {"type": "packing", "every_time": "1 ms"},
             "energy": {"type": "energy", "every_time": "1 ms"}}
}
)";

/// What a test after it has in common.
constexpr auto go_on = R"({
  "extends": "prepare.json",
  "begin": {"from": "sample"},
  "bodies": {"grains": {"source": {"type": "sample", "low": null, "high": null, "count": null, "sizes": null}}},
  "stages": [{"name": "test", "until": {"type": "time", "value": "5 ms"}, "limit": "1 s"}]
}
)";

/// Clumps in a periodic cell that strains, under a paddle that turns.
constexpr auto stir = R"({
  "title": "rods under a paddle",
  "contacts": {"type": "linear-rolling"},
  "materials": {"sand": {"density": 2600, "contact_modulus": "10 MPa", "friction_angle": "30 deg"}},
  "domain": {"low": [0, 0, "-1 mm"], "high": ["20 mm", "20 mm", "30 mm"], "periodic": [true, true, false], "strain_rate": [-1, 0, 0]},
  "bodies": {
    "balls": {"type": "sphere", "material": "sand", "source": {"type": "list", "bodies": [
      {"position": ["5 mm", "5 mm", "16.5 mm"], "radius": "1 mm", "velocity": [0.1, 0, 0], "spin": [0, 30, 0]}]}},
    "rods": {"type": "clump", "material": "sand", "shape": {"type": "rod"}, "source": {
      "type": "cloud", "low": [0, 0, 0], "high": ["20 mm", "20 mm", "15 mm"], "count": 80,
      "sizes": {"type": "uniform", "smallest": "3 mm", "largest": "4 mm"}}}},
  "walls": {
    "floor": {"type": "plane", "material": "sand"},
    "paddle": {"type": "plane", "point": ["10 mm", "10 mm", "20 mm"], "normal": [0, 0, -1], "extent": "4 mm", "material": "sand",
               "motion": {"velocity": [0, 0, 0.1], "spin": [20, 0, 5]}}},
  "engines": {"gravity": {"type": "gravity"}},
  "stages": [{"name": "stir", "until": {"type": "time", "value": "30 ms"}, "limit": "1 s"}],
  "output": {"frames": {"every_time": "10 ms"}}
}
)";
constexpr auto stir_on = R"({
  "extends": "stir.json",
  "begin": {"from": "stirred", "at": "frame", "frame": 2},
  "bodies": {
    "balls": {"source": {"type": "sample", "bodies": null}},
    "rods": {"source": {"type": "sample", "low": null, "high": null, "count": null, "sizes": null}}},
  "stages": [{"name": "on", "until": {"type": "time", "value": "10 ms"}, "limit": "1 s"}]
}
)";

/// Grains in a periodic cell that shears and shrinks.
constexpr auto shear = R"({
  "title": "simple shear of a periodic cell",
  "contacts": {"type": "linear-rolling"},
  "materials": {"sand": {"density": 2600, "contact_modulus": "10 MPa", "friction_angle": "30 deg"}},
  "domain": {"low": [0, 0, 0], "high": ["10 mm", "10 mm", "10 mm"], "periodic": [true, true, true],
             "shear_rate": {"xy": 20, "yz": -10}, "strain_rate": [-4, -4, -4]},
  "bodies": {"grains": {"type": "sphere", "material": "sand", "source": {
    "type": "cloud", "low": [0, 0, 0], "high": ["10 mm", "10 mm", "10 mm"], "count": 55,
    "sizes": {"type": "uniform", "smallest": "2 mm", "largest": "2.5 mm"}}}},
  "stages": [{"name": "shear", "until": {"type": "time", "value": "40 ms"}, "limit": "1 s"}],
  "output": {"frames": {"every_time": "10 ms"}}
}
)";
constexpr auto shear_on = R"({
  "extends": "shear.json",
  "begin": {"from": "sheared", "at": "frame", "frame": 4},
  "bodies": {"grains": {"source": {"type": "sample", "low": null, "high": null, "count": null, "sizes": null}}},
  "stages": [{"name": "on", "until": {"type": "time", "value": "4 ms"}, "limit": "1 s"}],
  "output": {"frames": {"every_time": "4 ms"}}
}
)";

class Samples : public testing::Test {
 protected:
  Samples() { folder.write("prepare.json", prepare), folder.write("test.json", go_on); }
  Outcome grit(std::vector<std::string> words) const { return grit_in(folder.path(), std::move(words)); }
  Outcome run(const std::string& file, const std::string& out, const std::vector<std::string>& sets = {}) const {
    std::vector<std::string> words{"run", file, "--no-report", "--quiet", "--overwrite", "--out", out};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    return grit(words);
  }
  void prepare_sample() const {
    const auto prepared = run("prepare.json", "sample");
    ASSERT_EQ(prepared.status, 0) << prepared.err;
    ASSERT_TRUE(std::filesystem::exists(folder / "sample/final.h5"));
  }
  /// A test from the sample must be refused with these messages.
  void refuses(const std::vector<std::string>& sets, const testing::Matcher<const std::string&>& message,
               const std::string& file = "test.json") const {
    const auto refused = run(file, "refused", sets);
    EXPECT_EQ(refused.status, 2) << refused.out;
    EXPECT_THAT(refused.err, message);
    EXPECT_FALSE(std::filesystem::exists(folder / "refused"));
  }
  std::vector<double> series(const std::string& out, const std::string& channel) const {
    return SeriesFile(folder / out).channel(channel).values;
  }
  /// The run "test" begins with the contacts at the end of "sample", and stays at rest.
  void expect_same_contacts() const {
    const double pressure = series("sample", "walls/lid_pressure").back();
    ASSERT_NEAR(pressure, 1e4, 10);
    EXPECT_NEAR(series("test", "walls/lid_pressure").front(), pressure, 1e-6 * pressure);
    for (const char* contacts : {"packing/coordination_number", "packing/mean_contact_force"})
      EXPECT_NEAR(series("test", contacts).front(), series("sample", contacts).back(),
                  1e-9 * series("sample", contacts).back());
    for (const char* energy : {"energy/elastic_normal", "energy/elastic_shear", "energy/elastic_rolling"}) {
      ASSERT_GT(series("sample", energy).back(), 0);
      EXPECT_NEAR(series("test", energy).front(), series("sample", energy).back(),
                  1e-6 * series("sample", energy).back())
          << energy;
    }
    // No spring was lost.
    const auto kinetic = series("test", "energy/kinetic");
    EXPECT_LT(*std::ranges::max_element(kinetic), 1e-4 * series("test", "energy/elastic_normal").front());
  }

  OwnFolder folder;
};

TEST_F(Samples, GoOnAtTheSameStress) {
  prepare_sample();
  const auto test = run("test.json", "test");
  ASSERT_EQ(test.status, 0) << test.err;
  expect_same_contacts();
  const auto positions = series("test", "walls/lid_position"), before = series("sample", "walls/lid_position");
  EXPECT_NEAR(positions.front() + positions[2], before[before.size() - 3] + before.back(), 1e-9);
  EXPECT_NEAR(positions.back(), before.back(), 1e-7);
}

TEST_F(Samples, DroppedSpringsMoveGrains) {
  prepare_sample();
  ASSERT_EQ(run("test.json", "test", {"/begin/springs=drop"}).status, 0);
  EXPECT_EQ(series("test", "energy/elastic_shear").front(), 0);
  EXPECT_GT(series("test", "energy/elastic_normal").front(), 0);
}

/// A checkpoint suffices to resume: the sample may have been removed.
TEST_F(Samples, AreNotNeededToResume) {
  prepare_sample();
  const std::vector<std::string> words{"run",
                                       "test.json",
                                       "--no-report",
                                       "--set",
                                       R"(/stages/0/until={"type": "steps", "value": 60000})",
                                       "--set",
                                       "/stages/0/limit=1 h",
                                       "--set",
                                       R"(/output={"frames": {"every_steps": 2000}})",
                                       "--out"};
  const auto to = [&](const std::string& out) {
    auto all = words;
    all.push_back(out);
    return all;
  };
  ASSERT_EQ(grit(to("whole")).status, 0);
  {
    Program program(grit_with(to("part")), folder.path());
    Outcome outcome;
    ASSERT_NO_FATAL_FAILURE(interrupt_after(program, folder / "part/frames/000001.h5", outcome));
  }
  std::filesystem::remove_all(folder / "sample");
  const auto rest = grit({"run", "part", "--resume", "--no-report"});
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr("80 bodies, "));
  for (const std::string& channel : SeriesFile(folder / "whole").channels()) {
    const auto resumed = series("part", channel), whole = series("whole", channel);
    ASSERT_EQ(resumed.size(), whole.size()) << channel;
    EXPECT_EQ(std::memcmp(resumed.data(), whole.data(), whole.size() * sizeof(double)), 0) << channel;
  }
  EXPECT_EQ(text_of(folder / "part/packing.txt"), text_of(folder / "whole/packing.txt"));
}

TEST_F(Samples, MayBeACheckpoint) {
  const auto failed = run("prepare.json", "sample", {"/stages/0/limit=20 ms"});
  ASSERT_EQ(failed.status, 4) << failed.err;
  refuses({}, HasSubstr("holds no final.h5"));

  auto stages = json::parse(prepare).at("stages");
  stages.push_back({{"name", "stay"}, {"until", {{"type", "steps"}, {"value", 10000000}}}, {"limit", "10 h"}});
  {
    Program program(grit_with({"run", "prepare.json", "--no-report", "--overwrite", "--out", "sample", "--set",
                               "/stages=" + stages.dump(), "--set", R"(/output={"frames": {"every_steps": 2000}})"}),
                    folder.path());
    ASSERT_TRUE(program.wait_for("stage \"press\" ended"));
    program.interrupt();
    const auto outcome = program.finish();
    ASSERT_EQ(outcome.status, 130) << outcome.err;
  }
  refuses({}, HasSubstr("begin at its last checkpoint with \"at\": \"checkpoint\""));
  const auto test = run("test.json", "test", {"/begin/at=checkpoint"});
  ASSERT_EQ(test.status, 0) << test.err;
  expect_same_contacts();
}

/// The end of a sample has positions and velocities of one instant, also of clumps and in a cell that deforms. A last
/// stage of one step begins with a neighbour search: bodies that a search moves by a period change their velocity.
TEST_F(Samples, MoveOnWithTheSameEnergies) {
  folder.write("stir.json", stir), folder.write("stir_on.json", stir_on);
  folder.write("shear.json", shear), folder.write("shear_on.json", shear_on);
  const std::string
      energy = R"(/probes/energy={"type": "energy", "every_time": "1 ms"})",
      sink =
          R"(/engines/sink={"type": "sink", "region": {"type": "half-space", "point": [0, 0, -1], "normal": [0, 0, 1]}})";
  for (const auto& [name, text, until] : {std::tuple("stir", stir, "60 ms"), std::tuple("shear", shear, "40 ms")}) {
    SCOPED_TRACE(name);
    auto stages = json::parse(text).at("stages");
    stages[0]["until"]["value"] = until;
    stages.push_back({{"name", "sort"}, {"until", {{"type", "steps"}, {"value", 1}}}, {"limit", "1 s"}});
    const auto before = run(name + std::string(".json"), "before", {energy, sink, "/stages=" + stages.dump()});
    ASSERT_EQ(before.status, 0) << before.err;
    const auto expect_energies = [&](const std::vector<std::string>& sets, double kinetic, double normal,
                                     double shear) {
      std::vector<std::string> all{energy, "/begin/from=before", "/begin/at=end", "/begin/frame=-1"};
      all.insert(all.end(), sets.begin(), sets.end());
      const auto on = run(name + std::string("_on.json"), "on", all);
      ASSERT_EQ(on.status, 0) << on.err;
      for (const auto& [channel, factor] :
           {std::pair("energy/kinetic", kinetic), std::pair("energy/elastic_normal", normal),
            std::pair("energy/elastic_shear", shear)}) {
        const double wanted = factor * series("before", channel).back();
        ASSERT_GT(wanted, 0);
        EXPECT_NEAR(series("on", channel).front(), wanted, 1e-12 * wanted) << channel;
      }
    };
    expect_energies({}, 1, 1, 1);
    expect_energies({"/materials/sand/density=5200"}, 2, 1, 1);
    // Overlaps and shear forces are kept.
    expect_energies({"/materials/sand/contact_modulus=20 MPa"}, 1, 2, 0.5);
  }
}

TEST_F(Samples, MayBeAFrame) {
  const auto prepared =
      run("prepare.json", "sample", {R"(/output={"frames": {"every_time": "5 ms"}})", "/stages/0/limit=40 ms"});
  ASSERT_EQ(prepared.status, 4) << prepared.err;
  const auto begin = [&](const std::vector<std::string>& sets) {
    std::vector<std::string> words{"run", "test.json", "--no-report", "--overwrite", "--out", "test"};
    for (const char* set : {"/begin/at=frame", R"(/output={"frames": {"every_time": "1 ms"}})"})
      words.insert(words.end(), {"--set", set});
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto test = grit(words);
    EXPECT_EQ(test.status, 0) << test.err;
    EXPECT_THAT(test.err, HasSubstr("; frames hold no contact springs, which start at zero"));
    return test.err;
  };
  EXPECT_THAT(begin({"/begin/frame=5"}), HasSubstr("begins from frame 5 of "));
  const auto checked = grit({"check", "test.json", "--set", "/begin/at=frame", "--set", "/begin/frame=5"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_THAT(checked.out, ContainsRegex("sample\n  begins from frame 5 of .*; frames hold no contact springs"));
  const Frame before = read_frame(folder / "sample/frames/000005.h5"),
              after = read_frame(folder / "test/frames/000000.h5");
  EXPECT_EQ(after.time, 0);
  EXPECT_EQ(after.id, before.id);
  EXPECT_EQ(after.position, before.position);
  EXPECT_EQ(after.radius, before.radius);
  EXPECT_EQ(after.velocity, before.velocity);
  ASSERT_EQ(after.walls.size(), before.walls.size());
  for (std::size_t i = 0; i < after.walls.size(); ++i)
    EXPECT_EQ(after.walls[i].displacement, before.walls[i].displacement);
  EXPECT_LT(after.walls.back().displacement.z(), 0) << "of the lid";
  EXPECT_EQ(series("test", "energy/elastic_shear").front(), 0);

  EXPECT_THAT(begin({"/begin/time=26 ms"}), HasSubstr("begins from frame 5 of ")) << "the nearest";
  const auto last = frame_files(folder / "sample").size() - 1;
  EXPECT_THAT(begin({}), HasSubstr("begins from frame " + std::to_string(last) + " of "));
  std::filesystem::remove(folder / "sample/frames/000003.h5");
  EXPECT_THAT(begin({}), HasSubstr("begins from frame " + std::to_string(last) + " of ")) << "behind a gap";
}

TEST_F(Samples, FramesHoldClumpsWallsAndTheCell) {
  folder.write("stir.json", stir), folder.write("on.json", stir_on);
  const auto stirred = run("stir.json", "stirred");
  ASSERT_EQ(stirred.status, 0) << stirred.err;
  const auto on = run("on.json", "on");
  ASSERT_EQ(on.status, 0) << on.err;
  const FrameState before = read_frame_state(folder / "stirred/frames/000002.h5"),
                   after = read_frame_state(folder / "on/frames/000000.h5");
  EXPECT_EQ(after.groups, before.groups);
  EXPECT_EQ(after.cell_low, before.cell_low);
  EXPECT_EQ(after.cell_high, before.cell_high);
  EXPECT_EQ(after.strain_rate, before.strain_rate);
  ASSERT_LT(before.cell_high.x() - before.cell_low.x(), 0.0197);

  // A neighbour search moves bodies into the cell, by whole periods.
  const Vec3 period = after.cell_high - after.cell_low;
  const auto distance = [&](const Vec3& a, const Vec3& b) {
    Vec3 d = a - b;
    for (int k = 0; k < 2; ++k) d[k] -= period[k] * std::round(d[k] / period[k]);
    return d.norm();
  };
  constexpr double rounding = 1e-14;  // m
  ASSERT_EQ(after.bodies.size(), before.bodies.size());
  for (std::size_t i = 0; i < after.bodies.size(); ++i) {
    const FrameBody &now = after.bodies[i], &then = before.bodies[i];
    EXPECT_EQ(now.id, then.id);
    EXPECT_EQ(now.group, then.group);
    EXPECT_EQ(now.clump, then.clump);
    EXPECT_EQ(now.radius, then.radius);
    EXPECT_LE(distance(now.position, then.position), rounding) << i;
  }
  EXPECT_EQ(after.bodies.front().spin, before.bodies.front().spin) << "of a single ball";
  ASSERT_EQ(after.clumps.size(), 80u);
  ASSERT_EQ(before.clumps.size(), 80u);
  double most_turned = 0;
  for (std::size_t i = 0; i < 80; ++i) {
    const FrameClump &now = after.clumps[i], &then = before.clumps[i];
    EXPECT_EQ(now.id, then.id);
    EXPECT_EQ(now.radius, then.radius);
    EXPECT_LE(distance(now.centre, then.centre), rounding);
    EXPECT_LE((now.orientation.toRotationMatrix() - then.orientation.toRotationMatrix()).norm(), 1e-13);
    EXPECT_LE((now.spin - then.spin).norm(), 1e-9 * (1 + then.spin.norm()));
    if (now.centre == then.centre) EXPECT_EQ(now.velocity, then.velocity);
    most_turned = std::max(most_turned, then.spin.norm());
  }
  EXPECT_GT(most_turned, 1) << "rods that only fall would show little";
  ASSERT_EQ(after.walls.size(), 2u);
  for (std::size_t w = 0; w < 2; ++w) {
    EXPECT_EQ(after.walls[w].name, before.walls[w].name);
    EXPECT_EQ(after.walls[w].pose.shift, before.walls[w].pose.shift);
    EXPECT_LE((after.walls[w].pose.turn - before.walls[w].pose.turn).norm(), 1e-14);
  }
  EXPECT_TRUE(before.walls[1].pose.turned());
  EXPECT_NEAR(before.walls[1].pose.shift.z(), 2e-3, 1e-4);

  refuses({"/bodies/rods/type=sphere", "/bodies/rods/shape=null"},
          AllOf(HasSubstr("/bodies/rods"), HasSubstr("has clumps of 2 spheres, here it has single spheres")),
          "on.json");
  refuses({"/bodies/balls/type=clump", R"(/bodies/balls/shape={"type": "rod"})"},
          AllOf(HasSubstr("/bodies/balls"),
                HasSubstr("has single spheres, here it has clumps of 2 spheres; use the type and "
                          "shape of the sample")),
          "on.json");
  refuses({"/bodies/rods/shape/spacing=0.9"},
          AllOf(HasSubstr("/bodies/rods"), HasSubstr("has clumps of 2 spheres, here it has others")), "on.json");
}

TEST_F(Samples, HaveTheMassesOfTheScene) {
  const std::string
      mass =
          R"(/probes/sum={"type": "formula", "every_time": "1 ms", "curves": {"m": {"formula": "mass", "unit": "kg", "doc": "mass of all"}}})",
      brief = R"(/stages/0/until={"type": "time", "value": "2 ms"})",
      frames = R"(/output={"frames": {"every_time": "1 ms"}})",
      scaled = R"(/engines/scaling={"type": "density-scaling", "below": 3e-3})";
  const auto mass_of = [&](const std::string& file, const std::string& out, std::vector<std::string> sets) {
    sets.insert(sets.end(), {mass, brief});
    const auto one = run(file, out, sets);
    EXPECT_EQ(one.status, 0) << one.err;
    return one.status == 0 ? series(out, "sum/m").front() : 0;
  };
  const double plain = mass_of("prepare.json", "sample", {frames}),
               of_scaled = mass_of("prepare.json", "scaled", {frames, scaled});
  EXPECT_NEAR(of_scaled, plain, 1e-12 * plain) << "without density scaling";
  for (const char* at : {"end", "frame"}) {
    SCOPED_TRACE(at);
    const std::string begin = std::string("/begin/at=") + at;
    const auto expect_begun = [&](double expected, std::vector<std::string> sets) {
      sets.push_back(begin);
      EXPECT_NEAR(mass_of("test.json", "test", std::move(sets)), expected, 1e-12 * expected);
    };
    expect_begun(plain, {});
    expect_begun(2 * plain, {"/materials/sand/density=5200"});
    expect_begun(plain, {scaled});
    expect_begun(plain, {"/begin/from=scaled", scaled});
    expect_begun(plain, {"/begin/from=scaled"});
  }
}

TEST_F(Samples, HaveTheShapesOfTheScene) {
  folder.write("stir.json", stir), folder.write("on.json", stir_on);
  const std::string brief = "/stages/0/until/value=10 ms", last = "/begin/frame=-1";
  const auto refuses_at_any = [&](const std::string& change, const std::string& message) {
    for (const char* at : {"end", "frame"}) {
      SCOPED_TRACE(at);
      refuses({last, std::string("/begin/at=") + at, change}, AllOf(HasSubstr("/bodies/rods"), HasSubstr(message)),
              "on.json");
    }
  };
  ASSERT_EQ(run("stir.json", "stirred", {brief}).status, 0);
  refuses_at_any("/bodies/rods/shape/count=3", "has clumps of 2 spheres, here it has clumps of 3 spheres");
  refuses_at_any("/bodies/rods/shape/spacing=0.9", "has clumps of 2 spheres, here it has others");

  // Spheres of the same sizes at other places.
  const auto bent = [](const std::string& y) {
    return R"(/bodies/rods/shape={"type": "list", "spheres": [{"position": [0, 0, 0], "radius": 1},
              {"position": [1, )" +
           y + R"(, 0], "radius": 1}, {"position": [2, 0, 0], "radius": 1}]})";
  };
  ASSERT_EQ(run("stir.json", "stirred", {brief, bent("0.1")}).status, 0);
  refuses_at_any(bent("-0.4"), "has clumps of 3 spheres, here it has others");
  for (const char* at : {"end", "frame"}) {
    const auto on = run("on.json", "on", {last, std::string("/begin/at=") + at, bent("0.1")});
    EXPECT_EQ(on.status, 0) << on.err;
  }

  prepare_sample();
  refuses(
      {"/bodies/grains/type=clump", R"(/bodies/grains/shape={"type": "rod"})"},
      AllOf(HasSubstr("/bodies/grains"),
            HasSubstr("has single spheres, here it has clumps of 2 spheres; use the type and shape of the sample")));
}

TEST_F(Samples, FramesHoldTheTiltOfACellThatShears) {
  folder.write("shear.json", shear), folder.write("on.json", shear_on);
  const auto sheared = run("shear.json", "sheared");
  ASSERT_EQ(sheared.status, 0) << sheared.err;
  const auto on = run("on.json", "on");
  ASSERT_EQ(on.status, 0) << on.err;
  const auto path_before = folder / "sheared/frames/000004.h5", path_after = folder / "on/frames/000000.h5";
  const FrameState before = read_frame_state(path_before), after = read_frame_state(path_after);
  ASSERT_LT(before.tilt.x(), -1e-3) << "after the tilt of 8 mm was reduced by a period";
  ASSERT_LT(before.tilt.y(), -1e-3) << "shear along both others moves images along this";
  ASSERT_LT(before.tilt.z(), -3e-3);
  EXPECT_EQ(after.tilt, before.tilt);
  EXPECT_EQ(after.shear_rate, before.shear_rate);
  EXPECT_EQ(after.strain_rate, before.strain_rate);
  EXPECT_EQ(after.cell_low, before.cell_low);
  EXPECT_EQ(after.cell_high, before.cell_high);

  Cell cell{before.cell_low, before.cell_high, {true, true, true}};
  cell.tilt = before.tilt;
  const Vec3 middle = 0.5 * (cell.low + cell.high);
  ASSERT_EQ(after.bodies.size(), 55u);
  ASSERT_EQ(before.bodies.size(), 55u);
  std::size_t unmoved = 0;
  for (std::size_t i = 0; i < 55; ++i) {
    const FrameBody &now = after.bodies[i], &then = before.bodies[i];
    EXPECT_EQ(now.id, then.id);
    EXPECT_EQ(now.radius, then.radius);
    EXPECT_EQ(now.spin, then.spin);
    // A neighbour search may have moved it into the cell, by whole periods of the skewed cell.
    EXPECT_LE((cell.inside(middle + now.position - then.position) - middle).norm(), 1e-14) << i;  // m
    if (now.position != then.position) continue;
    EXPECT_EQ(now.velocity, then.velocity);
    ++unmoved;
  }
  EXPECT_GT(unmoved, 40u);

  // Contacts across the skewed sides are the same, in another order.
  const auto forces = [](const std::filesystem::path& path) {
    std::vector<double> all = read_frame(path).normal_force;
    std::ranges::sort(all);
    return all;
  };
  ASSERT_GT(forces(path_before).size(), 60u);
  EXPECT_THAT(forces(path_after),
              testing::Pointwise(testing::DoubleNear(1e-9), forces(path_before)));  // N, of up to 0.6

  // The shear goes on: tilts over side lengths grow by the shear, whatever the isotropic strain.
  const auto path_end = folder / "on/frames/000001.h5";
  const FrameState end = read_frame_state(path_end);
  const double time = time_of_frame(path_end), length = end.cell_high.x() - end.cell_low.x(),
               length_before = before.cell_high.x() - before.cell_low.x();
  EXPECT_NEAR(end.tilt.x() / length - before.tilt.x() / length_before, 20 * time, 1e-4);
  EXPECT_NEAR(end.tilt.z() / length - before.tilt.z() / length_before, -10 * time, 1e-4);
}

TEST_F(Samples, SayWhichFramesThereAre) {
  ASSERT_EQ(
      run("prepare.json", "sample", {R"(/output={"frames": {"every_time": "10 ms"}})", "/stages/0/limit=25 ms"}).status,
      4);
  refuses({"/begin/at=frame", "/begin/frame=99"},
          AllOf(HasSubstr("/begin/frame"), HasSubstr("has no frame 99; its frames are 0 to ")));
  refuses({"/begin/frame=1"},
          AllOf(HasSubstr("/begin/at"),
                HasSubstr("found \"end\" with the number of a frame; allowed is \"at\": \"frame\"")));
  refuses(
      {"/begin/at=frame", "/begin/frame=1", "/begin/time=10 ms"},
      AllOf(HasSubstr("/begin/time"), HasSubstr("found the number and the time of a frame; allowed is one of them")));
  std::filesystem::remove(folder / "sample/frames/000001.h5");
  refuses({"/begin/at=frame", "/begin/frame=1"}, HasSubstr("has no frame 1; its frames are 0, 2"));
  std::filesystem::remove_all(folder / "sample/frames");
  refuses({"/begin/at=frame"}, AllOf(HasSubstr("/begin/from"), HasSubstr("holds no frames")));
}

TEST_F(Samples, MayChangeMaterialsWallsAndStages) {
  prepare_sample();
  const auto test =
      run("test.json", "test",
          {R"(/materials/steel={"density": 7800, "contact_modulus": "20 MPa"})", "/walls/box/material=steel",
           R"(/walls/post={"type": "plane", "point": [0, 0, "-1 mm"], "material": "steel"})",
           "/walls/lid/motion/servo/pressure=20 kPa", "/stages/0/until/value=20 ms"});
  ASSERT_EQ(test.status, 0) << test.err;
  EXPECT_NEAR(series("test", "walls/lid_pressure").back(), 2e4, 200);
  // Others may be added; they keep clear of the sample.
  const auto more =
      run("test.json", "more", {R"(/bodies/more={"type": "sphere", "material": "sand", "source": {"type": "list",
                            "bodies": [{"position": ["50 mm", "5 mm", "5 mm"], "radius": "1 mm"}]}})"});
  ASSERT_EQ(more.status, 0) << more.err;
  EXPECT_EQ(json::parse(text_of(folder / "more/run.json")).at("bodies"), 81);
}

TEST_F(Samples, SayWhatCannotBeTakenOver) {
  prepare_sample();
  refuses({"/begin/from=nothing"},
          AllOf(HasSubstr("/begin/from"), HasSubstr("nothing: is not a folder; name the folder of results")));
  refuses({"/begin/at=checkpoint"}, HasSubstr("begin at its end with \"at\": \"end\""));
  refuses({"/contacts/type=linear-frictional", "/materials/sand/rolling_stiffness=null",
           "/materials/sand/rolling_limit=null"},
          AllOf(HasSubstr("/contacts"),
                HasSubstr(" store rolling_x, rolling_y, rolling_z, which the contact law \"linear-frictional\" "
                          "does not store with these materials"),
                HasSubstr("\"springs\": \"drop\"")));
  refuses({R"(/domain={"low": [0, 0, 0], "high": [0.01, 0.01, 0.03], "periodic": [true, true, false]})"},
          AllOf(HasSubstr("/domain/periodic"), HasSubstr("is periodic along ")));
  refuses({R"(/bodies/others={"type": "sphere", "material": "sand", "source": {"type": "sample"}})"},
          AllOf(HasSubstr("/bodies/others"), HasSubstr("has no group of this name; it has \"grains\"")));
  refuses(
      {"/bodies/grains=null", R"(/bodies/others={"type": "sphere", "material": "sand", "source": {"type": "sample"}})"},
      HasSubstr("has a group \"grains\", which is not described"));
  refuses({"/bodies/grains/velocity=[1, 0, 0]"},
          AllOf(HasSubstr("/bodies/grains/velocity"),
                HasSubstr("found a velocity of bodies that come from a sample; allowed is none")));
  refuses({"/bodies/grains/overlap=0.1"}, AllOf(HasSubstr("/bodies/grains/overlap"), HasSubstr("remove overlap")));
  refuses({"/begin=null"}, AllOf(HasSubstr("/bodies/grains/source"), HasSubstr("without /begin")));
}

}  // namespace
}  // namespace grit
