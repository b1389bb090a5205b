// Density scaling of small grains.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/toolkit/grain_masses.hpp"
#include "support/clump.hpp"
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

/// Two single spheres, or clumps of two spheres, fall from rest onto a floor. The first is small.
Description falling(bool clumps, bool scaled_weight) {
  const double height = 4e-3;
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}, {"density", density}},
                              {{Vec3(-5e-3, 0, height), small}, {Vec3(5e-3, 0, height), large}});
  if (clumps) make_clumps(d, listed({ball({-0.5, 0, 0}, 1), ball({0.5, 0, 0}, 1)}));
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}, {"scaled_weight", scaled_weight}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  d["bodies"]["grains"]["density_scaling"]["below"] = 2 * large;
  return d;
}

/// On the side of x < 0 (−1) or x > 0 (1) [N].
double weight_on_floor(const World& world, double side) {
  double sum = 0;
  for (const Contact& contact : world.contacts_with_walls())
    if (side * world.positions()[contact.a].x > 0) sum -= contact.force.z();
  return sum;
}

struct Case {
  bool clumps, scaled_weight;
};

class ScaledWeight : public testing::TestWithParam<Case> {};

TEST_P(ScaledWeight, FloorCarriesTheMassOnWhichGravityActs) {
  const auto [clumps, scaled] = GetParam();
  Trial trial(falling(clumps, scaled), 1, BodyState::energy);
  trial.world().energies();
  trial.step(40000);
  ASSERT_TRUE(support(trial.world()).at_rest(1e-6));
  Description plain = falling(clumps, scaled);
  plain["bodies"]["grains"].erase("density_scaling");
  const Trial own(plain);
  const auto mass_of_grain = [&](const Trial& of, std::size_t grain) {
    return clumps ? of.world().clumps()[grain].mass : of.mass(static_cast<std::uint32_t>(grain));
  };
  const double mass = scaled ? mass_of_grain(trial, 0) : mass_of_grain(own, 0), heavy = mass_of_grain(own, 1);
  EXPECT_NEAR(weight_on_floor(trial.world(), -1), mass * 9.81, 1e-5 * mass * 9.81);
  EXPECT_NEAR(weight_on_floor(trial.world(), 1), heavy * 9.81, 1e-5 * heavy * 9.81) << "larger ones are not changed";
  EXPECT_GT(mass_of_grain(trial, 0), 7.9 * mass_of_grain(own, 0));
  // The work of gravity goes into damping and contacts.
  const Energies energies = trial.world().energies();
  EXPECT_GT(energies.local_damping, 0);
  EXPECT_LT(std::abs(energies.closure_error), 5e-3 * std::abs(energies.gravitational));
  EXPECT_DOUBLE_EQ(mass_of(trial.world()), mass_of(own.world())) << "without density scaling";
}

TEST_P(ScaledWeight, FreeFallIsThatOfTheSmallerMassUnlessItIsScaled) {
  const auto [clumps, scaled] = GetParam();
  Trial trial(falling(clumps, scaled));
  trial.step(100);
  const double fallen = 4e-3 - trial.position(0).z(), fallen_large = 4e-3 - trial.position(clumps ? 2 : 1).z();
  EXPECT_NEAR(fallen / fallen_large, scaled ? 1 : 1.0 / 8, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Bodies, ScaledWeight,
                         testing::Values(Case{false, false}, Case{false, true}, Case{true, false}, Case{true, true}),
                         [](const auto& info) {
                           return std::string(info.param.clumps ? "Clumps" : "Spheres") +
                                  (info.param.scaled_weight ? "WithScaledWeight" : "WithOwnWeight");
                         });

/// Groups may have different scaling, under one engine for all.
TEST(ScaledWeight, IsThatOfTheGroup) {
  Description d = falling(false, false);
  Description other = d["bodies"]["grains"];
  d["bodies"]["grains"]["source"]["bodies"].erase(1);
  other["source"]["bodies"].erase(1), other["source"]["bodies"][0]["position"] = {5e-3, 0, 4e-3};
  other["density_scaling"]["below"] = 4 * small;
  d["bodies"]["others"] = other;
  d["bodies"]["grains"]["density_scaling"]["below"] = 3 * small;
  Trial trial(d);
  trial.step(100);
  EXPECT_NEAR((4e-3 - trial.position(0).z()) / (4e-3 - trial.position(1).z()), std::pow(4.0 / 3, 3), 1e-9);
}

TEST(ScaledWeight, OfABodyThatLeavesIsReportedWithoutScaling) {
  Description d = falling(false, false);
  d["walls"].erase("floor");
  d["domain"] = {{"low", {-0.02, -0.02, -0.01}}, {"high", {0.02, 0.02, 0.01}}, {"open_sides", {"-z"}}};
  Trial trial(d, 1, BodyState::energy);
  trial.world().energies();
  while (trial.world().departures().size() < 2 && trial.world().time() < 1) trial.step();
  ASSERT_EQ(trial.world().departures().size(), 2u);
  EXPECT_DOUBLE_EQ(trial.world().departures()[0].mass, mass_of(large)) << "it falls faster";
  EXPECT_DOUBLE_EQ(trial.world().departures()[1].mass, mass_of(small));
  EXPECT_NEAR(trial.kernel().state().discharged_fraction(), 1, 1e-12);
  EXPECT_LT(std::abs(trial.world().energies().closure_error), 1e-3 * mass_of(large) * 9.81 * 0.01);
}

}  // namespace
}  // namespace grit::test::scaled_mass_tests
