// A clump of two spheres held at one end, from nearly a sphere to a rod: the largest stable step, found from both
// sides, compared with the critical step of grit.
#include <gtest/gtest.h>

#include <cmath>

#include "support/clump.hpp"
#include "support/growth.hpp"
#include "support/mapped.hpp"
#include "support/packing.hpp"

namespace grit::test::clump_tests {
namespace {

constexpr double size = 1e-3, modulus = 1e7, trembling = 1e-9;

/// Radius of its spheres, and their distance from its centre.
double end_of(double spacing) { return size / (1 + spacing); }
double arm_of(double spacing) { return spacing * end_of(spacing); }

/// Two plates hold one of its ends; it oscillates vertically and about its centre.
Description held_at_one_end(double spacing) {
  Description d =
      description("linear-frictional", {{"density", 2600}, {"contact_modulus", modulus}, {"friction_angle", 0}},
                  {{Vec3::Zero(), size, {0, 0, trembling}, {0, trembling / size, 0}}});
  make_clumps(d, {{"type", "rod"}, {"count", 2}, {"spacing", spacing}});
  const Vec3 low(0.5 * arm_of(spacing), -size, 0), high(3 * size, size, 0);
  for (const bool below : {true, false})
    d["walls"][below ? "floor" : "lid"] = side(2, (below ? -0.999 : 0.999) * end_of(spacing), low, high, below);
  return d;
}

TEST(Clump, HeldAtOneEndStartsToGrowWhereItsMassAndInertiaSay) {
  const auto& map =
      "longest stable step of a clump, over that by its mass alone|distance of its spheres over their diameter";
  double least = 1;
  for (const double spacing : {0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95}) {
    const Description d = held_at_one_end(spacing);
    Description known = d;
    known["time_step"]["value"] = 1e-9;
    const Trial trial(known);
    ASSERT_EQ(trial.world().contacts().size(), 2u) << spacing;
    const ClumpView clump = trial.world().clumps().front();
    // Two springs k = E r at the distance a from its centre: ω² = 2 k (1/m + a²/I).
    const double k = modulus * end_of(spacing), arm = arm_of(spacing);
    const double by_mass = 2 / std::sqrt(2 * k / clump.mass);
    const double predicted = by_mass / std::sqrt(1 + clump.mass * arm * arm / clump.inertia[2]);
    const double found = found_limit(d, predicted), said = critical(d);
    EXPECT_NEAR(found / predicted, 1, 5e-3) << spacing;
    EXPECT_LE(said, 1.002 * found) << spacing;
    EXPECT_GE(said, 0.5 * found) << spacing;
    map_point(map, "found", spacing, found / by_mass);
    map_point(map, "predicted", spacing, predicted / by_mass);
    map_point(map, "that grit reckons with", spacing, said / by_mass);
    least = std::min(least, said / found);
  }
  figure("bound of a clump over its longest stable step, at least", least);
}

}  // namespace
}  // namespace grit::test::clump_tests
