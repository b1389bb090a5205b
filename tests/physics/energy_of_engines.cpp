// Work of engines that hold or push bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "energy_balance.hpp"
#include "grit/plugin.hpp"
#include "support/clump.hpp"
#include "support/verified.hpp"

namespace grit::test::energy_balance_tests {
namespace {

Description hold(bool translation, bool rotation) {
  return {{"type", "hold"}, {"translation", translation ? "xyz" : "none"}, {"rotation", rotation ? "xyz" : "none"}};
}

TEST(Energies, WhatHoldsGrainsPressesTheirSpring) {
  const double speed = 0.1, modulus = 1e8;
  Description d = grains("linear-rolling", {{"contact_modulus", modulus}},
                         {{Vec3::Zero(), radius, {speed, 0, 0}}, {{2 * radius, 0, 0}, radius, {-speed, 0, 0}}});
  d["engines"]["hold"] = hold(true, true);
  Kept pair(d);
  pair.step(1000);
  const Energies now = pair.world().energies();
  const double overlap = 2 * speed * pair.world().time(), stored = 0.5 * modulus * radius * overlap * overlap;
  EXPECT_EQ(now.kinetic, 2 * kinetic_at(speed)) << "the spring does not act on them";
  verify("work of what holds two grains at their speeds over what their spring stores", now.engines / stored, 1, 1e-9);
  EXPECT_LE(std::abs(now.closure_error), 1e-9 * stored);
}

TEST(Energies, WhatHoldsAGrainLiftsIt) {
  for (const bool clumped : {false, true}) {
    Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius, {0.5, 0, 2}}});
    if (clumped) make_clumps(d, boomerang());
    d["engines"]["gravity"] = {{"type", "gravity"}};
    d["engines"]["hold"] = hold(true, false);
    d["time_step"]["value"] = fall_step;
    Kept lift(d);
    lift.step(1000);
    const Energies now = lift.world().energies();
    const double height = 2 * lift.world().time();
    EXPECT_NEAR(now.engines, lift.mass(0) * 9.81 * height, 1e-10 * now.engines);
    EXPECT_LE(std::abs(now.closure_error), 1e-10 * now.engines);
  }
}

TEST(Energies, WhatHoldsASpinRubs) {
  const double overlap = 1e-5 * radius, spin = 50, angle = 0.2, modulus = 1e8, shear = 0.3;
  Description d =
      grains("linear-frictional",
             {{"contact_modulus", modulus}, {"friction_angle", angle}, {"shear_to_normal_stiffness", shear}},
             {{{0, 0, radius - overlap}, radius, Vec3::Zero(), {0, spin, 0}}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["hold"] = hold(true, true);
  Kept rub(d);
  rub.step(3000);
  const Energies now = rub.world().energies();
  const double stiffness = modulus * radius, limit = std::tan(angle) * stiffness * overlap;
  const double way = spin * radius * rub.world().time(), loaded = limit / (shear * stiffness);
  ASSERT_GT(way, 10 * loaded);
  verify("work of what holds a spin against friction", now.engines, limit * (way - 0.5 * loaded), 1e-3);
  EXPECT_GT(now.friction, 0.9 * now.engines);
  verify("closure error over the work of what holds a spin against friction", now.closure_error / now.engines, 0, 1e-4,
         1.0);
}

// A held clump continues to rotate with constant momentum; its spheres compress the wall and slide on it in turn.
TEST(Energies, WhatHoldsAClumpPressesAndRubs) {
  for (const double friction : {0.0, 0.2}) {
    Description d = grains("linear-frictional", {{"contact_modulus", 1e7}, {"friction_angle", friction}},
                           {{{0, 0, 0.66 * radius}, radius, {0.3, 0, -0.01}, {20, 30, 40}}});
    make_clumps(d, boomerang());
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["engines"]["hold"] = hold(true, true);
    d["time_step"]["value"] = 1e-6;
    d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
    Kept clump(d);
    clump.step(4000);
    const Energies now = clump.world().energies();
    EXPECT_GT(now.elastic(), 0.1 * now.engines);
    if (friction > 0) EXPECT_GT(now.friction, 0.1 * now.engines);
    verify(std::string("closure error over the work of what holds a clump on a ") +
               (friction > 0 ? "rough" : "smooth") + " floor",
           now.closure_error / now.engines, 0, friction > 0 ? 5e-3 : 1e-4, 1.0);
  }
}

TEST(Energies, IsWholeAfterBodiesAreLetGo) {
  Description d = grains("linear-rolling", {},
                         {{Vec3::Zero(), radius, {0.1, 0, 0}}, {{1.995 * radius, 0, 0}, radius, {-0.1, 0.05, 0}}});
  d["engines"]["hold"] = hold(true, true);
  d["stages"].push_back({{"name", "free"},
                         {"change", {{"engines", {{"hold", nullptr}}}}},
                         {"until", {{"type", "steps"}, {"value", 1}}},
                         {"limit", 1}});
  Kept pair(d);
  pair.step(100);
  const Energies held = pair.world().energies();
  pair.begin_stage(1, "free");
  pair.kernel().find_forces();
  pair.step(3000);
  const Energies now = pair.world().energies();
  EXPECT_GT(held.engines, 0.1 * held.elastic());
  EXPECT_NEAR(now.engines, held.engines, 0.05 * held.engines) << "half a step of the last hundred";
  EXPECT_LE(closure_fraction(now), 1e-3);
}

TEST(Energies, WhatHoldsBodiesAtRestDoesNothing) {
  Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius}, {{1.99 * radius, 0, 0}, radius}});
  d["engines"]["hold"] = hold(true, true);
  Kept pair(d);
  pair.step(100);
  const Energies now = pair.world().energies();
  EXPECT_GT(now.elastic(), 0);
  EXPECT_EQ(now.engines, 0);
  EXPECT_EQ(now.kinetic, 0);
  EXPECT_EQ(now.closure_error, 0);
}

/// Applies the forces of a test to bodies.
struct Push final : Engine {
  using Act = std::function<void(const World&, std::span<Row> force, std::span<Row> moment)>;
  static inline Act act;
  void declare(Parameters&) override {}
  Phase phase() const override { return Phase::forces; }
  void forces(const World& world, std::span<Row> force, std::span<Row> moment) const override {
    act(world, force, moment);
  }
};
void pushed(Description& d, Push::Act act) {
  static const PluginInfo info = [] {
    PluginInfo push;
    push.kind = "engine", push.name = "push", push.version = "1.0.0", push.doc = "for tests";
    push.make_engine = []() -> Engine* { return new Push; };
    return push;
  }();
  installed().add(info);
  Push::act = std::move(act);
  d["engines"]["push"] = {{"type", "push"}};
}

TEST(Energies, AConstantForceDoesItsWorkAlongTheWay) {
  const Vec3 push(2e-3, -1e-3, 3e-3);
  Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius, {0, 0.1, 0}}});
  d["time_step"]["value"] = fall_step;
  pushed(d, [=](const World&, std::span<Row> force, std::span<Row>) {
    for (Row& one : force) one += Row{push.x(), push.y(), push.z(), 0};
  });
  Kept way(d);
  way.step(1000);
  const Energies now = way.world().energies();
  verify("work of an engine's constant force over force times way", now.engines / push.dot(way.position(0)), 1, 1e-12);
  EXPECT_LE(std::abs(now.closure_error), 1e-12 * now.engines);
}

/// A body on a spring of an engine that is switched on and off: closure error over the largest work.
double closure_in_a_spring(double dt, bool clumped, const Vec3& strain_rate = Vec3::Zero()) {
  const double stiffness = 1, frequency = 300;
  Description d = periodic("linear-rolling", {}, {{Vec3(0.0196, 0.01, 0.01), radius, {0.5, 0, 1}, {100, 200, -300}}},
                           Vec3::Constant(0.02), strain_rate);
  if (clumped) make_clumps(d, boomerang());
  d["time_step"]["value"] = dt;
  d["guards"]["travel"] = 0.2;
  pushed(d, [=](const World& world, std::span<Row> force, std::span<Row> moment) {
    const double now = stiffness * (1 + 0.5 * std::sin(frequency * world.time()));
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (world.ids()[i] != 0) continue;  // only one sphere of a clump
      const Vec3 pull = now * (Vec3::Constant(0.01) - xyz(world.positions()[i]));
      force[i] = {pull.x(), pull.y(), pull.z(), 0}, moment[i] = {1e-9, -2e-9, 3e-9, 0};
    }
  });
  Kept swing(d);
  double largest = 0;
  while (swing.world().time() < 0.02) swing.step(), largest = std::max(largest, swing.world().energies().engines);
  return std::abs(swing.world().energies().closure_error) / largest;
}

TEST(Energies, ClosesAroundAnEnginesSpring) {
  for (const bool clumped : {false, true})
    for (const bool strained : {false, true}) {
      const Vec3 rate = strained ? Vec3(-20, 15, 10) : Vec3::Zero();
      const double coarse = closure_in_a_spring(1e-6, clumped, rate), fine = closure_in_a_spring(5e-7, clumped, rate);
      const std::string what = std::string(clumped ? "a clump" : "a sphere") + " in an engine's spring" +
                               (strained ? ", in a cell that strains" : "");
      verify("closure error of " + what + ", over the engine's work", fine, 0, 1e-6, 1.0);
      if (strained) EXPECT_LE(fine, 0.4 * coarse);
      else verify("closure error of " + what + ", over that at half of the step", coarse / fine, 4, 0.05);
    }
}

}  // namespace
}  // namespace grit::test::energy_balance_tests
