// Single steps give the same bits as a complete run, with any actions in between.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include "grit/error.hpp"
#include "grit/simulation.hpp"
#include "support/scene.hpp"

namespace grit::test::steps_tests {
namespace {

SimulationOptions options() { return {.plugin_path = {GRIT_PLUGIN_DIR}}; }

/// A stack of Hertzian balls that falls on a plane: its critical time step changes while they are in contact. Two
/// stages, which end by time, and a change between them.
Description falling() {
  std::vector<Grain> grains;
  for (int i = 0; i < 4; ++i) grains.push_back({{1e-4 * i, 0, 5.01e-3 + 10.02e-3 * i}, 5e-3, {0, 0, -0.4}});
  Description d =
      description("hertz-mindlin",
                  {{"density", 2500}, {"young_modulus", 2e7}, {"poisson_ratio", 0.2}, {"restitution", 0.7}}, grains);
  d["walls"]["floor"] = plane({0, 0, 0}, {0, 0, 1});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  const auto stage = [](const char* name, double seconds) {
    return Description{{"name", name}, {"until", {{"type", "time"}, {"value", seconds}}}, {"limit", 1}};
  };
  d["stages"] = {stage("first", 11e-3), stage("second", 9e-3)};
  d["stages"][1]["change"] = {{"engines", {{"gravity", {{"acceleration", {0, 0, -20}}}}}}};
  d["stages"][1]["ramps"] = {
      {{"pointer", "/engines/gravity/acceleration/0"}, {"from", 0}, {"to", 5}, {"duration", 4e-3}, {"increments", 20}}};
  return d;
}

/// The observable state of a run: calls of observers, and all motion.
struct Seen {
  std::vector<std::tuple<int, std::uint64_t, double, double>> calls;  ///< observer, step, time, time step
  std::vector<double> state;
  bool operator==(const Seen&) const = default;
};

void observe(Simulation& simulation, Seen& seen) {
  const auto note = [&seen](int which) {
    return
        [&seen, which](const World& world) { seen.calls.emplace_back(which, world.step(), world.time(), world.dt()); };
  };
  // Many intervals, so that one is due half a step from a step, where the time step decides.
  for (int i = 0; i < 40; ++i) simulation.every_time(0.11e-3 + 7e-6 * i, note(i));
  simulation.every_steps(7, note(100));
  simulation.at_stage_end(note(101));
}

void note_state(const Simulation& simulation, Seen& seen) {
  const World& world = simulation.world();
  for (const auto rows : {world.positions(), world.velocities(), world.spins(), world.forces()})
    for (const Row& row : rows) seen.state.insert(seen.state.end(), {row.x, row.y, row.z});
  seen.state.push_back(world.time());
}

Seen seen_by(const std::function<void(Simulation&)>& run) {
  Simulation simulation(falling(), options());
  Seen seen;
  observe(simulation, seen);
  run(simulation);
  EXPECT_TRUE(simulation.done());
  note_state(simulation, seen);
  return seen;
}

const Seen& whole() {
  static const Seen seen = seen_by([](Simulation& simulation) { simulation.run(); });
  return seen;
}

TEST(Steps, TheTimeStepChangesInTheTest) {
  double least = 1, most = 0;
  for (const auto& [which, step, time, dt] : whole().calls) least = std::min(least, dt), most = std::max(most, dt);
  EXPECT_LT(least, 0.9 * most);
  EXPECT_GT(whole().calls.size(), 1000u);
}

TEST(Steps, OneAtATimeGiveTheBitsOfARun) {
  for (const std::uint64_t at_once : {1u, 3u, 64u})
    EXPECT_EQ(seen_by([&](Simulation& simulation) {
                while (!simulation.done()) simulation.step(at_once);
              }),
              whole())
        << at_once;
}

TEST(Steps, AfterACheckGiveTheBitsOfARun) {
  EXPECT_EQ(seen_by([](Simulation& simulation) {
              simulation.check();
              simulation.run();
            }),
            whole());
}

TEST(Steps, InterruptionsChangeNothing) {
  EXPECT_EQ(seen_by([](Simulation& simulation) {
              std::uint64_t last = ~0ull;
              simulation.interrupt_when([&] { return std::exchange(last, simulation.world().step()) != last; });
              while (!simulation.done()) simulation.run();
            }),
            whole())
      << "at every step";
}

TEST(Steps, ACheckpointAfterAnyStepContinuesWithTheSameBits) {
  for (const std::uint64_t stop : {5u, 40u, 77u, 110u}) {
    Simulation first(falling(), options()), second(falling(), options());
    ASSERT_EQ(first.step(stop), stop);
    second.resume(first.save());
    Seen a, b;
    for (const auto& [simulation, seen] : {std::pair(&first, &a), std::pair(&second, &b)}) {
      simulation->run();
      note_state(*simulation, *seen);
    }
    EXPECT_EQ(a, b) << stop;
  }
}

TEST(Steps, ASimulationThatHasBegunDoesNotResume) {
  Simulation simulation(falling(), options());
  simulation.step();
  const Checkpoint checkpoint = simulation.save();
  try {
    simulation.resume(checkpoint);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "a simulation that has begun cannot resume from a checkpoint; open the description again");
  }
}

TEST(Steps, CheckpointsAreKeptIfASimulationIsInterrupted) {
  Simulation simulation(falling(), options());
  std::vector<std::uint64_t> kept;
  simulation.on_checkpoint([&](const Checkpoint& checkpoint) { kept.push_back(checkpoint.step); }, 0);
  simulation.interrupt_when([&] { return simulation.world().step() == 20; });
  EXPECT_FALSE(simulation.run());
  EXPECT_THAT(kept, testing::ElementsAre(20));
  simulation.interrupt_when({});
  EXPECT_TRUE(simulation.run());
  EXPECT_THAT(kept, testing::ElementsAre(20)) << "none at wall-clock intervals";
}

}  // namespace
}  // namespace grit::test::steps_tests
