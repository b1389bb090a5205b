// A free wall with a mass on a grain above the floor: the step at which oscillations of both start to grow, found from
// both sides, for walls far lighter to far heavier than the grain.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "grit/contact/restitution.hpp"
#include "grit/error.hpp"
#include "support/growth.hpp"
#include "support/mapped.hpp"

namespace grit::test::free_wall_tests {
namespace {

constexpr double radius = 1e-3, density = 2500, modulus = 1e8, stiffness = modulus * radius;
const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius;
constexpr double squeeze = 1e-3;  // of the radius

/// `grains` grains side by side; the wall's mass is relative to theirs.
Description under_a_lid(double wall_mass, double restitution, int grains = 1) {
  Description m{{"density", density}, {"contact_modulus", modulus}, {"friction_angle", 0}};
  if (restitution < 1) m["restitution"] = restitution;
  const double speed = 1e-9 * squeeze * radius * std::sqrt(2 * stiffness / mass);
  std::vector<Grain> list;
  for (int i = 0; i < grains; ++i)
    list.push_back({Vec3(3 * radius * i, 0, (1 - squeeze) * radius), radius, {0, 0, speed}});
  Description d = description("linear-frictional", m, list);
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["lid"] = plane({0, 0, 2 * (1 - squeeze) * radius}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"]["free"] = {{"mass", wall_mass * grains * mass},
                                         {"load", {0, 0, -grains * stiffness * squeeze * radius}}};
  return d;
}

/// Spectral radius of a leap-frog step of grain and wall: positions and velocities; dashpots use the velocities of half
/// a step ago.
double spectral_radius(double wall_mass, double restitution, double dt) {
  const double dashpot = 2 * damping_of_restitution(restitution) * std::sqrt(stiffness * mass), lid = wall_mass * mass;
  Eigen::Matrix2d spring, damping, inverse;
  spring << 2 * stiffness, -stiffness, -stiffness, stiffness;
  damping << 2 * dashpot, -dashpot, -dashpot, dashpot;
  inverse << 1 / mass, 0, 0, 1 / lid;
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  Eigen::Matrix4d step;  // of (positions, dt · velocities)
  const Eigen::Matrix2d kick = -dt * dt * inverse * spring, kept = one - dt * inverse * damping;
  step << one + kick, kept, kick, kept;
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

double predicted_limit(double wall_mass, double restitution) {
  double low = 0, high = 4 * std::sqrt(mass / stiffness);
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (spectral_radius(wall_mass, restitution, middle) > 1 + 1e-9 ? high : low) = middle;
  }
  return low;
}

TEST(FreeWall, StartsToGrowAboveTheStepThatIsSaidToBeSafe) {
  const auto& map = "limit over that of a fixed wall|mass of the wall over that of the grain";
  const double fixed = 2 / std::sqrt(2 * stiffness / mass);
  double least = 1;
  for (const double e : {1.0, 0.5, 0.1})
    for (const double wall : {1e-2, 0.1, 0.3, 0.5, 1.0, 3.0, 10.0, 100.0}) {
      SCOPED_TRACE("restitution " + std::to_string(e) + ", mass " + std::to_string(wall));
      const double limit = predicted_limit(wall, e), said = critical(under_a_lid(wall, e));
      const double found = found_limit(under_a_lid(wall, e), limit);
      EXPECT_NEAR(found / limit, 1, 5e-3);
      EXPECT_LE(said, 1.0001 * limit);
      EXPECT_GE(said, 0.5 * limit) << "not much shorter than necessary";
      const std::string name = "restitution " + std::to_string(e).substr(0, 3);
      map_point(map, name, wall, found / fixed);
      map_point(map, "predicted, " + name, wall, limit / fixed);
      map_point(map, "critical step, " + name, wall, said / fixed);
      least = std::min(least, said / limit);
    }
  figure("bound over the longest stable step, of a free wall, at least", least);
}

TEST(FreeWall, StepAboveTheLimitIsRefusedAndTheChosenOneIsBelow) {
  for (const int grains : {1, 9})
    for (const double wall : {0.1, 0.5, 10.0}) {
      const double limit = predicted_limit(wall, 1);
      Description d = under_a_lid(wall, 1, grains);
      d["time_step"]["value"] = 1.001 * limit;
      EXPECT_THROW(Trial{d}, NumericsError);
      Trial chosen(under_a_lid(wall, 1, grains));
      EXPECT_LT(chosen.world().dt(), 0.81 * limit);
      EXPECT_LT(growth(chosen, 4000), 20);
    }
}

/// The lid hinged at a distance: as heavy at the grain as its inertia over the square of that.
Description under_a_hinged_lid(double wall_mass, double restitution) {
  constexpr double arm = 20 * radius;
  Description d = under_a_lid(wall_mass, restitution);
  d["walls"]["lid"]["motion"] = {{"about", {arm, 0, 2 * (1 - squeeze) * radius}},
                                 {"free_rotation",
                                  {{"axis", {0, 1, 0}},
                                   {"inertia", wall_mass * mass * arm * arm},
                                   {"moment", -arm * stiffness * squeeze * radius}}}};
  return d;
}

TEST(FreeWall, HingedLimitsTheStepByItsInertia) {
  for (const double e : {1.0, 0.5})
    for (const double wall : {1e-2, 0.3, 1.0, 10.0}) {
      SCOPED_TRACE("restitution " + std::to_string(e) + ", inertia " + std::to_string(wall));
      const double limit = predicted_limit(wall, e), said = critical(under_a_hinged_lid(wall, e));
      EXPECT_NEAR(found_limit(under_a_hinged_lid(wall, e), limit) / limit, 1, 5e-3);
      EXPECT_LE(said, 1.0001 * limit);
      EXPECT_GE(said, 0.5 * limit);
    }
}

TEST(FreeWall, EnergyGuardTripsBeyondTheLimit) {
  Description d = under_a_lid(0.5, 1);
  d["time_step"] = {{"value", 1.02 * predicted_limit(0.5, 1)}, {"allow_unstable", true}};
  Trial t(d);
  EXPECT_THROW(t.step(20000), NumericsError);
}

}  // namespace
}  // namespace grit::test::free_wall_tests
