#include "domain/population_statistics.hpp"

#include <gtest/gtest.h>

#include "two_spheres.hpp"

namespace grit::test::population_statistics_tests {
namespace {

TEST(PopulationStatistics, CountSpheres) {
  State state = two_spheres(0.004);
  const PopulationStatistics& s = state.statistics;
  EXPECT_EQ(s.particles, 2u);
  EXPECT_DOUBLE_EQ(s.mass, 2 * sphere_mass());
  EXPECT_DOUBLE_EQ(s.mean_diameter, 2 * radius);
  EXPECT_NEAR(s.solid_density, density, 1e-12 * density);
  EXPECT_EQ(s.largest_radius, radius);
  EXPECT_EQ(s.smallest_radius, radius);
  EXPECT_TRUE(s.one_material);
}

TEST(PopulationStatistics, OtherMaterialsAreNoticed) {
  State state = two_spheres(0.004);
  Bodies other;
  other.add({0, 0, 0}, 2 * radius, sphere_mass(), sphere_inertia(), 1);
  other.finish({});
  state.statistics.add(other, 0, 0, {});
  EXPECT_FALSE(state.statistics.one_material);
  EXPECT_EQ(state.statistics.largest_radius, 2 * radius);
  EXPECT_EQ(state.statistics.smallest_radius, radius);
  EXPECT_DOUBLE_EQ(state.statistics.mean_diameter, 8.0 / 3 * radius);
}

TEST(PopulationStatistics, GrowKeepsTheDensity) {
  State state = two_spheres(0.004);
  state.statistics.grow(1.1, state.statistics.mass);
  EXPECT_NEAR(state.statistics.mass, 2 * sphere_mass() * 1.331, 1e-12 * sphere_mass());
  EXPECT_NEAR(state.statistics.mass / state.statistics.solids, density, 1e-12 * density);
  EXPECT_DOUBLE_EQ(state.statistics.largest_radius, 1.1 * radius);
}

}  // namespace
}  // namespace grit::test::population_statistics_tests
