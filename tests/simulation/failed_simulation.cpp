// A simulation that cannot go on, one that is done, and values that cannot be set: the state is defined in each case.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/simulation.hpp"
#include "support/scene.hpp"

namespace grit::test::failed_simulation_tests {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double radius = 5e-3;

SimulationOptions options() { return {.plugin_path = {GRIT_PLUGIN_DIR}}; }

/// A ball that falls on a floor, and presses on it; a second one rests far away.
Description bounce() {
  Description d = description("linear-frictional", {{"density", 2500}, {"contact_modulus", 1e6}},
                              {{{0, 0, 1.01 * radius}, radius, {0, 0, -1}}, {{1, 0, 2 * radius}, radius}});
  d["walls"]["floor"] = plane({0, 0, 0}, {0, 0, 1});
  d["walls"]["lid"] = {{"type", "rectangle"},
                       {"corner", {-0.1, -0.1, 1}},
                       {"edge_a", {2, 0, 0}},
                       {"edge_b", {0, 1, 0}},
                       {"material", "grain"}};
  d["time_step"] = {{"value", 1e-5}};
  d["stages"][0]["until"]["value"] = 400;
  return d;
}

std::vector<Row> positions(const Simulation& simulation) {
  const auto all = simulation.world().positions();
  return {all.begin(), all.end()};
}
bool same(const std::vector<Row>& a, const std::vector<Row>& b) {
  return std::ranges::equal(a, b, [](const Row& x, const Row& y) { return x.x == y.x && x.y == y.y && x.z == y.z; });
}
std::string numerics_error(const std::function<void()>& act) {
  try {
    act();
  } catch (const NumericsError& error) {
    return error.what();
  }
  return "";
}

void stays_as_it_is(Simulation& simulation, const std::string& why) {
  const auto there = positions(simulation);
  const std::uint64_t step = simulation.world().step();
  const std::vector<std::function<void()>> acts{
      [&] { simulation.run(); }, [&] { simulation.run_stage(); }, [&] { simulation.step(1); },
      [&] { simulation.set("/guards/overlap", 0.5); }, [&] { simulation.save(); }};
  for (std::size_t i = 0; i < acts.size(); ++i) EXPECT_EQ(numerics_error(acts[i]), why) << "call " << i;
  EXPECT_TRUE(same(positions(simulation), there));
  EXPECT_EQ(simulation.world().step(), step);
  EXPECT_EQ(simulation.world().forces().size(), there.size());
}

TEST(FailedSimulation, AfterAGuardItDoesNotMoveAgain) {
  Description d = bounce();
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -1e4}}};
  for (const auto& [guard, limit] : {std::pair("overlap", 1e-3), std::pair("travel", 2.5e-3)}) {
    SCOPED_TRACE(guard);
    d["guards"] = {{guard, limit}};
    Simulation simulation(d, options());
    const std::string why = numerics_error([&] { simulation.run(); });
    EXPECT_THAT(why, HasSubstr(std::string("more than /guards/") + guard));
    stays_as_it_is(simulation, why);
  }
}

TEST(FailedSimulation, AfterAStageThatDidNotEnd) {
  Description d = bounce();
  d["stages"][0]["limit"] = 5e-4;
  Simulation simulation(d, options());
  const std::string why = numerics_error([&] { simulation.run(); });
  EXPECT_THAT(why, HasSubstr("did not end within its limit"));
  stays_as_it_is(simulation, why);
}

TEST(FailedSimulation, AfterARefusedStart) {
  Description d = bounce();
  d["bodies"]["grains"]["source"]["bodies"][1]["position"] = {0, 0, 1.5 * radius};
  Simulation simulation(d, options());
  for (int i = 0; i < 2; ++i)
    EXPECT_THAT([&] { simulation.run(); }, ThrowsMessage<DescriptionError>(HasSubstr("overlaps body")));
}

TEST(FailedSimulation, AfterADamagedCheckpoint) {
  Simulation simulation(bounce(), options()), other(bounce(), options());
  simulation.step(5);
  Checkpoint damaged = simulation.save();
  damaged.state.resize(damaged.state.size() / 2);
  std::string why;
  try {
    other.resume(damaged);
  } catch (const Error& error) {
    why = error.what();
  }
  EXPECT_NE(why, "");
  EXPECT_THAT([&] { other.step(1); }, ThrowsMessage<Error>(why)) << "it is half restored";
}

TEST(FailedSimulation, ATimeStepThatIsTooLargeCanBeSetAgain) {
  Simulation simulation(bounce(), options()), undisturbed(bounce(), options());
  simulation.step(150);
  simulation.set("/time_step/value", 1);
  for (int i = 0; i < 2; ++i)
    EXPECT_THAT([&] { simulation.step(1); }, ThrowsMessage<NumericsError>(HasSubstr("above the critical one")));
  EXPECT_EQ(simulation.world().step(), 150u);
  simulation.set("/time_step/value", 1e-5);
  simulation.run(), undisturbed.run();
  EXPECT_TRUE(same(positions(simulation), positions(undisturbed)));
}

TEST(DoneSimulation, IsSavedAndResumedAsDone) {
  Simulation simulation(bounce(), options()), other(bounce(), options());
  simulation.run();
  other.resume(simulation.save());
  EXPECT_TRUE(other.done());
  EXPECT_EQ(other.world().step(), 400u);
  EXPECT_EQ(other.world().stage(), "only");
  EXPECT_TRUE(other.run());
  EXPECT_EQ(other.step(5), 0u);
  EXPECT_TRUE(same(positions(other), positions(simulation)));
  EXPECT_DOUBLE_EQ(other.world().forces()[0].z, simulation.world().forces()[0].z) << "found again";
}

TEST(DoneSimulation, CannotBeChanged) {
  Simulation simulation(bounce(), options());
  simulation.run();
  EXPECT_THAT([&] { simulation.set("/guards/overlap", 0.5); },
              ThrowsMessage<Error>(HasSubstr("the simulation is done; a value that is set now")));
}

TEST(SetWithoutEffect, IsRefused) {
  Simulation simulation(bounce(), options());
  simulation.step(10);
  EXPECT_THAT([&] { simulation.set("/materials/grain/density", 2600); },
              ThrowsMessage<DescriptionError>(AllOf(HasSubstr("set: /materials/grain/density: found a new density"),
                                                    HasSubstr("no later stage makes bodies of this material"))));
  EXPECT_THAT(
      [&] {
        simulation.set("/materials/grain", {{"density", 2600}, {"friction_angle", 0.1}});
      },
      ThrowsMessage<DescriptionError>(HasSubstr("found a new density")));
  EXPECT_NO_THROW(simulation.set("/materials/grain/density", 2500)) << "as it is";
  for (const char* pointer : {"/materials/grain", ""})
    EXPECT_THAT([&] { simulation.set(pointer, Description::object()); },
                ThrowsMessage<DescriptionError>(HasSubstr("found an empty object, which changes nothing")));
}

TEST(SetWithoutEffect, IsNoDensityOfBodiesThatALaterStageMakes) {
  Description d = bounce();
  d["bodies"]["late"] = d["bodies"]["grains"];
  d["bodies"]["late"]["stage"] = "second";
  d["bodies"]["late"]["source"]["bodies"] = {{{"position", {0.5, 0, 0.5}}, {"radius", radius}}};
  d["stages"].push_back(d["stages"][0]);
  d["stages"][1]["name"] = "second";
  Simulation simulation(d, options());
  simulation.step(10);
  simulation.set("/materials/grain/density", 2600);
  simulation.set("/materials/grain/density", 5000);
  simulation.run_stage();
  const World& world = simulation.world();
  ASSERT_EQ(world.velocities().size(), 3u);
  EXPECT_DOUBLE_EQ(world.velocities()[index_of(world, 0)].w, 2 * world.velocities()[index_of(world, 2)].w)
      << "inverse masses";
  EXPECT_THROW(simulation.set("/materials/grain/density", 2600), DescriptionError) << "all bodies are there";
}

TEST(SetThatIsRefused, ChangesNothing) {
  Simulation simulation(bounce(), options()), undisturbed(bounce(), options());
  simulation.step(150), undisturbed.step(150);
  // Found by the walls, after the description has been changed.
  EXPECT_THAT(
      [&] {
        simulation.set("/walls/lid/motion",
                       {{"velocity", {0, 0, 1}}, {"servo", {{"axis", "x"}, {"pressure", 1}, {"max_velocity", 1}}}});
      },
      ThrowsMessage<DescriptionError>(HasSubstr("set: /walls/lid/motion/servo: ")));
  EXPECT_THROW(simulation.set("/walls/lid/edge_a", {0, 0, 0}), DescriptionError);
  simulation.set("/guards/overlap", 0.5), undisturbed.set("/guards/overlap", 0.5);
  simulation.run(), undisturbed.run();
  EXPECT_EQ(simulation.world().walls()[1].position.z(), 0) << "the lid has not moved";
  EXPECT_TRUE(same(positions(simulation), positions(undisturbed)));
}

TEST(OptionsOfASimulation, AreNamedInErrors) {
  SimulationOptions wrong = options();
  wrong.sets = {"/sed=3"};
  EXPECT_THAT([&] { Simulation(bounce(), wrong); }, ThrowsMessage<DescriptionError>(HasSubstr("sets: /sed: ")));
  wrong = {.plugin_path = {"/nowhere"}};
  EXPECT_THAT([&] { Simulation(bounce(), wrong); },
              ThrowsMessage<FileError>(HasSubstr("plugin_path: found \"/nowhere\", which does not exist")));
  wrong.plugin_path = {testing::TempDir() + "grit_no_plugins"};
  std::filesystem::create_directory(wrong.plugin_path.front());
  EXPECT_THAT([&] { Simulation(bounce(), wrong); },
              ThrowsMessage<FileError>(HasSubstr("which has none of the folders bodies, contacts")));
  Description unknown = bounce();
  unknown["contacts"]["type"] = "sticky";
  EXPECT_THAT([&] { Simulation(unknown, options()); },
              ThrowsMessage<DescriptionError>(HasSubstr("plugin_path=DIR or GRIT_PLUGIN_PATH=DIR adds DIR/contacts")));
}

}  // namespace
}  // namespace grit::test::failed_simulation_tests
