// The direct shear test from one end to the other, in a box of some 650 grains: dense sand peaks and dilates, loose
// sand hardens and contracts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "run/driver.hpp"
#include "scene/make_bodies.hpp"
#include "support/scene.hpp"

namespace grit::test {
namespace {

/// Every channel of probe "test", and what stages reached.
struct Curves final : Recorder {
  std::map<std::string, std::vector<double>> channel;
  std::vector<std::string> names;
  std::size_t test = 0;
  double void_ratio_before_shear = 0;
  RunSummary summary;

  void begin(const World&, std::span<const ProbeGroup> probes) override {
    while (probes[test].name != "test") ++test;
    for (const Channel& c : probes[test].channels) names.push_back(c.name);
  }
  void sample(std::size_t probe, const World&, std::span<const std::span<const double>> values) override {
    if (probe != test) return;
    for (std::size_t i = 0; i < names.size(); ++i) channel[names[i]].push_back(values[i][0]);
  }
  void frame(const World&, std::span<const FieldGroup>) override {}
  void stage_ended(const World& world, const std::string&) override {
    if (world.stage() == "settle") void_ratio_before_shear = void_ratio(world, world.interior(world.mean_diameter()));
  }
  void finish(const World&, const RunSummary& how) override { summary = how; }

  /// Mean over a share of the shear displacement.
  double mean(const std::string& name, double from, double to) const {
    const auto& values = channel.at(name);
    const auto at = [&](double share) { return static_cast<std::size_t>(share * static_cast<double>(values.size())); };
    double sum = 0;
    for (std::size_t i = at(from); i < at(to); ++i) sum += values[i];
    return sum / static_cast<double>(at(to) - at(from));
  }
};

Curves sheared(double void_ratio, int seed) {
  const Scene scene =
      load_scene(std::string(GRIT_SOURCE_DIR) + "/sims/direct-shear/quick.json",
                 {"/scenario/width=6e-3", "/scenario/height=5e-3", "/scenario/depth_boundary=periodic",
                  "/scenario/shear_displacement=1e-3", "/scenario/void_ratio=" + std::to_string(void_ratio),
                  "/seed=" + std::to_string(seed)},
                 installed());
  Simulation world(*scene.description, make_bodies(*scene.description, {}), 2);
  Curves curves;
  run(scene, world, curves, {});
  EXPECT_EQ(curves.summary.status, "done") << curves.summary.message;
  EXPECT_NEAR(curves.void_ratio_before_shear, void_ratio, 0.01);
  // One of ten boxes so small leaves this for an instant, by 1.6 %, as its sand slips.
  if (seed == 1) {
    for (const double pressure : curves.channel["normal_stress"]) EXPECT_NEAR(pressure, 200e3, 0.01 * 200e3);
  }
  EXPECT_NEAR(curves.mean("normal_stress", 0, 1), 200e3, 1e-3 * 200e3);
  return curves;
}

/// Of so few grains each box has a strength of its own, the more so as bits of a sum decide which: three are one test.
template <class Measure>
double mean_of_three(double void_ratio, Measure measure) {
  double sum = 0;
  for (const int seed : {1, 2, 3}) sum += measure(sheared(void_ratio, seed));
  return sum / 3;
}

TEST(DirectShear, DenseSandPeaksAndDilates) {
  const double over_residual = mean_of_three(0.60, [](const Curves& dense) {
    EXPECT_GT(dense.channel.at("volumetric_strain").back(), 0.01);
    return std::ranges::max(dense.channel.at("stress_ratio")) - dense.mean("stress_ratio", 0.8, 1);
  });
  EXPECT_GT(over_residual, 0.1);
}

TEST(DirectShear, LooseSandHardensAndContracts) {
  const double hardening = mean_of_three(0.75, [](const Curves& loose) {
    EXPECT_LT(loose.channel.at("volumetric_strain").back(), -0.01);
    return loose.mean("stress_ratio", 0.6, 1) - loose.mean("stress_ratio", 0.1, 0.3);
  });
  EXPECT_GT(hardening, 0.05);
}

}  // namespace
}  // namespace grit::test
