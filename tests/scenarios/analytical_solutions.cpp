// Closed forms of silos and sand, against published values, limits, and the balances that they come from.
#include "grit/toolkit/analytical_solutions.hpp"

#include <gtest/gtest.h>

namespace grit::analytical_solutions {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// 0.2 × 0.5 × 0.6 m.
PlaneSilo silo(double walls_with_friction, double unit_weight, double stress_ratio, double wall_friction_angle) {
  return {.width = 0.2,
          .height = 0.5,
          .depth = 0.6,
          .unit_weight = unit_weight,
          .stress_ratio = stress_ratio,
          .wall_friction = std::tan(wall_friction_angle * degree),
          .walls_with_friction = walls_with_friction};
}

// Grabowski (2024), table 5.3, of grooved walls with R_n = 1, 0.25 and 0.01.
TEST(PlaneSilo, GivesTheForcesOfTheReference) {
  EXPECT_NEAR(silo(1, 16e3, 0.83, 32).bottom_force(), 537, 0.01 * 537);
  EXPECT_NEAR(silo(1, 16e3, 1.21, 27).bottom_force(), 490, 0.01 * 490);
  EXPECT_NEAR(silo(1, 16e3, 1.73, 17).bottom_force(), 533, 0.01 * 533);
  EXPECT_NEAR(silo(2, 17e3, 0.63, 32).bottom_force(), 446, 0.01 * 446);
  EXPECT_NEAR(silo(2, 17e3, 0.63, 27).bottom_force(), 508, 0.01 * 508);
  EXPECT_NEAR(silo(2, 17e3, 0.63, 17).bottom_force(), 655, 0.01 * 655);
}

TEST(PlaneSilo, BearsItsWholeWeightOnTheBottomWhereItIsShallow) {
  PlaneSilo shallow = silo(2, 16e3, 0.5, 30);
  shallow.height = 1e-5;
  EXPECT_NEAR(shallow.bottom_fraction(), 1, 2e-5);
  EXPECT_NEAR(shallow.bottom_force(), 16e3 * 0.2 * 1e-5 * 0.6, 1e-4 * shallow.weight());
  EXPECT_NEAR(shallow.vertical_stress(1e-5), 0.16, 1e-5);
  const PlaneSilo smooth = silo(2, 16e3, 0.5, 0);
  EXPECT_EQ(smooth.bottom_fraction(), 1);
  EXPECT_EQ(smooth.wall_shear_fraction(), 0);
  // A liquid with K = 0.5: K γ h² / 2 times the depth, over the weight.
  EXPECT_NEAR(smooth.wall_normal_fraction(), 0.5 * 0.5 / (2 * 0.2), 1e-12);
}

TEST(PlaneSilo, TendsToStressesThatDoNotDependOnTheHeightWhereItIsDeep) {
  PlaneSilo deep = silo(2, 16e3, 0.5, 30);
  deep.height = 20;
  const double most = 16e3 * 0.2 / (2 * 0.5 * std::tan(30 * degree));
  EXPECT_NEAR(deep.vertical_stress(20), most, 1e-9 * most);
  EXPECT_NEAR(deep.horizontal_stress(15), 0.5 * most, 1e-9 * most);
  EXPECT_NEAR(deep.bottom_force(), most * 0.2 * 0.6, 1e-9 * most);
}

TEST(PlaneSilo, IsInBalance) {
  const PlaneSilo two = silo(2, 16e3, 0.45, 27), one = silo(1, 16e3, 0.45, 27);
  EXPECT_NEAR(two.bottom_fraction() + 2 * two.wall_shear_fraction(), 1, 1e-12);
  EXPECT_NEAR(one.bottom_fraction() + one.wall_shear_fraction(), 1, 1e-12);
  EXPECT_GT(one.bottom_fraction(), two.bottom_fraction());
  EXPECT_NEAR(two.wall_shear_fraction() / two.wall_normal_fraction(), std::tan(27 * degree), 1e-12);
  EXPECT_EQ(two.vertical_stress(0), 0);
  // γ b = b dσ/dz + 2 K μ σ, with a central difference; and N is the sum of the horizontal stress.
  const double z = 0.3, dz = 1e-4, friction = 2 * 0.45 * std::tan(27 * degree);
  const double slope = (two.vertical_stress(z + dz) - two.vertical_stress(z - dz)) / (2 * dz);
  EXPECT_NEAR(0.2 * slope + friction * two.vertical_stress(z), 0.2 * 16e3, 1e-3);
  double pressed = 0;
  for (int i = 0; i < 1000; ++i) pressed += two.horizontal_stress((i + 0.5) * 0.5e-3) * 0.5e-3 * 0.6;
  EXPECT_NEAR(pressed / two.weight(), two.wall_normal_fraction(), 1e-6);
}

TEST(PlaneSilo, HasNoSeamWhereFrictionVanishes) {
  PlaneSilo before = silo(2, 16e3, 0.5, 0), after = before;
  const double seam = 1e-4 * 0.2 / (2 * 0.5 * 0.5);
  before.wall_friction = seam * (1 - 1e-6), after.wall_friction = seam * (1 + 1e-6);
  EXPECT_NEAR(before.wall_normal_fraction(), after.wall_normal_fraction(), 1e-8);
}

TEST(Rankine, IsThatOfAMohrCircleThatTouchesTheEnvelope) {
  for (const double angle : {0.0, 18.0, 30.0, 44.0}) {
    const double sine = std::sin(angle * degree);
    EXPECT_NEAR(rankine_active(angle * degree), (1 - sine) / (1 + sine), 1e-12) << angle;
    EXPECT_NEAR(rankine_passive(angle * degree), (1 + sine) / (1 - sine), 1e-12) << angle;
  }
  EXPECT_NEAR(rankine_active(30 * degree), 1. / 3, 1e-12);
  EXPECT_NEAR(rankine_passive(30 * degree), 3, 1e-12);
}

TEST(WallFriction, ReachesFromTheWallsToTheSandsOwn) {
  const double wall = std::tan(16 * degree), sand = 44 * degree;
  EXPECT_DOUBLE_EQ(effective_wall_friction(1, wall, sand), wall);
  EXPECT_DOUBLE_EQ(effective_wall_friction(0, wall, sand), std::tan(sand));
  for (const double factor : {0.0, 0.2, 0.603, 1.0})
    EXPECT_NEAR(wall_contact_factor(effective_wall_friction(factor, wall, sand), wall, sand), factor, 1e-12);
}

// Grabowski (2024): residual friction on waves of d/l = 0.147 … 0.427, and the wall contact factor that it makes of it.
TEST(WallFriction, GivesTheContactFactorsOfTheReference) {
  const double rows[][2] = {{0.558, 0.603}, {0.689, 0.410}, {0.724, 0.358}, {0.730, 0.349}};
  for (const auto& [friction, factor] : rows)
    EXPECT_NEAR(wall_contact_factor(friction, 0.29, 44 * degree), factor, 0.002) << friction;
}

// EN 1991-4:2006, table E.1: sand of 36° has K = 0.45.
TEST(StoredStressRatio, IsThatOfSand) { EXPECT_NEAR(stored_stress_ratio(36 * degree), 0.45, 0.005); }

TEST(Beverloo, GrowsWithThePowerOfThreeHalvesOfWhatIsOpen) {
  const double d = 1.5e-3, once = beverloo_slot(1625, 7.5e-3, 1.4 * d + 10e-3, d);
  EXPECT_NEAR(once, 1.03 * 1625 * 3.1320919527 * 7.5e-3 * 1e-3, 1e-9);
  EXPECT_NEAR(beverloo_slot(1625, 7.5e-3, 1.4 * d + 40e-3, d) / once, 8, 1e-12);
  EXPECT_EQ(beverloo_slot(1625, 7.5e-3, d, d), 0) << "closed, not a power of less than nothing";
}

}  // namespace
}  // namespace grit::analytical_solutions
