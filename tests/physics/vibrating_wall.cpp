// Sinusoidal oscillation of walls, and their effect on grains.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/error.hpp"
#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::vibrating_wall_tests {
namespace {

constexpr double radius = 1e-3, gravity = 9.81, frequency = 40, omega = 2 * std::numbers::pi * frequency;

/// A grain on a plate that starts at its lowest point with an upward acceleration of `strength` × g.
Description on_a_plate(double strength, double restitution) {
  const double modulus = 1e8, stiffness = modulus * radius,
               weight = 2500 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3) * gravity;
  Description d =
      description("linear-frictional", {{"density", 2500}, {"contact_modulus", modulus}, {"restitution", restitution}},
                  {{{0, 0, radius - weight / stiffness}, radius}});
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -gravity}}};
  d["walls"]["plate"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["plate"]["motion"]["oscillation"] = {{"amplitude", {0, 0, strength * gravity / (omega * omega)}},
                                                  {"frequency", frequency},
                                                  {"phase", -0.5 * std::numbers::pi}};
  return d;
}

/// Time without contact over some periods, and the time of the first loss of contact [periods].
struct Flight {
  double first = HUGE_VAL;
  std::size_t steps = 0;
};
Flight flight(Trial& trial, double periods) {
  Flight found;
  while (trial.world().time() * frequency < periods) {
    trial.step();
    if (!trial.world().contacts().empty()) continue;
    found.first = std::min(found.first, trial.world().time() * frequency);
    ++found.steps;
  }
  return found;
}

TEST(VibratingWall, IsLeftByAGrainWhereItAcceleratesDownwardsFasterThanGravity) {
  for (const double strength : {0.5, 0.98}) {
    Trial trial(on_a_plate(strength, 0.1));
    EXPECT_EQ(flight(trial, 6).steps, 0u) << strength;
  }
  for (const double strength : {1.02, 2.0}) {
    Trial trial(on_a_plate(strength, 0.1));
    const Flight found = flight(trial, 6);
    EXPECT_GT(found.steps, 0u) << strength;
    // From the lowest point to A ω² sin(ψ) = g.
    verify("period in which a grain leaves a plate that vibrates at " + std::string(strength < 1.5 ? "1.02 g" : "2 g"),
           found.first, 0.25 + std::asin(1 / strength) / (2 * std::numbers::pi), 3e-3);
  }
}

TEST(VibratingWall, ThrowsAGrainAsFarAsItsSpeedSays) {
  const double strength = 3, amplitude = strength * gravity / (omega * omega);
  Trial trial(on_a_plate(strength, 0.1));
  const double leaves = std::asin(1 / strength), speed = amplitude * omega * std::cos(leaves);
  const double height = amplitude * (1 + std::sin(leaves)) + speed * speed / (2 * gravity);
  double highest = 0;
  while (trial.world().time() * frequency < 1) {
    trial.step();
    highest = std::max(highest, trial.position(0).z() - radius);
  }
  verify("height to which a plate that vibrates at 3 g throws a grain [m]", highest, height, 2e-3);
}

TEST(VibratingWall, PutsInAsMuchEnergyAsIsLost) {
  Description d = on_a_plate(4, 0.6);
  d["time_step"]["safety"] = 0.02;
  Trial bouncing(d, 1, BodyState::energy);
  bouncing.world().energies();
  while (bouncing.world().time() * frequency < 20) bouncing.step();
  const Energies now = bouncing.world().energies();
  EXPECT_GT(now.walls, 0);
  EXPECT_GT(now.viscosity, 0.5 * now.walls);
  verify("closure error over the work of a plate on which a grain bounces", now.closure_error / now.walls, 0, 1e-3,
         1.0);
}

/// A floor that rocks about its middle, with a ball that rolls back and forth.
TEST(VibratingWall, ThatRocksClosesTheEnergyBalance) {
  Description d = on_a_plate(1, 0.3);
  d["materials"]["grain"]["friction_angle"] = 0.5;
  d["walls"]["plate"]["motion"] = {
      {"about", {0, 0, -0.01}},
      {"oscillation", {{"angle", {0, 0.05, 0}}, {"frequency", frequency}, {"phase", -0.5 * std::numbers::pi}}}};
  Trial trial(d, 1, BodyState::energy);
  trial.world().energies();
  double turned = 0, kinetic = 0;
  while (trial.world().time() * frequency < 5) {
    trial.step();
    const WallView& plate = trial.world().walls()[0];
    turned = std::max(turned, std::abs(plate.normal.x()));
    kinetic = std::max(kinetic, trial.world().energies().kinetic);
  }
  EXPECT_NEAR(turned, std::sin(0.1), 1e-4) << "twice the amplitude, from one end";
  verify("closure error over the largest kinetic energy of a ball on a floor that rocks",
         trial.world().energies().closure_error / kinetic, 0, 1e-2, 1.0);
}

TEST(VibratingWall, ThatIsTooFastForTheStepIsRefused) {
  Description d = on_a_plate(1, 0.5);
  auto& oscillation = d["walls"]["plate"]["motion"]["oscillation"];
  oscillation["amplitude"] = {0, 0, 1e-9};
  d["time_step"] = {{"value", 1e-6}};
  oscillation["frequency"] = 49.9e3;
  EXPECT_NO_THROW(Trial{d});
  oscillation["frequency"] = 80e3;
  try {
    Trial trial(d);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "wall \"plate\": oscillates at 8e+04 Hz, with 12.5 steps of 1e-06 s per period; allowed is 20 "
                 "or more: lower the frequency, or shorten the time step by /time_step/safety or /time_step/value");
  }
}

}  // namespace
}  // namespace grit::test::vibrating_wall_tests
