#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bodies/kinetic_energy.hpp"
#include "bodies/random.hpp"
#include "grit/testing/fake_world.hpp"

namespace grit::averages_tests {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// n³ spheres of diameter d in contact in a periodic cube; each has contacts with three neighbours along +x, +y, +z,
/// also across the sides, with these normal forces.
FakeWorld simple_cubic(int n, double d, const Vec3& push) {
  FakeWorld world;
  world.make_periodic(Vec3::Zero(), Vec3::Constant(n * d));
  const auto at = [n](int x, int y, int z) { return static_cast<std::uint32_t>((z % n * n + y % n) * n + x % n); };
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) world.add(d * Vec3(x, y, z), 0.5 * d);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        world.add_contact(at(x, y, z), at(x + 1, y, z), Vec3(d, 0, 0), Vec3(push[0], 0, 0));
        world.add_contact(at(x, y, z), at(x, y + 1, z), Vec3(0, d, 0), Vec3(0, push[1], 0));
        world.add_contact(at(x, y, z), at(x, y, z + 1), Vec3(0, 0, d), Vec3(0, 0, push[2]));
      }
  return world;
}

/// One to `most` along each axis.
Vec3 whole_periods(Random& random, std::uint64_t most) {
  const auto number = [&] { return static_cast<double>(1 + random.below(most)); };
  return Vec3(number(), number(), number());
}

void expect_near(const Mat3& found, const Mat3& wanted, double relative = 1e-12) {
  EXPECT_LT((found - wanted).norm(), relative * wanted.norm()) << found << "\ninstead of\n" << wanted;
}

TEST(VoidRatio, OfSimpleCubicPackingInAnyShiftedBox) {
  const FakeWorld world = simple_cubic(3, 0.5, Vec3::Zero());
  const double exact = 6 / std::numbers::pi - 1;
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    // Whole periods of the lattice at any position, also outside the cell and larger than it.
    const Vec3 low(8 * random.uniform() - 4, 8 * random.uniform() - 4, 8 * random.uniform() - 4);
    const Vec3 size = 0.5 * whole_periods(random, 4);
    EXPECT_NEAR(void_ratio(world, {low, low + size}), exact, 1e-11);
  }
}

TEST(VoidRatio, CountsImagesOfBodiesThatCrossAPeriodicSide) {
  FakeWorld world;
  world.add(Vec3(0.05, 0.5, 0.5), 0.2);
  const Region far_end{Vec3(0.5, 0, 0), Vec3(1, 1, 1)}, whole{Vec3::Zero(), Vec3::Ones()};
  EXPECT_EQ(void_ratio(world, far_end), infinity);
  const double solid = 4.0 / 3 * std::numbers::pi * 0.008, cap = std::numbers::pi * 0.15 * 0.15 * (0.6 - 0.15) / 3;
  EXPECT_NEAR(void_ratio(world, whole), 1 / (solid - cap) - 1, 1e-11);
  world.make_periodic(whole.low, whole.high);
  EXPECT_NEAR(void_ratio(world, far_end), 0.5 / cap - 1, 1e-10);
  EXPECT_NEAR(void_ratio(world, whole), 1 / solid - 1, 1e-11);
  world.box.periodic = {false, true, true};
  EXPECT_EQ(void_ratio(world, far_end), infinity);
}

TEST(VoidRatio, CountsOverlapsTwiceAndEmptyOrEndlessBoxesAreAllVoid) {
  FakeWorld world;
  world.add(Vec3(0.5, 0.5, 0.5), 0.1), world.add(Vec3(0.5, 0.5, 0.5), 0.1);
  EXPECT_NEAR(void_ratio(world, {Vec3::Zero(), Vec3::Ones()}), 1 / (8.0 / 3 * std::numbers::pi * 1e-3) - 1, 1e-11);
  EXPECT_EQ(void_ratio(world, {Vec3::Zero(), Vec3(1, 1, 0)}), infinity);
  EXPECT_EQ(void_ratio(world, {Vec3::Zero(), Vec3(1, 1, infinity)}), infinity);
}

TEST(MeanStress, OfALatticeIsForceOverTheAreaOfOneGrain) {
  const double d = 0.5;
  const FakeWorld world = simple_cubic(4, d, Vec3(1, 2, 3));
  const Mat3 exact = (Vec3(1, 2, 3) / (d * d)).asDiagonal();  // positive in compression
  expect_near(mean_stress(world, world.specimen()), exact);
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Vec3 low(8 * random.uniform() - 4, 8 * random.uniform() - 4, 8 * random.uniform() - 4);
    const Vec3 size = d * whole_periods(random, 5);
    expect_near(mean_stress(world, {low, low + size}), exact, 1e-11);
  }
  // Boxes whose faces contain whole planes of branches do not count them twice.
  expect_near(mean_stress(world, {Vec3::Constant(d), Vec3::Constant(2 * d)}), exact);
}

TEST(MeanStress, WeighsABranchByThePartInside) {
  FakeWorld world;
  const auto a = world.add(Vec3(0, 0, 0), 0.6), b = world.add(Vec3(1, 0, 0), 0.6);
  world.add_contact(a, b, Vec3(1, 0, 0), Vec3(5, 7, 0));
  Mat3 whole = Mat3::Zero();
  whole(0, 0) = 5, whole(1, 0) = 7;  // force by branch
  const auto of = [&](double from, double to) {
    const Region box{Vec3(from, -1, -1), Vec3(to, 1, 1)};
    return Mat3(mean_stress(world, box) * box.volume());
  };
  expect_near(of(-1, 2), whole);
  expect_near(of(0.25, 2), 0.75 * whole);
  expect_near(of(0.25, 0.75), 0.5 * whole);
  expect_near(of(-3, 0.125), 0.125 * whole);
  EXPECT_EQ(of(1, 2).norm(), 0);
  EXPECT_EQ(mean_stress(world, {Vec3(-1, 0.1, -1), Vec3(2, 1, 1)}).norm(), 0);
}

TEST(MeanStress, ClipsASlantedBranchOnAllSides) {
  FakeWorld world;
  const auto a = world.add(Vec3(0, 0, 0), 1), b = world.add(Vec3(1, -2, 4), 1);
  const Vec3 branch(1, -2, 4), force(1, 2, -3);
  world.add_contact(a, b, branch, force);
  // x leaves 0.2 … 1, y leaves 0 … 0.7, z leaves 0.25 … 0.9
  const Region box{Vec3(0.2, -1.4, 1), Vec3(3, 3, 3.6)};
  expect_near(mean_stress(world, box), (0.7 - 0.25) / box.volume() * force * branch.transpose());
}

TEST(MeanStress, FollowsABranchAcrossAPeriodicSide) {
  FakeWorld world;
  world.make_periodic(Vec3::Zero(), Vec3::Ones());
  const auto a = world.add(Vec3(0.9, 0.5, 0.5), 0.2), b = world.add(Vec3(0.2, 0.5, 0.5), 0.2);
  world.add_contact(a, b, Vec3(0.3, 0, 0), Vec3(10, 0, 0));
  const auto xx = [&](double from, double to) { return mean_stress(world, {Vec3(from, 0, 0), Vec3(to, 1, 1)})(0, 0); };
  EXPECT_NEAR(xx(0, 1), 3, 1e-12);
  EXPECT_NEAR(xx(0.5, 1), 1 / 0.5, 1e-12);
  EXPECT_NEAR(xx(0, 0.5), 2 / 0.5, 1e-12);
  EXPECT_NEAR(xx(0.2, 0.9), 0, 1e-12);
  EXPECT_NEAR(xx(0.5, 2.5), 3, 1e-12);  // two of them
}

TEST(MeanStress, TakesTheBranchToAWallUpToTheContactPoint) {
  FakeWorld world;
  const auto a = world.add(Vec3(0.5, 0.5, 0.1), 0.1);
  world.add_wall_contact(a, 0, Vec3(0, 0, -0.1), Vec3(2, 0, -8));
  const Region box{Vec3::Zero(), Vec3::Ones()};
  Mat3 exact = Mat3::Zero();
  exact(0, 2) = -0.2, exact(2, 2) = 0.8;
  expect_near(mean_stress(world, box), exact);
  expect_near(mean_stress(world, {Vec3(0, 0, 0.05), Vec3::Ones()}), 0.5 * exact / 0.95);
}

TEST(MeanStress, OfAnEmptyOrEndlessBoxIsZero) {
  const FakeWorld world = simple_cubic(2, 1, Vec3::Ones());
  EXPECT_EQ(mean_stress(world, {Vec3::Zero(), Vec3(1, 1, 0)}).norm(), 0);
  EXPECT_EQ(mean_stress(world, {Vec3::Zero(), Vec3(1, 1, infinity)}).norm(), 0);
}

TEST(MeanFlow, CarriesAVelocityByItsGradient) {
  const Vec3 v(1, 2, 3);
  const MeanFlow stretches{{0.1, 0, -0.2}, Vec3::Zero()}, shears{{0.1, 0, -0.2}, {4, 5, 6}};
  EXPECT_LT((stretches.carried(v, 0.01) - Vec3(1.001, 2, 2.994)).norm(), 1e-15);
  EXPECT_LT((shears.carried(v, 0.01) - Vec3(1.001 + 0.01 * (4 * 2 + 5 * 3), 2 + 0.01 * 6 * 3, 2.994)).norm(), 1e-15);
}

TEST(Equilibrium, BringsVelocitiesUpToTime) {
  FakeWorld world;
  world.time_step = 0.2, world.steps = 1;
  world.add(Vec3::Zero(), 0.1, Vec3(1, 2, 3), Vec3(4, 5, 6));
  const double mass = 1 / world.velocity[0].w, inertia = 1 / world.spin[0].w;
  world.force[0] = {mass * 10, 0, -mass * 10, 0};
  world.moment[0] = {0, inertia * 20, 0, 0};
  // Half a step of 0.1 s adds (1, 0, −1) m/s and (0, 2, 0) rad/s.
  const double exact = 0.5 * mass * Vec3(2, 2, 2).squaredNorm() + 0.5 * inertia * Vec3(4, 7, 6).squaredNorm();
  EXPECT_NEAR(equilibrium(world).kinetic_energy, exact, 1e-12 * exact);
  world.steps = 0;  // velocities are of time 0 there
  const double start = 0.5 * mass * Vec3(1, 2, 3).squaredNorm() + 0.5 * inertia * Vec3(4, 5, 6).squaredNorm();
  EXPECT_NEAR(equilibrium(world).kinetic_energy, start, 1e-12 * start);
}

TEST(Equilibrium, ComparesNetForcesWithContactForces) {
  FakeWorld world;
  const auto a = world.add(Vec3::Zero(), 0.5), b = world.add(Vec3(1, 0, 0), 0.5);
  EXPECT_EQ(equilibrium(world).unbalanced_force, 0);
  world.force[a] = {3, 0, 4, 0}, world.force[b] = {0, 1, 0, 0};
  EXPECT_EQ(equilibrium(world).unbalanced_force, 0);  // no contacts
  world.add_contact(a, b, Vec3(1, 0, 0), Vec3(10, 7, 0));
  world.add_wall_contact(b, 0, Vec3(0, 0, -0.5), Vec3(0, 9, -20));
  EXPECT_NEAR(equilibrium(world).mean_contact_force, 15, 1e-12);
  EXPECT_NEAR(equilibrium(world).unbalanced_force, 3.0 / 15, 1e-14);
}

/// A world with clumps, which FakeWorld does not have.
struct WithClumps final : FakeWorld {
  std::vector<ClumpView> clump;
  std::vector<std::uint32_t> of;
  std::span<const ClumpView> clumps() const override { return clump; }
  std::span<const std::uint32_t> clump_of() const override { return of; }
};

TEST(Equilibrium, IgnoresClumpsOfInfiniteMass) {
  WithClumps world;
  const auto a = world.add(Vec3::Zero(), 0.5), b = world.add(Vec3(1, 0, 0), 0.5);
  ClumpView one{};
  one.velocity = one.spin = one.momentum = one.moment = one.centre = Vec3::Zero();
  one.axes = Mat3::Identity(), one.inertia = Vec3::Ones(), one.mass = 1, one.radius = 0.5, one.force = {3, 0, 0};
  world.clump = {one, one};
  world.clump[1].mass = infinity, world.clump[1].force = {100, 0, 0};
  world.of = {0, 1};
  world.add_contact(a, b, Vec3(1, 0, 0), Vec3(10, 0, 0));
  EXPECT_NEAR(equilibrium(world).unbalanced_force, 0.3, 1e-14);
}

TEST(Equilibrium, IgnoresFixedBodies) {
  FakeWorld world;
  const auto a = world.add(Vec3::Zero(), 0.5, Vec3(1, 0, 0)), b = world.add(Vec3(1, 0, 0), 0.5, Vec3(9, 0, 0));
  world.velocity[b].w = 0, world.spin[b].w = 0;
  world.force[a] = {3, 0, 0, 0}, world.force[b] = {100, 0, 0, 0};
  world.time_step = 0;
  world.add_contact(a, b, Vec3(1, 0, 0), Vec3(10, 0, 0));
  EXPECT_NEAR(equilibrium(world).unbalanced_force, 0.3, 1e-14);
  EXPECT_NEAR(equilibrium(world).kinetic_energy, 0.5 / world.velocity[a].w, 1e-9);
}

}  // namespace
}  // namespace grit::averages_tests
