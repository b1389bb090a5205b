#include "packing.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "cell_averages.hpp"
#include "grit/testing/probe.hpp"
#include "grit/toolkit/averaging_cells.hpp"

namespace grit {
namespace {

using testing::ElementsAre;

constexpr double sixth = std::numbers::pi / 6;

double value_of(const World& world, const std::string& name, PackingProbe probe = {}) {
  probe.prepare(world);
  return channel_value(probe, world, name);
}

/// A periodic simple cubic lattice of n³ grains that just touch, with these normal forces along x, y and z.
FakeWorld cubic(int n, double diameter, const Vec3& forces) {
  FakeWorld world;
  const auto index = [n](int i, int j, int k) { return static_cast<std::uint32_t>(((i % n) * n + j % n) * n + k % n); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) world.add((Vec3(i, j, k).array() + 0.25) * diameter, diameter / 2);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        world.add_contact(index(i, j, k), index(i + 1, j, k), Vec3(diameter, 0, 0), Vec3(forces.x(), 0, 0));
        world.add_contact(index(i, j, k), index(i, j + 1, k), Vec3(0, diameter, 0), Vec3(0, forces.y(), 0));
        world.add_contact(index(i, j, k), index(i, j, k + 1), Vec3(0, 0, diameter), Vec3(0, 0, forces.z()));
      }
  world.make_periodic(Vec3::Zero(), Vec3::Constant(n * diameter));
  return world;
}

/// Grains at random, contacts between whatever lies near, random forces; closed by nothing or periodic along y.
FakeWorld random_world(bool periodic_depth) {
  FakeWorld world;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1), sign(-1, 1);
  const Vec3 size(12, 5, 9);
  for (int i = 0; i < 300; ++i)
    world.add(Vec3(unit(random), unit(random), unit(random)).cwiseProduct(size), 0.3 + 0.4 * unit(random));
  for (std::uint32_t a = 0; a < world.position.size(); ++a)
    for (std::uint32_t b = a + 1; b < world.position.size(); ++b) {
      Vec3 branch = xyz(world.position[b]) - xyz(world.position[a]);
      if (periodic_depth) branch.y() -= size.y() * std::round(branch.y() / size.y());
      if (branch.norm() < world.position[a].w + world.position[b].w)
        world.add_contact(a, b, branch, 10 * branch + Vec3(sign(random), sign(random), sign(random)));
    }
  world.wall.push_back(still_wall("floor"));
  for (std::uint32_t a = 0; a < world.position.size(); ++a)
    if (world.position[a].z < world.position[a].w)
      world.add_wall_contact(a, 0, Vec3(0, 0, -world.position[a].z), Vec3(sign(random), 0, -5));
  world.whole = {Vec3::Zero(), size};
  if (periodic_depth) world.box = {{-1e300, 0, -1e300}, {1e300, size.y(), 1e300}, {false, true, false}};
  return world;
}

TEST(Packing, KnowsTheCubicLattice) {
  const double d = 2e-3;
  const FakeWorld world = cubic(5, d, {3, 4, 5});
  EXPECT_NEAR(value_of(world, "void_ratio"), 1 / sixth - 1, 1e-11);
  EXPECT_NEAR(value_of(world, "void_ratio_overall"), 1 / sixth - 1, 1e-11);
  EXPECT_DOUBLE_EQ(value_of(world, "coordination_number"), 6);
  EXPECT_DOUBLE_EQ(value_of(world, "coordination_number_mechanical"), 6);
  EXPECT_DOUBLE_EQ(value_of(world, "rattler_fraction"), 0);
  EXPECT_NEAR(value_of(world, "mean_stress"), 4 / (d * d), 1e-6);
  // s = (-1, 0, 1)/d², q = sqrt(3/2 · 2)/d²
  EXPECT_NEAR(value_of(world, "deviatoric_stress"), std::sqrt(3) / (d * d), 1e-6);
  PackingProbe probe;
  const auto stress = channel_values(probe, world, "stress");
  const std::vector<double> expected{3, 0, 0, 0, 4, 0, 0, 0, 5};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(stress[i], expected[i] / (d * d), 1e-6) << i;
  EXPECT_DOUBLE_EQ(value_of(world, "mean_contact_force"), 4);
}

TEST(Packing, GivesTheTriaxialDifferenceAsDeviatoricStress) {
  EXPECT_NEAR(value_of(cubic(3, 1, {2, 2, 7}), "deviatoric_stress"), 5, 1e-10);
  EXPECT_NEAR(value_of(cubic(3, 1, {2, 2, 2}), "deviatoric_stress"), 0, 1e-10);
}

TEST(Packing, TakesForceThenBranchInTheStress) {
  FakeWorld world = cubic(3, 1, {0, 0, 0});
  for (auto& contact : world.contact)
    if (contact.branch.z() > 0) contact.force = {2, 0, 0};  // a force along x on grains above: σ_xz
  PackingProbe probe;
  const auto stress = channel_values(probe, world, "stress");
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(stress[i], i == 2 ? 2 : 0, 1e-10) << i;
}

TEST(Packing, LeavesTheRimOutOfTheInterior) {
  FakeWorld world;  // one grain in the middle, one at the wall
  world.add({2.5, 2.5, 2.5}, 0.5), world.add({0.5, 0.5, 0.5}, 0.5);
  world.whole = {Vec3::Zero(), Vec3::Constant(5)};
  EXPECT_NEAR(value_of(world, "void_ratio"), 27 / sixth - 1, 1e-10);
  EXPECT_NEAR(value_of(world, "void_ratio_overall"), 125 / (2 * sixth) - 1, 1e-10);
}

TEST(Packing, ClosesAnOpenSideAtTheGrains) {
  FakeWorld world;
  world.add({1, 1, 1}, 1), world.add({1, 1, 5}, 1);
  world.whole = {Vec3::Zero(), Vec3(2, 2, std::numeric_limits<double>::infinity())};
  EXPECT_NEAR(value_of(world, "void_ratio_overall"), 2 * 2 * 6 / (16 * sixth) - 1, 1e-10);
}

TEST(Packing, LeavesRattlersOutOfTheMechanicalCoordination) {
  FakeWorld world;
  for (int i = 0; i < 5; ++i) world.add({double(i), 0, 0}, 0.5);
  const Vec3 any(1, 0, 0);
  world.add_contact(0, 1, any, any), world.add_contact(1, 2, any, any),
      world.add_contact(0, 2, any, any);  // three that hold each other
  world.add_contact(2, 3, any, any);      // one more; the last touches none
  EXPECT_DOUBLE_EQ(value_of(world, "coordination_number"), 2 * 4 / 5.0);
  EXPECT_DOUBLE_EQ(value_of(world, "coordination_number_mechanical"), (2 * 4 - 1) / (5 - 1 - 1.0));
  EXPECT_DOUBLE_EQ(value_of(world, "rattler_fraction"), 0.4);

  world.wall.push_back(still_wall("floor"));
  world.add_wall_contact(3, 0, Vec3(0, 0, -0.5), Vec3(0, 0, -1));  // a grain between a grain and a wall is held
  EXPECT_DOUBLE_EQ(value_of(world, "coordination_number"), 2 * 4 / 5.0);
  EXPECT_DOUBLE_EQ(value_of(world, "coordination_number_mechanical"), 8 / 4.0);
  EXPECT_DOUBLE_EQ(value_of(world, "rattler_fraction"), 0.2);
}

TEST(Packing, FindsTheLargestOverlap) {
  FakeWorld world;
  world.add({0, 0, 0}, 1), world.add({1.9, 0, 0}, 1), world.add({0, 1.95, 0}, 1);
  world.wall.push_back(still_wall("floor"));
  world.add_contact(0, 1, Vec3(1.9, 0, 0), Vec3(1, 0, 0)), world.add_contact(0, 2, Vec3(0, 1.95, 0), Vec3(0, 1, 0));
  EXPECT_NEAR(value_of(world, "largest_overlap"), 0.1, 1e-14);
  world.add_wall_contact(0, 0, Vec3(0, 0, -0.8), Vec3(0, 0, -1));
  EXPECT_NEAR(value_of(world, "largest_overlap"), 0.2, 1e-14);
}

TEST(Packing, ReportsUnrest) {
  FakeWorld world;
  world.add({0, 0, 0}, 1, {3, 0, 0}), world.add({2, 0, 0}, 1);
  const double mass = 2600 * 8 * sixth;
  EXPECT_NEAR(value_of(world, "kinetic_energy"), 0.5 * mass * 9, 1e-8);
  world.add_contact(0, 1, Vec3(2, 0, 0), Vec3(10, 0, 0));
  world.force[0] = {4, 0, 0, 0};
  EXPECT_DOUBLE_EQ(value_of(world, "mean_contact_force"), 10);
  EXPECT_DOUBLE_EQ(value_of(world, "unbalanced_force"), 0.2);
}

TEST(Packing, GivesTheInertialNumber) {
  FakeWorld world = cubic(4, 1e-3, {0.1, 0.1, 0.1});  // p = 0.1 N / 1 mm² = 100 kPa
  world.density = 2500;
  const double per_rate = 1e-3 * std::sqrt(2500 / 1e5);
  EXPECT_EQ(value_of(world, "inertial_number"), 0);

  PackingProbe given;
  given.shear_rate = -8;
  EXPECT_NEAR(value_of(world, "inertial_number", given), 8 * per_rate, 1e-12);

  world.wall.push_back(still_wall("top"));
  world.wall[0].velocity = {0.03, 0, -0.04};
  PackingProbe driven;
  driven.driven_by = "top";
  EXPECT_NEAR(value_of(world, "inertial_number", driven), 0.05 / 4e-3 * per_rate, 1e-12);
  driven.driven_axis = "x";
  EXPECT_NEAR(value_of(world, "inertial_number", driven), 0.03 / 4e-3 * per_rate, 1e-12);

  for (auto& contact : world.contact) contact.force *= -1;
  EXPECT_EQ(value_of(world, "inertial_number", driven), 0);
}

TEST(Packing, RefusesAWallThatIsNotThere) {
  FakeWorld world;
  world.wall = {still_wall("top"), still_wall("bottom")};
  PackingProbe probe;
  probe.driven_by = "tip";
  EXPECT_THAT([&] { probe.prepare(world); },
              testing::ThrowsMessage<ParameterError>(
                  "driven_by: found \"tip\", which is not a wall; did you mean \"top\"? Allowed is one of the walls "
                  "top, bottom"));
  probe.shear_rate = 1;
  EXPECT_EQ(complaints(probe), "driven_by: found \"tip\" beside a shear_rate, allowed: one of the two\n");
}

TEST(AveragingCells, LieInTheMiddle) {
  const CellAxis axis(0, 10.5, 5, 1);
  ASSERT_EQ(axis.cells().size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(axis.cells()[i].low, 0.25 + double(i), 1e-12);
    EXPECT_NEAR(axis.cells()[i].high, 5.25 + double(i), 1e-12);
    EXPECT_EQ(axis.cells()[i].end - axis.cells()[i].begin, 5u);
  }
  EXPECT_EQ(axis.strips(), 10u);
}

TEST(AveragingCells, KnowTheirStripsForAnySizeAndStep) {
  for (const auto& [size, step] :
       std::vector<std::pair<double, double>>{{5, 1}, {2.5, 1}, {1, 3}, {0.7, 0.3}, {3, 3}}) {
    const CellAxis axis(-2, 15, size, step);
    for (const auto& cell : axis.cells()) {
      EXPECT_NEAR(axis.edges()[cell.begin], cell.low, 1e-9);
      EXPECT_NEAR(axis.edges()[cell.end], cell.high, 1e-9);
      EXPECT_GE(cell.low, -2 - 1e-9);
      EXPECT_LE(cell.high, 15 + 1e-9);
    }
    EXPECT_EQ(axis.cells().size(), static_cast<std::size_t>((17 - size) / step + 1e-9) + 1);
  }
}

/// Cells of this size, as deep as the specimen along one axis, moved by this step.
AveragingCells columns(const FakeWorld& world, int depth, double size, double step) {
  Vec3 sizes = Vec3::Constant(size);
  sizes[depth] = std::numeric_limits<double>::infinity();
  return {world.box, world.whole, sizes, Vec3::Constant(step)};
}

TEST(AveragingCells, AreOneWhereTheSpecimenIsSmall) {
  const FakeWorld world = cubic(3, 1, {1, 2, 3});
  const auto cells = cell_averages(world, columns(world, 1, 5, 1));
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_NEAR(cells[0].void_ratio, 1 / sixth - 1, 1e-10);
  EXPECT_NEAR((cells[0].stress - Mat3(Vec3(1, 2, 3).asDiagonal())).norm(), 0, 1e-10);
  EXPECT_DOUBLE_EQ(cells[0].coordination_number, 6);
}

TEST(AveragingCells, KnowTheCubicLattice) {
  const FakeWorld world = cubic(8, 1, {1, 2, 3});
  const auto cells = cell_averages(world, columns(world, 1, 5, 1));
  ASSERT_EQ(cells.size(), 16u);
  for (const auto& cell : cells) {  // whole periods, wherever they begin
    EXPECT_NEAR(cell.void_ratio, 1 / sixth - 1, 1e-10);
    EXPECT_NEAR((cell.stress - Mat3(Vec3(1, 2, 3).asDiagonal())).norm(), 0, 1e-10);
    EXPECT_DOUBLE_EQ(cell.coordination_number, 6);
  }
}

class AveragingCellsOf : public testing::TestWithParam<std::tuple<bool, int, double, double>> {};

TEST_P(AveragingCellsOf, RandomGrainsAgreeWithAveragesOfEachBox) {
  const auto [periodic, depth, size, step] = GetParam();
  const FakeWorld world = random_world(periodic);
  std::vector<double> touching(world.position.size());
  for (const auto& contact : world.contact)
    if (!contact.with_wall) ++touching[contact.a], ++touching[contact.b];
  const AveragingCells cells = columns(world, depth, size, step);
  const auto averages = cell_averages(world, cells);
  ASSERT_GT(averages.size(), 3u);
  for (std::size_t n = 0; n < averages.size(); ++n) {
    const CellAverage& cell = averages[n];
    const Region region = cells.cell(n);
    EXPECT_NEAR(cell.void_ratio, void_ratio(world, region), 1e-9);
    const Mat3 stress = mean_stress(world, region);
    EXPECT_NEAR((cell.stress - stress).norm(), 0, 1e-9);
    double grains = 0, contacts = 0;
    for (std::size_t i = 0; i < touching.size(); ++i) {
      const Vec3 centre = xyz(world.position[i]);
      if ((centre.array() >= region.low.array()).all() && (centre.array() < region.high.array()).all())
        ++grains, contacts += touching[i];
    }
    EXPECT_DOUBLE_EQ(cell.coordination_number, grains > 0 ? contacts / grains : 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Worlds, AveragingCellsOf,
                         testing::Values(std::tuple(false, 1, 4, 1), std::tuple(true, 1, 4, 1),
                                         std::tuple(true, 0, 2.5, 1), std::tuple(false, 2, 1.7, 0.4),
                                         std::tuple(true, 1, 1, 2)));

TEST(Packing, GivesItsCellsAsFields) {
  PackingProbe probe;
  const FakeWorld world = cubic(7, 0.5, {1, 2, 3});
  const auto fields = probe.fields(world);
  ASSERT_EQ(fields.size(), 6u);
  EXPECT_EQ(fields[0].name, "centre");
  ASSERT_EQ(fields[0].values.size(), 9 * 3u);
  EXPECT_THAT(std::vector(fields[0].values.begin(), fields[0].values.begin() + 6),
              ElementsAre(1.25, 1.75, 1.25, 1.25, 1.75, 1.75));
  for (std::size_t n = 0; n < 9; ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(fields[1].values[3 * n + axis], axis == 1 ? 3.5 : 0.5, 1e-12) << n;
  EXPECT_NEAR(fields[4].values[8], 12, 1e-9);
  EXPECT_EQ(fields[5].name, "solid_fraction");
  ASSERT_EQ(fields[5].values.size(), 9u);
  for (std::size_t n = 0; n < 9; ++n)
    EXPECT_EQ(fields[5].values[n], 1 / (1 + fields[2].values[n])) << "0 where the void ratio is infinite";
}

std::shared_ptr<Probe> driven() {
  auto probe = std::make_shared<PackingProbe>();
  probe->driven_by = "top-wall", probe->driven_axis = "x", probe->depth_axis = "x", probe->cell_size = 2;
  return probe;
}

INSTANTIATE_TEST_SUITE_P(Packing, ProbeContract,
                         testing::Values(ProbeCase{"plain", [] { return std::make_shared<PackingProbe>(); }},
                                         ProbeCase{"driven", driven}),
                         probe_case_name);

}  // namespace
}  // namespace grit
