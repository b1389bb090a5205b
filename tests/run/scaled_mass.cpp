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
  if (below > 0) d["engines"]["scaling"] = {{"type", "density-scaling"}, {"below", below}};
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
    if (below > 0) d["engines"]["scaling"] = {{"type", "density-scaling"}, {"below", below}};
    return Trial(d).kernel().critical_time_step();
  };
  // Twice the diameter: eight times the mass, but a moment of inertia 32 times as large: at least √8.
  EXPECT_GE(critical(4 * small), std::sqrt(8.0) * critical(0));
  EXPECT_LE(critical(4 * small), std::sqrt(32.0) * critical(0));
}

/// Two single spheres, or clumps of two spheres, fall from rest onto a floor. The first is small.
Description falling(bool clumps) {
  const double height = 4e-3;
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}, {"density", density}},
                              {{Vec3(-5e-3, 0, height), small}, {Vec3(5e-3, 0, height), large}});
  if (clumps) make_clumps(d, listed({ball({-0.5, 0, 0}, 1), ball({0.5, 0, 0}, 1)}));
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  d["engines"]["scaling"] = {{"type", "density-scaling"}, {"below", 2 * large}};
  return d;
}

Description unscaled(Description d) {
  d["engines"].erase("scaling");
  return d;
}

/// On the side of x < 0 (−1) or x > 0 (1) [N].
double weight_on_floor(const World& world, double side) {
  double sum = 0;
  for (const Contact& contact : world.contacts_with_walls())
    if (side * world.positions()[contact.a].x > 0) sum -= contact.force.z();
  return sum;
}

double mass_of_grain(const Trial& trial, std::size_t grain) {
  const auto clumps = trial.world().clumps();
  return clumps.empty() ? trial.mass(static_cast<std::uint32_t>(grain)) : clumps[grain].mass;
}

class ScaledMasses : public testing::TestWithParam<bool> {};

TEST_P(ScaledMasses, DoNotChangeWeights) {
  Trial trial(falling(GetParam()), 1, BodyState::energy);
  trial.world().energies();
  trial.step(40000);
  ASSERT_TRUE(support(trial.world()).at_rest(1e-6));
  const Trial own(unscaled(falling(GetParam())));
  for (const std::size_t grain : {0u, 1u}) {
    const double weight = mass_of_grain(own, grain) * 9.81;
    EXPECT_NEAR(weight_on_floor(trial.world(), grain == 0 ? -1 : 1), weight, 1e-5 * weight);
  }
  EXPECT_NEAR(mass_of_grain(trial, 0), mass_of_grain(own, 1), 1e-12 * mass_of_grain(own, 1));
  // The work of gravity goes into damping and contacts.
  const Energies energies = trial.world().energies();
  EXPECT_GT(energies.local_damping, 0);
  EXPECT_LT(std::abs(energies.closure_error), 5e-3 * std::abs(energies.gravitational));
  EXPECT_DOUBLE_EQ(mass_of(trial.world()), mass_of(own.world())) << "without density scaling";
}

TEST_P(ScaledMasses, FallMoreSlowly) {
  Trial trial(falling(GetParam()));
  trial.step(100);
  const double fallen = 4e-3 - trial.position(0).z(), fallen_large = 4e-3 - trial.position(GetParam() ? 2 : 1).z();
  EXPECT_NEAR(fallen / fallen_large, 1.0 / 8, 1e-9);
}

/// A stage scales masses, the next one no longer does.
TEST_P(ScaledMasses, FollowTheStages) {
  Description d = unscaled(falling(GetParam()));
  for (auto& grain : d["bodies"]["grains"]["source"]["bodies"]) grain["spin"] = {30, -20, 10};
  const Description rest = d["stages"][0];
  d["stages"] = {rest, rest, rest};
  d["stages"][1]["name"] = "scaled", d["stages"][2]["name"] = "unscaled";
  d["stages"][1]["change"]["engines"]["scaling"] = falling(false)["engines"]["scaling"];
  d["stages"][2]["change"]["engines"]["scaling"] = nullptr;
  Trial trial(d, 1, BodyState::energy);
  trial.world().energies();
  trial.step(100);
  const double mass = mass_of_grain(trial, 0), inertia = 1 / trial.world().spins()[0].w,
               density_before = trial.world().solid_density(), step = trial.kernel().critical_time_step();
  const Vec3 spin = xyz(trial.world().spins()[0]), velocity = xyz(trial.world().velocities()[0]);
  trial.begin_stage(1, "scaled");
  EXPECT_NEAR(mass_of_grain(trial, 0), 8 * mass, 1e-13 * mass);
  EXPECT_NEAR(1 / trial.world().spins()[0].w, 32 * inertia, 1e-12 * inertia);
  EXPECT_LT((xyz(trial.world().spins()[0]) - spin).norm(), 1e-13 * spin.norm());
  EXPECT_EQ(xyz(trial.world().velocities()[0]), velocity);
  EXPECT_NEAR(trial.world().solid_density(), density_before * 16 / 9, 1e-12 * density_before);
  trial.step(100);
  EXPECT_GT(trial.kernel().critical_time_step(), 1.9 * step) << "of the large one, at least";
  trial.begin_stage(2, "unscaled");
  EXPECT_NEAR(mass_of_grain(trial, 0), mass, 1e-13 * mass);
  EXPECT_NEAR(1 / trial.world().spins()[0].w, inertia, 1e-12 * inertia);
  EXPECT_NEAR(trial.world().solid_density(), density_before, 1e-12 * density_before);
  trial.step(100);
  EXPECT_NEAR(trial.kernel().critical_time_step(), step, 1e-12 * step);
  const Energies energies = trial.world().energies();
  EXPECT_LT(std::abs(energies.closure_error), 1e-3 * std::abs(energies.gravitational)) << "kinetic energy is booked";
}

INSTANTIATE_TEST_SUITE_P(Bodies, ScaledMasses, testing::Bool(),
                         [](const auto& info) { return std::string(info.param ? "OfClumps" : "OfSpheres"); });

TEST(ScaledMasses, AreThoseOfTheGroup) {
  Description d = unscaled(falling(false));
  Description other = d["bodies"]["grains"];
  d["bodies"]["grains"]["source"]["bodies"].erase(1);
  other["source"]["bodies"].erase(1), other["source"]["bodies"][0]["position"] = {5e-3, 0, 4e-3};
  d["bodies"]["others"] = other;
  for (const auto& [group, below] : {std::pair("grains", 3 * small), std::pair("others", 4 * small)})
    d["engines"][group] = {{"type", "density-scaling"}, {"below", below}, {"groups", {group}}};
  Trial trial(d);
  trial.step(100);
  EXPECT_NEAR((4e-3 - trial.position(0).z()) / (4e-3 - trial.position(1).z()), std::pow(4.0 / 3, 3), 1e-9);
}

/// A stage lets another small grain in.
TEST(ScaledMasses, AreThoseOfNewBodies) {
  Description d = falling(false);
  Description later = d["bodies"]["grains"];
  later["source"]["bodies"].erase(1), later["source"]["bodies"][0]["position"] = {0, 0, 4e-3};
  later["stage"] = "later", d["bodies"]["later"] = later;
  d["stages"].push_back(d["stages"][0]);
  d["stages"][1]["name"] = "later";
  Trial trial(d);
  trial.step(100);
  trial.begin_stage(1, "later");
  EXPECT_NEAR(trial.mass(2), mass_of(large), 1e-13 * mass_of(large));
  EXPECT_NEAR(mass_of(trial.world()), 2 * mass_of(small) + mass_of(large), 1e-13 * mass_of(large));
}

TEST(ScaledMasses, OfBodiesThatLeaveAreReportedWithoutScaling) {
  Description d = falling(false);
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
