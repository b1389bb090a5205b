// Engines that a program adds to those of the description.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "counted_components.hpp"
#include "grit/engine.hpp"
#include "grit/error.hpp"
#include "grit/simulation.hpp"
#include "support/scene.hpp"

namespace grit::test::added_engine_tests {
namespace {

constexpr double dt = 2e-5;

/// A force along z on each body.
struct Lift final : Engine {
  explicit Lift(double newtons, StateRequest request = {}, EngineRates bounds = {})
      : force(newtons), state(request), bound(bounds) {}
  void declare(Parameters&) override {}
  Phase phase() const override { return Phase::forces; }
  StateRequest needs() const override { return state; }
  void forces(const World& world, std::span<Row> forces, std::span<Row>) const override {
    if (world.step() == fails_at) throw std::logic_error("no more");
    for (Row& one : forces) one.z += force;
  }
  EngineRates rates(const World&) const override { return bound; }

  double force;
  StateRequest state;
  EngineRates bound;
  std::uint64_t fails_at = ~std::uint64_t{0};
};

/// A ball without weight, in two stages of 100 steps.
Description floating() {
  Description d = description("linear-frictional", {{"density", 2500}}, {{{0, 0, 0}, 5e-3}});
  d["time_step"] = {{"value", dt}};
  d["stages"] = Description::array({stage_of("first", 100), stage_of("second", 100)});
  return d;
}
SimulationOptions options() { return {.plugin_path = {GRIT_PLUGIN_DIR}}; }
double height(const Simulation& simulation) { return simulation.world().positions()[0].z; }
double speed(const Simulation& simulation) { return simulation.world().velocities()[0].z; }
const double mass = 2500 * 4.0 / 3.0 * M_PI * std::pow(5e-3, 3);

TEST(AddedEngine, ActsUntilItIsRemoved) {
  Simulation simulation(floating(), options());
  simulation.set_engine("lift", std::make_shared<Lift>(mass));
  simulation.step(100);
  EXPECT_NEAR(height(simulation), 0.5 * dt * dt * 100 * 100, 1e-15) << "1 m/s², through the first stage";
  simulation.set_engine("lift", std::make_shared<Lift>(-3 * mass));
  const double before = speed(simulation);
  simulation.step(10);
  EXPECT_NEAR(speed(simulation) - before, -3 * 10 * dt, 1e-12) << "the step that follows is taken with the new one";
  simulation.set_engine("lift", nullptr);
  const double after = speed(simulation);
  simulation.run();
  EXPECT_EQ(speed(simulation), after);
  EXPECT_THAT([&] { simulation.set_engine("lift", std::make_shared<Lift>(1)); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("the simulation is done")));
}

TEST(AddedEngine, IsKnownAtTheFirstInstant) {
  Simulation simulation(floating(), options());
  simulation.set_engine("lift", std::make_shared<Lift>(mass));
  simulation.check();
  EXPECT_EQ(simulation.world().forces()[0].z, mass);
}

TEST(AddedEngine, BoundsTheTimeStep) {
  Description d = floating();
  d["time_step"] = {{"safety", 0.5}};
  Simulation without(d, options()), with(d, options());
  const double critical = without.check().critical_time_step, stiffness = 64 / (critical * critical);
  with.set_engine("spring", std::make_shared<Lift>(0, StateRequest(), EngineRates{.stiffness = stiffness}));
  const Forecast forecast = with.check();
  EXPECT_LT(forecast.critical_time_step, 0.26 * critical) << "2/√(stiffness) alone";
  EXPECT_GT(forecast.critical_time_step, 0.2 * critical);
  EXPECT_LT(forecast.time_step, 0.5 * forecast.critical_time_step * 1.0001);
}

TEST(AddedEngine, IsAddedAgainBeforeASimulationResumes) {
  Simulation whole(floating(), options()), first(floating(), options());
  for (Simulation* one : {&whole, &first}) one->set_engine("lift", std::make_shared<Lift>(mass));
  whole.run();
  first.step(150);
  const Checkpoint saved = first.save();

  Simulation rest(floating(), options());
  rest.set_engine("lift", std::make_shared<Lift>(mass));
  rest.resume(saved);
  rest.run();
  EXPECT_EQ(height(rest), height(whole));
  EXPECT_EQ(speed(rest), speed(whole));

  const auto without = [&] { Simulation(floating(), options()).resume(saved); };
  EXPECT_THAT(without, testing::ThrowsMessage<Error>(testing::HasSubstr("engine \"lift\"")));
}

TEST(AddedEngine, RefusesNamesOfTheDescription) {
  Description d = floating();
  d["engines"]["gravity"] = {{"type", "gravity"}};
  Simulation simulation(d, options());
  EXPECT_THAT([&] { simulation.set_engine("gravity", nullptr); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("found an engine \"gravity\" in /engines")));
  simulation.step(1);
  EXPECT_LT(speed(simulation), 0) << "nothing has changed";

  d = floating();
  d["stages"][1]["change"]["engines"]["lift"] = {{"type", "gravity"}};
  Simulation later(d, options());
  later.set_engine("lift", std::make_shared<Lift>(mass));
  EXPECT_THAT([&] { later.run(); },
              testing::ThrowsMessage<DescriptionError>(testing::HasSubstr("the program has added before")));
}

TEST(AddedEngine, NeedsStateThatIsKept) {
  const auto lift = std::make_shared<Lift>(mass, BodyState::rotation);
  Simulation without(floating(), options());
  EXPECT_THAT([&] { without.set_engine("lift", lift); },
              testing::ThrowsMessage<Error>(
                  testing::HasSubstr("needs rotations, which this simulation does not keep; request this state")));
  SimulationOptions kept = options();
  kept.state = BodyState::rotation;
  Simulation with(floating(), kept);
  with.set_engine("lift", lift);
  with.step(1);
  EXPECT_GT(speed(with), 0);
}

TEST(AddedEngine, EndsTheSimulationWithItsException) {
  Simulation simulation(floating(), options());
  const auto lift = std::make_shared<Lift>(mass);
  lift->fails_at = 5;
  simulation.set_engine("lift", lift);
  EXPECT_THROW(simulation.run(), std::logic_error);
  EXPECT_THROW(simulation.step(), std::logic_error) << "bodies have moved, forces are unknown";
  EXPECT_THROW(simulation.set_engine("lift", nullptr), std::logic_error);
}

TEST(AddedEngine, ThatIsNotFiniteIsNamed) {
  Simulation simulation(floating(), options());
  simulation.set_engine("lift", std::make_shared<Lift>(std::nan("")));
  EXPECT_THAT([&] { simulation.run(); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("a force of the engine \"lift\" that is not finite")));
}

}  // namespace
}  // namespace grit::test::added_engine_tests
