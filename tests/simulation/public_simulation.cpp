// The public class: a simulation as a library.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>

#include "grit/error.hpp"
#include "grit/simulation.hpp"
#include "support/notes.hpp"
#include "support/scene.hpp"

namespace grit::test::public_simulation_tests {
namespace {

constexpr double dt = 2e-5, g = 9.81;

/// A ball that falls freely, in two stages of 100 steps.
Description drop() {
  Description d = description("linear-frictional", {{"density", 2500}}, {{{0, 0, 0}, 5e-3}});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["time_step"] = {{"value", dt}};
  const auto stage = [](const char* name) {
    return Description{{"name", name}, {"until", {{"type", "steps"}, {"value", 100}}}, {"limit", 1}};
  };
  d["stages"] = {stage("first"), stage("second")};
  return d;
}
SimulationOptions options() { return {.plugin_path = {GRIT_PLUGIN_DIR}}; }
double height(const Simulation& simulation) { return simulation.world().positions()[0].z; }
/// Leap-frog from rest: the first kick is half a step.
double fallen(double steps) { return -0.5 * g * dt * dt * steps * steps; }

TEST(PublicSimulation, RunsStageAfterStage) {
  Simulation simulation(drop(), options());
  EXPECT_TRUE(simulation.run_stage());
  EXPECT_EQ(simulation.world().step(), 100u);
  EXPECT_NEAR(height(simulation), fallen(100), 1e-12);
  EXPECT_EQ(simulation.world().stage(), "second");
  EXPECT_FALSE(simulation.done());
  EXPECT_TRUE(simulation.run());
  EXPECT_NEAR(height(simulation), fallen(200), 1e-12);
  EXPECT_TRUE(simulation.done());
  EXPECT_TRUE(simulation.run()) << "it is complete";
}

TEST(PublicSimulation, StepsThroughTheEndsOfStages) {
  Simulation stepped(drop(), options()), whole(drop(), options());
  EXPECT_EQ(stepped.step(150), 150u);
  EXPECT_EQ(stepped.world().stage(), "second");
  EXPECT_NEAR(height(stepped), fallen(150), 1e-12);
  EXPECT_EQ(stepped.step(1000), 50u);
  EXPECT_TRUE(stepped.done());
  whole.run();
  EXPECT_EQ(height(stepped), height(whole)) << "the same bits";
}

TEST(PublicSimulation, EstimatesTheCostOfARun) {
  Simulation simulation(drop(), options());
  const Forecast forecast = simulation.check();
  EXPECT_EQ(forecast.bodies, 1u);
  EXPECT_EQ(forecast.contacts, 0u);
  EXPECT_EQ(forecast.time_step, dt);
  EXPECT_GT(forecast.critical_time_step, 0);
  EXPECT_GT(forecast.bytes, 100u);
  EXPECT_EQ(simulation.world().step(), 0u);
}

TEST(PublicSimulation, RefusesMoreBodiesThanMemoryHolds) {
  Description d = drop();
  d["bodies"]["grains"]["source"] = {{"type", "cloud"},
                                     {"low", {0, 0, 0}},
                                     {"high", {9, 9, 9}},
                                     {"count", 4e9},
                                     {"sizes", {{"type", "list"}, {"diameters", {1e-3}}}}};
  EXPECT_THAT([&] { Simulation(d, options()); },
              testing::ThrowsMessage<DescriptionError>(testing::HasSubstr(
                  "/bodies/grains/source: found 4000000000 bodies, which need about 2.8 TB of memory")));
}

TEST(PublicSimulation, CallsObservers) {
  Simulation simulation(drop(), options());
  std::vector<std::uint64_t> by_steps, by_time, at_end;
  simulation.every_steps(30, [&](const World& world) { by_steps.push_back(world.step()); });
  simulation.every_time(50 * dt, [&](const World& world) { by_time.push_back(world.step()); });
  simulation.at_stage_end([&](const World& world) { at_end.push_back(world.step()); });
  simulation.run();
  EXPECT_THAT(by_steps, testing::ElementsAre(0, 30, 60, 90, 100, 130, 160, 190)) << "from the start of each stage";
  EXPECT_THAT(by_time, testing::ElementsAre(0, 50, 100, 100, 150, 200));
  EXPECT_THAT(at_end, testing::ElementsAre(100, 200));
}

TEST(PublicSimulation, ReportsProgressAndCanBeInterrupted) {
  Simulation simulation(drop(), options());
  std::vector<double> fractions;
  simulation.on_progress([&](const Progress& now) { fractions.push_back(now.fraction.value_or(-1)); }, 0);
  simulation.interrupt_when([&] { return simulation.world().step() == 40; });
  EXPECT_FALSE(simulation.run());
  EXPECT_EQ(simulation.world().step(), 40u);
  EXPECT_THAT(fractions, testing::ElementsAre(0.08, 0.16, 0.24, 0.32, 0.4));
  simulation.interrupt_when({});
  EXPECT_TRUE(simulation.run()) << "an interrupted simulation can continue";
  EXPECT_NEAR(height(simulation), fallen(200), 1e-12);
}

TEST(PublicSimulation, SetsAValueFromNowOn) {
  Simulation simulation(drop(), options());
  simulation.run_stage();
  simulation.set("/engines/gravity/acceleration", {0, 0, 0});
  const double speed = simulation.world().velocities()[0].z;
  simulation.run();
  EXPECT_EQ(simulation.world().velocities()[0].z, speed);
  EXPECT_NEAR(speed, -g * dt * 99.5, 1e-12);
}

TEST(PublicSimulation, KeepsArraysBeyondTheirInstant) {
  std::shared_ptr<const void> memory;
  std::span<const Row> positions;
  double then = 0;
  {
    Simulation simulation(drop(), options()), other(drop(), options());
    simulation.step(50);
    positions = simulation.world().positions(), then = height(simulation);
    memory = simulation.keep(WorldArray::positions);
    EXPECT_NE(simulation.world().positions().data(), positions.data()) << "it continues in a copy";
    EXPECT_EQ(height(simulation), then);
    simulation.run(), other.run();
    EXPECT_EQ(height(simulation), height(other)) << "the same bits";
    EXPECT_LT(height(simulation), then);
  }
  EXPECT_EQ(positions[0].z, then);
}

TEST(PublicSimulation, KeepsEachArray) {
  SimulationOptions with_state = options();
  with_state.state = BodyState::rotation | BodyState::displacement;
  Simulation simulation(drop(), with_state);
  simulation.step(50);
  const World& world = simulation.world();
  // Address of the first element, and whether the copy has the same values.
  const auto moves = [&](WorldArray array, const auto& read) {
    const auto before = read();
    ASSERT_EQ(before.size(), 1u);
    const auto memory = simulation.keep(array);
    EXPECT_NE(read().data(), before.data());
    EXPECT_EQ(std::memcmp(read().data(), before.data(), before.size_bytes()), 0);
  };
  moves(WorldArray::ids, [&] { return world.ids(); });
  moves(WorldArray::positions, [&] { return world.positions(); });
  moves(WorldArray::velocities, [&] { return world.velocities(); });
  moves(WorldArray::spins, [&] { return world.spins(); });
  moves(WorldArray::materials, [&] { return world.materials(); });
  moves(WorldArray::rotations, [&] { return world.rotations(); });
  moves(WorldArray::displacements, [&] { return world.displacements(); });
  moves(WorldArray::forces, [&] { return world.forces(); });
  moves(WorldArray::moments, [&] { return world.moments(); });
  for (const WorldArray empty :
       {WorldArray::clump_of, WorldArray::clumps, WorldArray::departures, WorldArray::contacts})
    EXPECT_NE(simulation.keep(empty), nullptr);
}

TEST(PublicSimulation, RefusesWhatCannotBeSet) {
  Simulation simulation(drop(), options());
  const auto problem = [&](const std::string& pointer, const Description& value) {
    try {
      simulation.set(pointer, value);
    } catch (const DescriptionError& error) {
      return error.problems().at(0);
    }
    return Problem{};
  };
  EXPECT_EQ(problem("/materials/grain/friction_angle", 7).pointer, "/materials/grain/friction_angle");
  EXPECT_THAT(problem("/materials/grain/colour", 7).message, testing::HasSubstr("unknown key \"colour\""));
  EXPECT_THAT(problem("/materials/ice", Description{{"density", 900}}).message,
              testing::HasSubstr("found the material \"ice\", which is not defined; allowed are materials that are "
                                 "defined when the run begins"));
  EXPECT_THAT(problem("/seed", 7).message, testing::HasSubstr("found a change of \"seed\""));
  EXPECT_THAT(problem("seed", 7).message, testing::HasSubstr("allowed is a JSON pointer"));
}

TEST(PublicSimulation, ContinuesFromACheckpointWithValuesThatWereSet) {
  Simulation simulation(drop(), options());
  simulation.step(30);
  simulation.set("/engines/gravity/acceleration", {0, 0, -1.0});
  simulation.step(30);
  const Checkpoint there = simulation.save();
  EXPECT_EQ(there.step, 60u);
  simulation.run();
  Simulation other(drop(), options());
  other.resume(there);
  EXPECT_EQ(other.world().step(), 60u);
  other.run();
  EXPECT_EQ(height(other), height(simulation)) << "the same bits";
  EXPECT_GT(height(other), fallen(200)) << "gravity was lowered";
}

TEST(PublicSimulation, OpensFromACheckpointWithoutItsFiles) {
  const std::string packing = testing::TempDir() + "grit_opens_from_a_checkpoint.txt";
  std::ofstream(packing) << "0 0 0 5e-3\n";
  Description d = drop();
  d["bodies"]["grains"]["source"] = {{"type", "file"}, {"path", packing}};
  Simulation simulation(d, options());
  simulation.step(130);
  SimulationOptions from = options();
  from.checkpoint = simulation.save();
  simulation.run();
  std::filesystem::remove(packing);
  EXPECT_THROW(Simulation(d, options()), Error);

  Simulation other(d, from);
  EXPECT_EQ(other.world().step(), 130u);
  EXPECT_EQ(other.world().ids().size(), 1u);
  EXPECT_THROW(other.resume(*from.checkpoint), Error) << "it has begun";
  other.run();
  EXPECT_EQ(height(other), height(simulation)) << "the same bits";
}

TEST(PublicSimulation, ReadsFilesAndTexts) {
  const std::string text = drop().dump(2);
  Simulation simulation = Simulation::from_text(text, options());
  simulation.run();
  EXPECT_NEAR(height(simulation), fallen(200), 1e-12);
  EXPECT_EQ(simulation.description().at("time_step").at("value"), dt);
  try {
    Simulation::from_text("{\n \"seed\": -1}", options(), "mine.json");
    FAIL();
  } catch (const DescriptionError& error) {
    EXPECT_EQ(error.problems().at(0).file, "mine.json");
    EXPECT_THAT(error.what(), testing::HasSubstr("mine.json:2: /seed"));
  }
  EXPECT_THROW(Simulation::open("/nowhere/box.json", options()), FileError);
}

TEST(PublicSimulation, PlacesFaultsOfTheFirstInstant) {
  Description d = drop();
  d["bodies"]["others"] = d["bodies"]["grains"];
  d["bodies"]["others"]["source"]["bodies"][0]["position"] = {0, 0, 2e-3};
  Simulation simulation(d, options());
  try {
    simulation.run();
    FAIL();
  } catch (const DescriptionError& error) {
    EXPECT_EQ(error.problems().at(0).pointer, "/bodies/grains");
    EXPECT_THAT(error.what(), testing::HasSubstr("overlaps body 1 by 1.6 of its radius"));
  }
}

}  // namespace
}  // namespace grit::test::public_simulation_tests
