// Complete direct shear tests in a box of about 650 grains: dense sand has a peak and dilates, loose sand hardens and
// contracts.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/curves.hpp"

namespace grit::test::direct_shear_tests {
namespace {

struct Sheared : Curves {
  double void_ratio_before_shear = 0;
  void stage_ended(const World& world, const std::string&) override {
    if (world.stage() == "settle") void_ratio_before_shear = void_ratio(world, world.interior(world.mean_diameter()));
  }
};

Sheared sheared(double void_ratio, int seed) {
  Sheared curves;
  run_to_the_end("sims/direct-shear/quick.json",
                 {"/scenario/width=6e-3", "/scenario/height=5e-3", "/scenario/depth_boundary=periodic",
                  "/scenario/shear_displacement=1e-3", "/scenario/void_ratio=" + std::to_string(void_ratio),
                  "/seed=" + std::to_string(seed), "/probes/energy=null"},
                 curves);
  EXPECT_NEAR(curves.void_ratio_before_shear, void_ratio, 0.01);
  // In one of ten such small boxes a slip event exceeds this briefly, by 1.6 %.
  if (seed == 1) {
    for (const double pressure : curves.channel["normal_stress"]) EXPECT_NEAR(pressure, 200e3, 0.01 * 200e3);
  }
  EXPECT_NEAR(curves.mean("normal_stress", 0, 1), 200e3, 1e-3 * 200e3);
  return curves;
}

/// With so few grains the strength scatters from box to box, even by round-off: each test is the mean of three.
template <class Measure>
double mean_of_three(double void_ratio, Measure measure) {
  double sum = 0;
  for (const int seed : {1, 2, 3}) sum += measure(sheared(void_ratio, seed));
  return sum / 3;
}

TEST(DirectShear, DenseSandPeaksAndDilates) {
  const double over_residual = mean_of_three(0.60, [](const Sheared& dense) {
    EXPECT_GT(dense.channel.at("volumetric_strain").back(), 0.01);
    return std::ranges::max(dense.channel.at("stress_ratio")) - dense.mean("stress_ratio", 0.8, 1);
  });
  EXPECT_GT(over_residual, 0.1);
}

TEST(DirectShear, LooseSandHardensAndContracts) {
  const double hardening = mean_of_three(0.75, [](const Sheared& loose) {
    EXPECT_LT(loose.channel.at("volumetric_strain").back(), -0.01);
    return loose.mean("stress_ratio", 0.6, 1) - loose.mean("stress_ratio", 0.1, 0.3);
  });
  EXPECT_GT(hardening, 0.05);
}

}  // namespace
}  // namespace grit::test::direct_shear_tests
