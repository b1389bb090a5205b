// A run that was stopped at any step and resumed gives the same bits as an uninterrupted one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "grit/error.hpp"
#include "support/clump.hpp"
#include "support/packing.hpp"
#include "support/tape.hpp"

namespace grit::test::checkpoint_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const Description sand{{"contact_modulus", 1e6}, {"density", 2600}};
const double spacing = 1e-3;

Description steps(int n) { return {{"type", "steps"}, {"value", n}}; }
Description stage(const char* name, const Description& until) {
  return {{"name", name}, {"until", until}, {"limit", 10}};
}
void report(Description& d, int every) {
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  d["output"]["frames"] = {{"every_steps", 10 * every}};
  d["probes"]["packing"] = {{"type", "packing"}, {"every_steps", every}};
  d["probes"]["force-chains"] = {{"type", "force-chains"}, {"every_steps", 3 * every}};
}

/// 1728 grains, seven chunks of them, in a cell that is sheared by stretching; the mean flow changes with the stage.
Description cell() {
  Description d = description("linear-rolling", sand, jumble({12, 12, 12}, spacing, 0.02, 6));
  d["domain"] = {{"low", {0, 0, 0}},
                 {"high", {12 * spacing, 12 * spacing, 12 * spacing}},
                 {"periodic", {true, true, true}},
                 {"strain_rate", {-20, -20, 15}}};
  d["stages"] = {stage("fast", steps(150)), stage("slow", steps(160))};
  report(d, 11);
  d["probes"]["energy"] = {{"type", "energy"}, {"every_steps", 11}};
  return d;
}

/// The same under prescribed stresses, of which one changes, then at a strain rate along one axis.
Description cell_under_stress() {
  Description d = cell();
  d["stages"] = {stage("fast", steps(400)), stage("slow", steps(1000))};
  d["domain"].erase("strain_rate");
  d["domain"]["servo"] = {
      {"stress", {{"xx", 1e4}, {"yy", 1e4}, {"zz", 1e4}}}, {"max_strain_rate", 50}, {"interval", 3}};
  d["stages"][0]["ramps"] = {
      {{"pointer", "/domain/servo/stress/zz"}, {"from", 1e4}, {"to", 2e4}, {"duration", 2e-3}, {"increments", 40}}};
  d["stages"][1]["change"]["domain"] = {{"servo", {{"stress", {{"zz", nullptr}}}}}, {"strain_rate", {0, 0, -20}}};
  return d;
}

/// The same sheared, first at a rate, then by a stress, with clumps.
Description sheared_cell() {
  Description d = cell();
  make_clumps(d, boomerang());
  d["domain"].erase("strain_rate");
  d["domain"]["shear_rate"] = {{"xz", 300}, {"xy", -200}};
  d["domain"]["servo"] = {{"stress", {{"zz", 1e4}}}, {"max_strain_rate", 50}, {"interval", 3}};
  d["stages"][1]["change"]["domain"] = {{"shear_rate", {{"xz", nullptr}}}, {"servo", {{"stress", {{"xz", -3e3}}}}}};
  return d;
}

Description box(const std::string& law, const std::array<int, 3>& sides, std::uint64_t seed) {
  const Vec3 low = Vec3::Zero(), high = spacing * Vec3(sides[0], sides[1], sides[2]);
  Description d = description(law, sand, jumble(sides, spacing, 0.02, seed));
  const char* const names[3][2] = {{"left", "right"}, {"front", "back"}, {"bottom", "lid"}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][names[axis][up ? 0 : 1]] = side(axis, up ? low[axis] : high[axis], low, high, up);
  d["walls"]["lid"]["motion"]["servo"] = {{"axis", "z"}, {"pressure", 1e4}, {"max_velocity", 0.5}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.3}};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  report(d, 13);
  return d;
}

/// A lid with increasing pressure, then a sliding bottom, with the energy balance.
Description servo(const std::string& law = "linear-rolling") {
  Description d = box(law, {10, 8, 9}, 5);
  d["stages"] = {stage("press", steps(170)), stage("slide", {{"type", "time"}, {"value", 0.2e-3}})};
  d["stages"][0]["ramps"] = {{{"pointer", "/walls/lid/motion/servo/pressure"},
                              {"from", 1e4},
                              {"to", 2e4},
                              {"duration", 1e-3},
                              {"increments", 50}}};
  d["stages"][1]["until"]["value"] = 1e-3;
  d["stages"][1]["change"]["walls"]["bottom"]["motion"]["velocity"] = {0.3, 0, 0};
  d["probes"]["energy"] = {{"type", "energy"}, {"every_steps", 10}};
  d["probes"]["walls"] = {{"type", "walls"}, {"every_time", 2e-5}};
  return d;
}
/// A lid so fast for its pressure that it has to brake before contact.
Description braking() {
  Description d = servo();
  auto& height = d["walls"]["lid"]["corner"][2];
  height = height.get<double>() + 0.2 * spacing;
  d["stages"][0]["ramps"][0]["from"] = 100;
  return d;
}
/// Springs whose stiffness, and with it the time step, follows the overlaps.
Description stiffening() {
  Description d = servo("hertz-mindlin");
  d["materials"]["grain"] = {{"density", 2600}, {"young_modulus", 1e7}, {"poisson_ratio", 0.2}, {"restitution", 0.5}};
  return d;
}
/// Grains that attract each other and the walls, in growing strength.
Description cohesive() {
  Description d = servo("linear-cohesive");
  d["materials"]["grain"]["tensile_strength"] = 2e4;
  d["stages"][1]["change"]["materials"]["grain"]["tensile_strength"] = 4e4;
  return d;
}
/// A free lid on the grains, a rotating side, one that rotates freely and one that oscillates at increasing frequency;
/// a belt below.
Description loose() {
  Description d = box("linear-frictional", {7, 6, 6}, 8);
  d["walls"]["lid"]["motion"] = {{"free", {{"axes", "z"}, {"mass", 1e-3}, {"load", {0, 0, -0.01}}}}};
  d["walls"]["left"]["motion"] = {{"spin", {0, 0.5, 0}}, {"velocity", {0.01, 0, 0}}, {"ramp_time", 1e-3}};
  d["walls"]["bottom"]["motion"] = {
      {"surface_velocity", {0.1, 0, 0}}, {"surface_spin", {0, 0, 3}}, {"ramp_time", 1e-3}};
  d["walls"]["back"]["motion"]["free_rotation"] = {{"axis", {0, 1, 0}}, {"inertia", 1e-7}, {"moment", 1e-5}};
  d["walls"]["right"]["motion"]["oscillation"] = {{"amplitude", {1e-5, 0, 0}},
                                                  {"angle", {0, 0.01, 0}},
                                                  {"frequency", 300},
                                                  {"phase", 0.3},
                                                  {"angle_phase", {0, 0.4, 0}}};
  d["stages"] = {stage("fall", steps(230)),
                 stage("rest", {{"type", "any"}, {"of", {steps(350), {{"type", "kinetic-energy"}, {"below", 1e-9}}}}})};
  d["stages"][0]["ramps"] = {{{"pointer", "/walls/right/motion/oscillation/frequency"},
                              {"from", 300},
                              {"to", 600},
                              {"duration", 5e-4},
                              {"increments", 10}}};
  return d;
}

/// Grains in a drum that spins so fast that it uses up its skin sooner than they do.
Description drum() {
  Description d =
      description("linear-rolling", sand, jumble({8, 8, 8}, spacing, 0.02, 7, Vec3::Constant(-4 * spacing)));
  d["walls"]["drum"] = {{"type", "cylinder"},  {"start", {-1, 0, 0}},
                        {"end", {1, 0, 0}},    {"radius", 6.3 * spacing},
                        {"material", "grain"}, {"motion", {{"spin", {200, 0, 0}}, {"ramp_time", 1e-4}}}};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["stages"] = {stage("spin", steps(170)), stage("stop", steps(160))};
  d["stages"][1]["change"]["walls"]["drum"]["motion"]["spin"] = {100, 0, 0};
  report(d, 13);
  return d;
}

/// Speeds and a drag limit the time step.
Description fast() {
  Description d = loose();
  d["time_step"] = {{"max_displacement", 1e-3}};
  d["engines"]["drag"] = {{"type", "drag"}, {"viscosity", 1}, {"density", 1}};
  return d;
}

/// Clumps that enter during the run, faster than there is room for them.
Description pouring() {
  Description d = description("linear-rolling", sand, {});
  make_clumps(d, boomerang());
  d["bodies"]["grains"]["source"] = {{"type", "stream"},
                                     {"number_rate", 20000},
                                     {"region", {{"type", "disc"}, {"centre", {0, 0, 8e-3}}, {"radius", 6e-3}}},
                                     {"sizes", {{"type", "uniform"}, {"smallest", 1e-3}, {"largest", 2e-3}}}};
  d["bodies"]["grains"]["velocity"] = {0, 0, -0.3};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["stages"] = {stage("pour", {{"type", "time"}, {"value", 0.02}}),
                 stage("go on", {{"type", "time"}, {"value", 5e-3}})};
  d["probes"]["energy"] = {{"type", "energy"}, {"every_time", 1e-3}};
  return d;
}

/// Grains fall on a plate of glued clumps that turns; a sink takes those that fall off, a sieve stops some.
Description plate() {
  Description d = description("linear-rolling", sand, jumble({6, 6, 1}, 2.5 * spacing, 0, 3));
  make_clumps(d, boomerang());
  std::vector<Grain> falling = jumble({6, 6, 6}, spacing, 0.05, 9);
  for (Grain& grain : falling) grain.position.z() += 4 * spacing;
  d["bodies"]["falling"] = description("linear-rolling", sand, falling)["bodies"]["grains"];
  d["walls"]["sieve"] = plane({0, 0, -3 * spacing}, Vec3::UnitZ());
  d["walls"]["sieve"]["groups"] = {"grains"};
  d["engines"] = {{"gravity", {{"type", "gravity"}, {"groups", {"falling"}}}},
                  {"damping", {{"type", "local-damping"}, {"groups", {"falling"}}}},
                  {"turn", {{"type", "prescribed-motion"}, {"groups", {"grains"}}, {"spin", {0, 0, 5}}}},
                  {"sink",
                   {{"type", "sink"},
                    {"groups", {"falling"}},
                    {"region", {{"type", "half-space"}, {"point", {0, 0, 0.5 * spacing}}}}}}};
  d["stages"] = {stage("fall", {{"type", "time"}, {"value", 0.03}}),
                 stage("stop", {{"type", "time"}, {"value", 5e-3}})};
  d["stages"][1]["change"]["engines"]["turn"]["spin"] = {0, 0, 0};
  d["probes"]["energy"] = {{"type", "energy"}, {"every_time", 1e-3}};
  d["probes"]["flow"] = {{"type", "packing"}, {"every_time", 1e-3}, {"groups", {"falling"}}};
  return d;
}

/// Clumps in a periodic cell fall on a floor; others follow.
Description clumps() {
  Description d = description("linear-rolling", sand, jumble({6, 6, 5}, 1.2 * spacing, 0.05, 9));
  make_clumps(d, boomerang());
  const double side = 6 * 1.2 * spacing;
  d["domain"] = {{"low", {0, 0, -0.01}}, {"high", {side, side, 0.05}}, {"periodic", {true, true, false}}};
  d["walls"]["floor"] = plane({0, 0, -0.5e-3}, Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0.5, 0, -9.81}}};
  d["bodies"]["late"] = d["bodies"]["grains"];
  d["bodies"]["late"]["stage"] = "more";
  d["bodies"]["late"]["source"] = {{"type", "cloud"},
                                   {"low", {0, 0, 0.02}},
                                   {"high", {side, side, 0.03}},
                                   {"count", 20},
                                   {"sizes", {{"type", "uniform"}, {"smallest", 1e-3}, {"largest", 1.2e-3}}}};
  d["stages"] = {stage("first", steps(140)), stage("more", steps(150))};
  report(d, 17);
  d["probes"]["rotations"] = {{"type", "rotations"}, {"every_steps", 35}};
  return d;
}

/// Grains discharge through a slot, others appear above twice, the rest comes to rest.
Description silo() {
  const Vec3 low = Vec3::Zero(), high = spacing * Vec3(10, 5, 7);
  Description d = description("linear-rolling", sand, jumble({10, 5, 7}, spacing, 0.3, 4));
  for (int axis : {0, 1})
    for (const bool up : {true, false})
      d["walls"][std::string(1, "xy"[axis]) + (up ? "_low" : "_high")] =
          side(axis, up ? low[axis] : high[axis], low - Vec3(0, 0, 1), high + Vec3(0, 0, 1), up);
  for (const bool left : {true, false})
    d["walls"][left ? "floor_left" : "floor_right"] =
        side(2, 0, left ? low : Vec3(8 * spacing, 0, 0), left ? Vec3(3 * spacing, high.y(), 0) : high, true);
  d["domain"] = {{"low", {-0.01, -0.01, -0.002}}, {"high", {0.03, 0.03, 0.05}}, {"open_sides", {"-z"}}};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.2}};
  for (const char* when : {"second", "third"}) {
    d["bodies"][when] = d["bodies"]["grains"];
    d["bodies"][when]["stage"] = when;
    d["bodies"][when]["source"] = {{"type", "cloud"},
                                   {"low", {0, 0, 0.012}},
                                   {"high", {high.x(), high.y(), 0.02}},
                                   {"count", 40},
                                   {"sizes", {{"type", "uniform"}, {"smallest", 0.8e-3}, {"largest", 1e-3}}}};
    d["bodies"][when]["velocity"] = {0, 0, -0.5};
  }
  d["stages"] = {
      stage("first", {{"type", "discharged"}, {"fraction", 0.02}}), stage("second", steps(400)),
      stage("third", {{"type", "any"}, {"of", {steps(900), {{"type", "unbalanced-force"}, {"below", 0.01}}}}})};
  report(d, 50);
  d["probes"]["flow"] = {{"type", "flow"}, {"every_steps", 25}, {"window", 2e-3}, {"pattern", {{"depth_axis", "y"}}}};
  d["probes"]["left"] = {{"type", "packing"}, {"every_discharged", 0.01}};
  return d;
}

/// A box of grains sheared by its bottom, with every probe, several of which keep data between samples.
Description every_probe() {
  Description d = box("linear-rolling", {9, 6, 7}, 12);
  d["walls"]["bottom"]["motion"]["velocity"] = {0.4, 0, 0};
  d["stages"] = {stage("shear", steps(130)), stage("shear on", steps(130))};
  d["specimen"] = {{"low", {"left", "front", "bottom"}}, {"high", {"right", "back", "lid"}}};
  const Description layer{{"wall", "bottom"}, {"driven_by", "lid"}, {"every_steps", 9}};
  for (const char* type : {"interface", "slip"}) d["probes"][type] = layer, d["probes"][type]["type"] = type;
  d["probes"]["wall-profile"] = {
      {"type", "wall-profile"}, {"walls", {"left"}}, {"width", 6 * spacing}, {"every_steps", 9}};
  d["probes"]["spectrum"] = {{"type", "spectrum"}, {"wall", "lid"}, {"interval", 1e-5},
                             {"points", 8},        {"windows", 3},  {"every_steps", 1}};
  d["probes"]["formula"] = {{"type", "formula"}, {"every_displacement", {{"wall", "bottom"}, {"value", 1e-5}}}};
  d["probes"]["formula"]["curves"]["pressure"] = {{"formula", "lid_pressure"}, {"unit", "Pa"}};
  for (const char* type : {"coarse-graining", "displacements", "energy", "rotations", "strain", "image-correlation",
                           "stress", "void-ratio", "walls"})
    d["probes"][type] = {{"type", type}, {"every_steps", 40}};
  d["probes"]["image-correlation"]["pixels_per_diameter"] = 10;
  return d;
}

/// The position at which two recordings differ; empty if they are equal.
std::string parting(const Taped& a, const Taped& b) {
  const auto& x = a.tape.entries;
  const auto& y = b.tape.entries;
  for (std::size_t i = 0; i < std::max(x.size(), y.size()); ++i) {
    if (i >= x.size()) return "more: " + y[i].what + " at step " + std::to_string(y[i].step);
    if (i >= y.size()) return "less: " + x[i].what + " at step " + std::to_string(x[i].step);
    if (!(x[i] == y[i]))
      return x[i].what + " at step " + std::to_string(x[i].step) + ", " + y[i].what + " at step " +
             std::to_string(y[i].step);
  }
  return same_bits(*a.kernel, *b.kernel) ? "" : "the worlds";
}

/// The same run, stopped at each of these steps or up to seven later, by one thread and by three in turn.
void expect_same_when_stopped(const Description& d, const Taped& whole, const std::vector<std::uint64_t>& stops) {
  std::optional<Checkpoint> from;
  std::vector<Tape::Entry> before;
  unsigned threads = 3;
  for (const std::uint64_t at : stops) {
    Taped part(
        d, threads, [&](const Kernel& now) { return now.world().step() >= at; }, from ? &*from : nullptr,
        std::move(before));
    ASSERT_EQ(part.tape.summary.status, "interrupted") << at;
    ASSERT_FALSE(part.tape.checkpoints.empty());
    from = part.tape.checkpoints.back(), before = std::move(part.tape.entries);
    ASSERT_LE(from->step, at + 8);
    threads = 4 - threads;
  }
  const Taped rest(d, threads, {}, from ? &*from : nullptr, std::move(before));
  ASSERT_EQ(rest.tape.summary.status, "done") << rest.tape.summary.message;
  EXPECT_EQ(parting(whole, rest), "") << testing::PrintToString(stops);
  EXPECT_EQ(rest.tape.summary.steps, whole.tape.summary.steps);
  EXPECT_EQ(rest.tape.summary.rebuilds, whole.tape.summary.rebuilds);
  EXPECT_EQ(rest.kernel->state().lists.searches_at_walls(), whole.kernel->state().lists.searches_at_walls());
  EXPECT_EQ(rest.tape.summary.contacts_per_body, whole.tape.summary.contacts_per_body);
}

struct Case {
  std::string name;
  Description (*description)();
};
void PrintTo(const Case& one, std::ostream* out) { *out << one.name; }

class Resume : public testing::TestWithParam<Case> {
 protected:
  Description d_ = GetParam().description();
  Taped whole_{d_, 1};
};

TEST_P(Resume, AnywhereGivesTheSameBits) {
  const RunSummary& summary = whole_.tape.summary;
  ASSERT_EQ(summary.status, "done") << summary.message;
  ASSERT_GT(summary.rebuilds + whole_.kernel->state().lists.searches_at_walls(), 2u);
  const std::uint64_t end = summary.steps;
  // Also one step apart: with only a search, or the start of a stage, in between.
  expect_same_when_stopped(d_, whole_, {end / 2});
  expect_same_when_stopped(d_, whole_, {1, end / 3, end / 3 + 20, 4 * end / 5});
}

TEST_P(Resume, WhereAFrameFoundNoRoomGivesTheSameBits) {
  const std::uint64_t end = whole_.tape.summary.steps;
  for (const std::uint64_t at : {end / 4, end / 2}) {
    const Taped part(d_, 2, {}, nullptr, {}, 0, [&](const Kernel& now) { return now.world().step() >= at; });
    ASSERT_EQ(part.tape.summary.status, "refused");
    ASSERT_FALSE(part.tape.checkpoints.empty());
    const Taped rest(d_, 1, {}, &part.tape.checkpoints.back(), part.tape.entries);
    EXPECT_EQ(parting(whole_, rest), "") << "from step " << part.tape.checkpoints.back().step;
  }
}

/// Checkpoints at wall-clock intervals change nothing, and a run can be resumed from each.
TEST_P(Resume, AtWallClockIntervalsChangesNothing) {
  const Taped often(d_, 2, {}, nullptr, {}, 1e-9);
  EXPECT_EQ(parting(whole_, often), "");
  auto checkpoints = often.tape.checkpoints;
  ASSERT_FALSE(checkpoints.empty());
  checkpoints.pop_back();  // that of the end, from which there is nothing to resume
  EXPECT_EQ(checkpoints.front().step, 0u);
  for (const std::size_t which : {std::size_t{0}, checkpoints.size() / 2, checkpoints.size() - 1}) {
    const Taped rest(d_, 3, {}, &checkpoints[which], often.tape.entries);
    EXPECT_EQ(parting(whole_, rest), "") << "from step " << checkpoints[which].step;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Resume,
                         testing::Values(Case{"cell", cell}, Case{"cell_under_stress", cell_under_stress},
                                         Case{"sheared_cell", sheared_cell}, Case{"servo", [] { return servo(); }},
                                         Case{"braking_servo", braking}, Case{"stiffening", stiffening},
                                         Case{"cohesive", cohesive}, Case{"loose_walls", loose}, Case{"drum", drum},
                                         Case{"fast", fast}, Case{"pouring", pouring}, Case{"plate", plate},
                                         Case{"clumps", clumps}, Case{"silo", silo}, Case{"every_probe", every_probe}),
                         [](const auto& info) { return info.param.name; });

/// At the steps around a search, where lists are new or expired. `count`: of searches so far.
void expect_same_around_a_search(Description d, const std::function<std::uint64_t(const NeighbourLists&)>& count) {
  d["probes"]["packing"]["every_steps"] = 1;  // so that the run can stop at any step
  std::vector<std::pair<std::uint64_t, std::uint64_t>> searches;
  const Taped whole(d, 1, [&](const Kernel& now) {
    const std::uint64_t step = now.world().step(), so_far = count(now.state().lists);
    if (searches.empty() || searches.back().second != so_far) searches.emplace_back(step, so_far);
    return false;
  });
  ASSERT_GT(searches.size(), 3u);
  const std::uint64_t at = searches[2].first;
  for (const std::uint64_t stop : {at - 2, at - 1, at}) expect_same_when_stopped(d, whole, {stop});
  expect_same_when_stopped(d, whole, {at - 2, at - 1, at, at + 1});
}

TEST(Checkpoint, JustBeforeAndAfterASearch) {
  expect_same_around_a_search(cell(), [](const NeighbourLists& lists) { return lists.rebuilds(); });
}
TEST(Checkpoint, JustBeforeAndAfterASearchAtWalls) {
  Description d = drum();
  d["stages"][0] = stage("spin", steps(600));
  d["engines"]["hold"] = {{"type", "hold"}, {"translation", "xyz"}};  // only the drum uses up its skin
  d["guards"]["overlap"] = 1e9;
  expect_same_around_a_search(d, [](const NeighbourLists& lists) { return lists.searches_at_walls(); });
}

TEST(Checkpoint, OmitsTheExtraSamplesOfAnInterruptedRun) {
  const Description d = servo();
  const Taped part(d, 1, [](const Kernel& now) { return now.world().step() >= 60; });
  const Checkpoint& last = part.tape.checkpoints.back();
  EXPECT_EQ(part.tape.entries.back().what, "frame");
  EXPECT_EQ(part.tape.entries.back().step, last.step) << "the run records where it stopped";
  EXPECT_EQ(last.stage, "press");
}

TEST(Checkpoint, IsWrittenWhileAStageWaitsForRest) {
  const Description d = silo();
  const Taped whole(d, 1);
  ASSERT_EQ(whole.tape.summary.stage, "third");
  std::uint64_t third = 0;
  for (const auto& entry : whole.tape.entries)
    if (entry.what.starts_with("end of")) third = entry.step == whole.tape.summary.steps ? third : entry.step;
  ASSERT_GT(whole.kernel->world().departures().size(), 5u);
  expect_same_when_stopped(d, whole, {third + 30, third + 210});
}

TEST(Checkpoint, OfAnotherSceneIsRefused) {
  const Taped part(servo(), 1, [](const Kernel& now) { return now.world().step() >= 20; });
  const auto error_of = [&](const Description& d, Checkpoint checkpoint) -> std::string {
    try {
      Taped(d, 1, {}, &checkpoint);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const Checkpoint good = part.tape.checkpoints.back();
  EXPECT_THAT(error_of(cell(), good), HasSubstr("continue with the description that wrote it"));
  Checkpoint half = good;
  half.state.resize(half.state.size() / 2);
  EXPECT_THAT(error_of(servo(), half), HasSubstr("the saved state is too short"));
  Checkpoint longer = good;
  longer.state.emplace_back();
  EXPECT_THAT(error_of(servo(), longer), HasSubstr("holds more than this simulation restores"));
}

/// The message with which a state is refused; empty if it is not. Runs on for a few steps.
std::string refusal(const Description& d, const Checkpoint& checkpoint) {
  try {
    const Taped rest(
        d, 1, [](const Kernel&) { return true; }, &checkpoint);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

/// A saved state, and places in it.
struct SavedState {
  Checkpoint checkpoint;

  /// The first byte after the name and the version of a part.
  std::size_t part(const std::string& name, std::uint32_t version = 1) const {
    Archive header;
    header.part(name, version);
    const auto found = std::ranges::search(checkpoint.state, header.bytes());
    EXPECT_FALSE(found.empty()) << name;
    return static_cast<std::size_t>(found.end() - checkpoint.state.begin());
  }
  template <class T>
  T read(std::size_t at) const {
    T value;
    std::memcpy(&value, checkpoint.state.data() + at, sizeof value);
    return value;
  }
  template <class T>
  Checkpoint with(std::size_t at, T value) const {
    Checkpoint altered = checkpoint;
    std::memcpy(altered.state.data() + at, &value, sizeof value);
    return altered;
  }
};

SavedState saved(const Description& d, std::uint64_t step) {
  const Taped part(d, 1, [step](const Kernel& now) { return now.world().step() >= step; });
  return {part.tape.checkpoints.back()};
}

TEST(Checkpoint, ThatWasAlteredIsRefused) {
  const Description d = clumps();
  const SavedState state = saved(d, 100);
  ASSERT_EQ(refusal(d, state.checkpoint), "");
  const std::uint32_t nowhere = 0xfffffff0;
  const auto expect = [&](const Checkpoint& altered, const char* words) {
    EXPECT_THAT(refusal(d, altered), HasSubstr(words));
  };
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  // Bodies: their number, whether they have rotations and origins, positions.
  const std::size_t bodies = state.part("bodies", 2);
  ASSERT_GT(state.read<std::uint64_t>(bodies), 100u);
  expect(state.with(bodies + 10, unknown), "the place, the size or the motion of a body is not a number");
  expect(state.with(bodies + 10, 1e306), "a body is far outside of the periodic cell");
  expect(state.with(bodies, std::uint64_t{1} << 60), "the saved state is too short");
  // Contacts: the number of bodies; by chunk the blocks of pairs that touch and of all, whether they have images and a
  // reach, and the first bodies of pairs.
  const std::size_t contacts = state.part("contacts", 2), blocks = contacts + 8, flags = blocks + 8;
  ASSERT_GT(state.read<std::uint32_t>(blocks + 4), 10u);
  expect(state.with(flags + 2, nowhere), "a contact is of a body that is not there");
  expect(state.with(contacts, std::uint64_t{7}), "contacts are of another number of bodies");
  expect(state.with(blocks, nowhere), "there are more contacts than bodies have");
  expect(state.with(blocks + 4, nowhere), "the saved state is too short");
  // Contacts with walls: chunks, each with the places of its walls, and the bodies near them.
  const std::size_t near = state.part("wall contacts", 3) + 8, places = state.read<std::uint64_t>(near);
  ASSERT_EQ(places, 2u);
  expect(state.with(near + 8, nowhere), "bodies near walls are of other walls");
  ASSERT_GT(state.read<std::uint64_t>(near + 8 + 4 * places), 0u);
  expect(state.with(near + 16 + 4 * places, nowhere), "a body that is not there is near a wall");
  // Periodic sides, after two corners of three numbers.
  expect(state.with(state.part("cell") + 48, std::uint8_t{2}), "other axes of the cell are periodic");
  // After these and two rates of three numbers, the offsets of images.
  const SavedState skewed = saved(sheared_cell(), 20);
  EXPECT_THAT(refusal(sheared_cell(), skewed.with(skewed.part("cell") + 99, 1e306)),
              HasSubstr("the images of the cell are further away than a search leaves them"));
}

TEST(Checkpoint, OfAnotherVersionOfAPartIsRefused) {
  const Description d = servo();
  const SavedState state = saved(d, 20);
  const std::size_t version = sizeof(std::uint32_t);
  EXPECT_THAT(refusal(d, state.with(state.part("neighbour lists", 3) - version, std::uint32_t{4})),
              HasSubstr("the saved state of \"neighbour lists\" has version 4, allowed is 3"));
  EXPECT_THAT(refusal(d, state.with(state.part("streams") - version - 1, 'x')),
              HasSubstr("the saved state holds other parts: \"streams\" is missing, found is \"streamx\";"));
  EXPECT_THAT(refusal(d, state.with(state.part("streams") - version - 1, '\x1b')),
              HasSubstr("the saved state holds other parts: \"streams\" is missing; it belongs"));
  EXPECT_THAT(refusal(d, state.with(state.part("force-chains") - version, std::uint32_t{9})),
              AllOf(HasSubstr("probe \"force-chains\" cannot be restored from a checkpoint"),
                    HasSubstr("\"force-chains\" has version 9, allowed is 1")));
}

/// Any number of the state may be anything: the run goes on or is refused.
TEST(Checkpoint, ThatWasAlteredAnywhereDoesNotCrash) {
  for (const Description& d : {servo(), clumps(), pouring(), every_probe()}) {
    const SavedState state = saved(d, 60);
    const std::size_t length = state.checkpoint.state.size() - 64;  // without what the tape keeps
    std::size_t refused = 0;
    constexpr std::size_t places = 120;
    for (std::size_t i = 0; i < places; ++i) {
      const std::size_t at = length * i / places;
      const auto before = state.read<std::uint64_t>(at);
      const std::uint64_t other = i % 2 == 0 ? ~std::uint64_t{0} : before ^ std::uint64_t{1} << i % 61;
      refused += !refusal(d, state.with(at, other)).empty();
    }
    EXPECT_GT(refused, 5u);
  }
}

/// A force that grows with the number of its calls, the state of an engine.
class Drumbeat final : public Engine {
 public:
  explicit Drumbeat(bool saves) : saves_(saves) {}
  void declare(Parameters&) override {}
  Phase phase() const override { return Phase::forces; }
  void forces(const World&, std::span<Row> force, std::span<Row>) const override {
    ++beats_;
    for (Row& one : force) one.x += 1e-6 * std::sin(beats_);
  }
  void serialize(Archive& archive) override {
    if (saves_) archive(beats_);
  }

 private:
  bool saves_;
  mutable double beats_ = 0;
};

TEST(Checkpoint, KeepsTheStateOfEngines) {
  const auto drum = [](const char* name, bool saves) {
    PluginInfo info;
    info.kind = "engine", info.name = name, info.version = "1.0.0", info.doc = "pushes all bodies along x";
    info.make_engine = saves ? []() -> Engine* { return new Drumbeat(true); }
                             : []() -> Engine* { return new Drumbeat(false); };
    return info;
  };
  static const PluginInfo remembers = drum("drum", true), forgets = drum("careless-drum", false);
  installed().add(remembers), installed().add(forgets);
  for (const bool careless : {false, true}) {
    Description d = cell();
    d["engines"]["drum"] = {{"type", careless ? "careless-drum" : "drum"}};
    const Taped whole(d, 1), part(d, 1, [](const Kernel&now) { return now.world().step() >= 60; });
    const Taped rest(d, 1, {}, &part.tape.checkpoints.back(), part.tape.entries);
    EXPECT_EQ(parting(whole, rest).empty(), !careless);
  }
}

}  // namespace
}  // namespace grit::test::checkpoint_tests
