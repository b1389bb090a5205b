// Drag of a fluid against closed forms.
#include "motion/drag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/testing/reading.hpp"
#include "support/clump.hpp"
#include "support/scene.hpp"

namespace grit::test::drag_tests {
namespace {

constexpr double radius = 1e-3, density = 2600, g = 9.81, pi = std::numbers::pi;
constexpr double mass = density * 4.0 / 3.0 * pi * radius * radius * radius;

Description sinking(const Description& drag) {
  Description d = description("linear-frictional", {{"density", density}, {"contact_modulus", 1e5}},
                              {{{0, 0, 0}, radius, Vec3::Zero(), {0, 10, 0}}});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["fluid"] = drag;
  d["engines"]["fluid"]["type"] = "drag";
  return d;
}

Drag drag_of(const Description& keys) {
  Drag drag;
  Parameters parameters;
  drag.declare(parameters);
  EXPECT_TRUE(read_parameters(keys, parameters).empty());
  return drag;
}

TEST(Drag, OfStokesSlowsASphereExponentially) {
  constexpr double viscosity = 0.1, c = 6 * pi * viscosity * radius;
  Description d = sinking({{"viscosity", viscosity}, {"law", "stokes"}});
  d["time_step"]["value"] = 1e-6;
  Trial t(d);
  while (t.world().time() < 0.5 * mass / c) t.step();
  const double now = t.world().time(), expected = -mass * g / c * (1 - std::exp(-c * now / mass));
  EXPECT_NEAR(t.velocity(0).z(), expected, 1e-3 * std::abs(expected));
  const double inertia = 0.4 * mass * radius * radius,
               spin = 10 * std::exp(-8 * pi * viscosity * std::pow(radius, 3) * now / inertia);
  EXPECT_NEAR(t.spin(0).y(), spin, 3e-3 * spin);
}

TEST(Drag, OfSchillerAndNaumann) {
  const Drag drag = drag_of({{"viscosity", 1e-3}, {"density", 1000}});
  constexpr double diameter = 1e-3, stokes = 3 * pi * 1e-3 * diameter;
  const auto factor = [&](double reynolds) { return drag.coefficient(diameter, reynolds * 1e-3) / stokes; };
  EXPECT_NEAR(factor(1e-9), 1, 1e-6);
  EXPECT_NEAR(factor(100), 1 + 0.15 * std::pow(100, 0.687), 1e-12);
  EXPECT_NEAR(factor(1e5), 0.44 * 1e5 / 24, 1e-9) << "Newton's regime";
  EXPECT_NEAR(factor(1000 * (1 + 1e-9)), factor(1000), 1e-6) << "continuous";
  EXPECT_GE(factor(999), factor(998));
}

TEST(Drag, LimitsTheTimeStep) {
  constexpr double viscosity = 50, c = 6 * pi * viscosity * radius;
  Trial t(sinking({{"viscosity", viscosity}, {"law", "stokes"}}));
  EXPECT_LT(t.world().dt(), 2 * mass / c);
  t.step(2000);
  EXPECT_NEAR(t.velocity(0).z(), -mass * g / c, 1e-9 * mass * g / c);
}

TEST(Drag, MovesBodiesWithTheFluid) {
  Description d = sinking({{"viscosity", 0.02}, {"velocity", {3, 0, 0}}});
  d["engines"].erase("gravity");
  Trial t(d);
  while (t.world().time() < 2) t.step();
  EXPECT_NEAR(t.velocity(0).x(), 3, 1e-6);
}

TEST(Drag, OfAClumpIsThatOfASphereOfItsVolume) {
  Description d = sinking({{"viscosity", 0.1}, {"law", "stokes"}});
  make_clumps(d, listed({ball({0, 0, 0}, 1.0), ball({1.5, 0, 0}, 1.0)}));
  Trial t(d);
  while (t.world().time() < 2) t.step();
  const ClumpView& clump = t.world().clumps()[0];
  const double diameter = std::cbrt(6 * clump.mass / density / pi);
  EXPECT_NEAR(clump.velocity.z(), -clump.mass * g / (3 * pi * 0.1 * diameter), 1e-3 * std::abs(clump.velocity.z()));
}

}  // namespace
}  // namespace grit::test::drag_tests
