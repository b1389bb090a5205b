// Springs whose stiffness grows with overlap, at the default step: compression follows Hertz's force, and impacts,
// falls and pouring gain no energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/mapped.hpp"
#include "support/packing.hpp"

namespace grit::test::stiffening_tests {
namespace {

using std::numbers::pi;

constexpr double radius = 1e-3, density = 2500, poisson = 0.3;
const double mass = density * 4 / 3 * pi * radius * radius * radius;

Description glass(double young, double restitution) {
  return {{"density", density},
          {"young_modulus", young},
          {"poisson_ratio", poisson},
          {"friction_angle", 0},
          {"restitution", restitution}};
}

/// Hertzian force of a sphere and a wall of the same material [N].
double hertz(double young, double r, double overlap) {
  return 4.0 / 3 * young / (2 * (1 - poisson * poisson)) * std::sqrt(r) * std::pow(std::max(overlap, 0.0), 1.5);
}

/// A ball between a floor and a descending lid; both are small.
Description press(double young, double speed) {
  const Vec3 low = Vec3::Constant(-2 * radius), high = Vec3::Constant(2 * radius);
  Description d = description("hertz-mindlin", glass(young, 1), {{{0, 0, radius}, radius}});
  d["walls"]["floor"] = side(2, 0, low, high, true), d["walls"]["lid"] = side(2, 2 * radius, low, high, false);
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -speed};
  return d;
}

/// So slow that the ball hardly oscillates between them [m/s].
double slow(double young, double deepest) {
  const double period = 2 * pi / std::sqrt(3 * hertz(young, radius, deepest) / deepest / mass);
  return 2 * deepest / (3000 * period);
}

/// Compresses to this overlap at both walls; returns the maximum error of their forces relative to Hertz.
double error_of_pressing(const Description& d, double young, double deepest) {
  const double speed = slow(young, deepest), least = 0.02 * hertz(young, radius, deepest);
  Trial t(d);
  double error = 0;
  while (t.world().time() * speed < 2 * deepest) {
    t.step();
    const double force = hertz(young, radius, 0.5 * speed * t.world().time());
    for (const WallView& wall : t.world().walls())
      if (wall.name == "floor" || wall.name == "lid")
        error = std::max(error, std::abs(wall.force.norm() - force) / std::max(force, least));
  }
  EXPECT_GT(t.world().step(), 5000u);
  return error;
}

TEST(Stiffening, WhatIsPressedPushesBackAsHertzSays) {
  double most = 0;
  for (const double young : {1e7, 70e9})
    for (const double deepest : {2e-4, 1e-3, 1e-2}) {
      const double error = error_of_pressing(press(young, slow(young, deepest * radius)), young, deepest * radius);
      EXPECT_LT(error, 0.01) << young << ' ' << deepest;
      most = std::max(most, error);
    }
  figure("error of the force of what is pressed from first touch on", most);
}

TEST(Stiffening, AnotherThatIsPressedHarderHidesNothing) {
  constexpr double young = 1e9, deepest = 2e-3 * radius, large = 10 * radius, squeezed = 5e-3 * large;
  Description d = press(young, slow(young, deepest));
  d["bodies"]["grains"]["source"]["bodies"].push_back(
      {{"position", {5 * large, 0, large - squeezed}}, {"radius", large}});
  const Vec3 low(4 * large, -large, 0), high(6 * large, large, 0);
  d["walls"]["low"] = side(2, 0, low, high, true);
  d["walls"]["high"] = side(2, 2 * (large - squeezed), low, high, false);
  EXPECT_LT(error_of_pressing(d, young, deepest), 0.01);
}

TEST(Stiffening, WhatFallsComesBackNoHigher) {
  double most = 0;
  for (const double restitution : {1.0, 0.9, 0.5})
    for (const double height : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
      Description d = description("hertz-mindlin", glass(1e9, restitution), {{{0, 0, radius + height}, radius}});
      d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
      d["engines"]["gravity"] = {{"type", "gravity"}};
      Trial t(d);
      // To the top of its first bounce.
      bool touched = false;
      while (!touched || t.velocity(0).z() > 0) t.step(), touched = touched || t.position(0).z() < radius;
      const double rise = (t.position(0).z() - radius) / height;
      EXPECT_LT(rise, restitution * restitution + 0.1) << restitution << ' ' << height;
      most = std::max(most, rise - restitution * restitution);
    }
  figure("height that is gained by a fall", most);
}

/// Closure error of the energy balance of grains that fall into a box and come to rest, over their initial energy.
double closure_of_a_pour(double young, double restitution) {
  Description m = glass(young, restitution);
  m["friction_angle"] = 0.4, m["poisson_ratio"] = 0.25;
  std::vector<Grain> grains = jumble({3, 3, 5}, 3.3e-3, 0.1, 3);
  for (Grain& g : grains) g.radius *= 0.8;
  Description d = description("hertz-mindlin", m, grains);
  const Vec3 low = Vec3::Zero(), high(10e-3, 10e-3, 60e-3);
  const char* const names[3][2] = {{"left", "right"}, {"front", "back"}, {"floor", "lid"}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][names[axis][up ? 0 : 1]] = side(axis, up ? low[axis] : high[axis], low, high, up);
  d["engines"]["gravity"] = {{"type", "gravity"}};
  Trial t(d, 1, BodyState::energy);
  t.world().energies();
  while (t.world().time() < 0.1) t.step();
  const Energies now = t.world().energies();
  EXPECT_GT(now.viscosity, 0.02 * -now.gravitational);
  EXPECT_GT(t.kernel().state().pairs.touching_count(), 30u);
  return std::abs(now.closure_error / now.gravitational);
}

TEST(Stiffening, WhatIsPouredGainsNothing) {
  double most = 0;
  for (const double young : {1e8, 1e9})
    for (const double restitution : {0.6, 0.9}) {
      const double closure = closure_of_a_pour(young, restitution);
      EXPECT_LT(closure, 0.03) << young << ' ' << restitution;
      most = std::max(most, closure);
    }
  figure("closure error of what is poured", most);
}

/// State of a packing after compression by its walls.
struct Pressed {
  double force;        ///< on a wall [N]
  double closure;      ///< error of the energy balance over the work of walls
  double equilibrium;  ///< kinetic over elastic energy
};

/// A cubic packing of 125 grains, compressed by its walls from first contact on. Next to it one grain bounces between
/// two plates that soon bring it to rest: its first impact sets the step, for about the final overlap of the packing,
/// and later displacements are too small for a new evaluation. For that, the packing starts without overlaps, and the
/// plates have little damping, as both would require a shorter step. `safety` 0: the default.
Pressed pressed_packing(double safety) {
  constexpr double young = 1e8, deepest = 3e-3 * radius, inwards = 6e-5, rattling = 0.0262, gap = 3e-7;
  constexpr int sides = 5;
  Description m = glass(young, 1);
  m["friction_angle"] = 0.4;
  Random random(7);
  const auto about = [&](double size) { return size * (2 * random.uniform() - 1); };
  std::vector<Grain> grains;
  for (int x = 0; x < sides; ++x)
    for (int y = 0; y < sides; ++y)
      for (int z = 0; z < sides; ++z)
        grains.push_back({radius * Vec3(2 * x + 1, 2 * y + 1, 2 * z + 1), radius + about(1e-3 * deepest)});
  Description d = description("hertz-mindlin", m, grains);
  d["materials"]["plates"] = glass(young, 0.8);
  const Vec3 low = Vec3::Zero(), high = Vec3::Constant(2 * sides * radius), apart = 30 * radius * Vec3::UnitX();
  d["bodies"]["lone"] = d["bodies"]["grains"];
  d["bodies"]["lone"]["material"] = "plates";
  d["bodies"]["lone"]["source"]["bodies"] =
      Description::array({{{"position", vector(apart + Vec3(radius, radius, radius + gap))},
                           {"radius", radius},
                           {"velocity", {0, 0, rattling}}}});
  const Vec3 wide = apart + Vec3::Constant(2 * radius);
  d["walls"]["below"] = side(2, 0, apart, wide, true, "plates");
  d["walls"]["above"] = side(2, 2 * radius + 2 * gap, apart, wide, false, "plates");
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false}) {
      Description& wall = d["walls"][std::string(up ? "low_" : "high_") + "xyz"[axis]];
      wall = side(axis, up ? low[axis] : high[axis], low, high, up);
      wall["motion"]["velocity"] = vector((up ? inwards : -inwards) * Vec3::Unit(axis));
    }
  if (safety > 0) d["time_step"]["safety"] = safety;
  Trial t(d, 1, BodyState::energy);
  t.world().energies();
  // The displacement of a wall is divided among the contacts along an axis.
  while (inwards * t.world().time() < 0.5 * sides * deepest) t.step();
  const Energies now = t.world().energies();
  double force = 0;
  for (const WallView& wall : t.world().walls())
    if (wall.name.starts_with("low_") || wall.name.starts_with("high_")) force += wall.force.norm() / 6;
  return {force, std::abs(now.closure_error / now.walls), now.kinetic / now.elastic()};
}

// A packing requires a shorter step than two grains with the same overlap: 20 k_s/m, not 7. If the step were set again
// only from half of the impact's overlap on, instead of 0.15, the error of the energy balance would be 4 % of the
// walls' work and the forces on the walls 4 % lower; at 0.4 there is no effect.
TEST(Stiffening, PackingThatIsPressedPushesBackAsAtATenthOfTheStep) {
  const Pressed usual = pressed_packing(0), fine = pressed_packing(0.08);
  for (const Pressed& one : {usual, fine}) {
    EXPECT_LT(one.closure, 1e-4);
    EXPECT_LT(one.equilibrium, 1e-4);
  }
  EXPECT_NEAR(usual.force / fine.force, 1, 1e-3);
  figure("error of the force of a packing that is pressed", std::abs(usual.force / fine.force - 1));
  EXPECT_GT(usual.force, 25 * 0.5 * hertz(1e8, radius, 1.5e-3 * radius)) << "compressed";
}

}  // namespace
}  // namespace grit::test::stiffening_tests
