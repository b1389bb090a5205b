// Density scaling of small grains.
#include <gmock/gmock.h>

#include <numbers>

#include "grit/error.hpp"
#include "support/scene.hpp"

namespace grit::test::scaled_mass_tests {
namespace {

constexpr double small = 0.5e-3, large = 1e-3, density = 2600;

Description small_beside_large(double below) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e8}, {"density", density}},
                              {{Vec3::Zero(), small}, {Vec3(small + 0.999 * large, 0, 0), large}});
  d["bodies"]["grains"]["density_scaling"]["below"] = below;
  return d;
}

double mass_of(double radius) { return density * 4.0 / 3 * std::numbers::pi * radius * radius * radius; }

TEST(ScaledMass, GrainsBelowADiameterHaveTheMassAndInertiaOfOneOfIt) {
  const double least = 1.5e-3;
  const Trial trial(small_beside_large(least));
  const auto mass = mass_of(0.5 * least);
  EXPECT_DOUBLE_EQ(trial.mass(0), mass);
  EXPECT_DOUBLE_EQ(1 / trial.world().spins()[0].w, 0.4 * mass * 0.25 * least * least);
  EXPECT_DOUBLE_EQ(trial.mass(1), mass_of(large)) << "larger ones are not changed";
  EXPECT_EQ(trial.world().positions()[0].w, small);
  EXPECT_DOUBLE_EQ(Trial(small_beside_large(0)).mass(0), mass_of(small));
}

TEST(ScaledMass, TimeStepGrowsWithTheRootOfTheMassOfTheSmallest) {
  // For two equal grains, all frequencies scale equally.
  const auto critical = [](double below) {
    Description d = description("linear-rolling", {{"contact_modulus", 1e8}, {"rolling_stiffness", 0}},
                                {{Vec3::Zero(), small}, {Vec3(1.999 * small, 0, 0), small}});
    d["bodies"]["grains"]["density_scaling"]["below"] = below;
    return Trial(d).kernel().critical_time_step();
  };
  // Twice the diameter: eight times the mass, but a moment of inertia 32 times as large: at least √8.
  EXPECT_GE(critical(4 * small), std::sqrt(8.0) * critical(0));
  EXPECT_LE(critical(4 * small), std::sqrt(32.0) * critical(0));
}

TEST(ScaledMass, IsRefusedUnderGravity) {
  Description d = small_beside_large(1.5e-3);
  d["engines"]["gravity"] = {{"type", "gravity"}};
  try {
    scene_of(d);
    FAIL() << "weight would grow with scaled mass";
  } catch (const DescriptionError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("/bodies/grains/density_scaling: found density scaling together with gravity"));
  }
}

}  // namespace
}  // namespace grit::test::scaled_mass_tests
