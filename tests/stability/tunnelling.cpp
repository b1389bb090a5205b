// The speed at which a grain passes through a thin wall or another grain within a step, and that the guard stops it
// long before.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grit/error.hpp"
#include "support/mapped.hpp"
#include "support/scene.hpp"

namespace grit::test::tunnelling_tests {
namespace {

constexpr double radius = 1e-3, dt = 1e-6;

/// A grain that moves with `travel` radii per step towards a thin wall or a heavy grain; the contact is so stiff that
/// it reflects the grain within one or two steps. `offset`: initial phase of a step.
Description shot(bool at_wall, double travel, double offset) {
  const double speed = travel * radius / dt;
  std::vector<Grain> grains{{Vec3(0, 0, 3 * radius + offset * speed * dt), radius, {0, 0, -speed}}};
  if (!at_wall) grains.push_back({Vec3(0, 0, 0), radius});
  Description d =
      description("linear-frictional", {{"contact_modulus", 1e9}, {"density", 2500}, {"friction_angle", 0}}, grains);
  if (at_wall)
    d["walls"]["sheet"] = {{"type", "rectangle"},
                           {"corner", {-1, -1, 0}},
                           {"edge_a", {2, 0, 0}},
                           {"edge_b", {0, 2, 0}},
                           {"material", "grain"}};
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
  d["guards"] = {{"energy", 1e99}, {"travel", 1e9}, {"overlap", 1e9}};
  return d;
}

/// Fraction of 40 shots with different phases of a step that have a contact.
double seen(bool at_wall, double travel) {
  constexpr int shots = 40;
  int count = 0;
  for (int i = 0; i < shots; ++i) {
    Trial t(shot(at_wall, travel, static_cast<double>(i) / shots));
    bool touched = false;
    for (int step = 0; step * travel < 8 && !touched; ++step) t.step(), touched = !t.world().contacts().empty();
    count += touched ? 1 : 0;
  }
  return static_cast<double>(count) / shots;
}

/// Displacements per step at which grains start to pass an obstacle of `thick` radii.
void expect_limit(bool at_wall, double thick) {
  EXPECT_EQ(seen(at_wall, 0.97 * thick), 1) << "none is missed below";
  EXPECT_LT(seen(at_wall, 1.06 * thick), 1) << "some are above";
  const auto& map = "share of shots whose contact is seen|way in a step, in radii";
  const std::string name = at_wall ? "thin wall" : "grain";
  for (double travel = 0.25; travel <= 16; travel *= std::sqrt(2.0)) {
    const double share = seen(at_wall, travel), predicted = std::min(1.0, thick / travel);
    EXPECT_NEAR(share, predicted, 0.03);
    map_point(map, name, travel, share);
    map_point(map, "predicted, " + name, travel, predicted);
  }
}

TEST(Tunnelling, ThroughAThinWallBeginsAtADiameterAStep) { expect_limit(true, 2); }
TEST(Tunnelling, ThroughAnotherGrainBeginsAtTwoDiametersAStep) { expect_limit(false, 4); }

TEST(Tunnelling, IsStoppedByTheGuardFortyTimesEarlier) {
  const auto stopped = [](bool at_wall, double travel) {
    Description d = shot(at_wall, travel, 0);
    d["guards"] = {{"energy", 1e99}, {"overlap", 1e9}};
    try {
      Trial(d).step(5);
    } catch (const NumericsError&) {
      return true;
    }
    return false;
  };
  for (const bool at_wall : {true, false}) {
    double low = 0.01, high = 1;
    while (high > 1.0005 * low) {
      const double middle = std::sqrt(low * high);
      (stopped(at_wall, middle) ? high : low) = middle;
    }
    EXPECT_NEAR(low, 0.05, 1e-4);
    figure("way in a step that the travel guard allows, in radii", low);
  }
}

}  // namespace
}  // namespace grit::test::tunnelling_tests
