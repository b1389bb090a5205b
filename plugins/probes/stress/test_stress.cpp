#include "stress.hpp"

#include <gmock/gmock.h>

#include <random>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

/// One of some tensors that follow each other.
Mat3 tensor(const std::vector<double>& values, std::size_t n) {
  Mat3 made;
  for (int i = 0; i < 9; ++i) made(i / 3, i % 3) = values.at(9 * n + static_cast<std::size_t>(i));
  return made;
}
Mat3 channel_tensor(Stress& probe, const World& world, const std::string& name) {
  return tensor(channel_values(probe, world, name), 0);
}
/// Of a profile that has a channel for each component.
Mat3 slice_tensor(Stress& probe, const World& world, const std::string& name, std::size_t slice) {
  Mat3 made;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) made(i, j) = channel_values(probe, world, name + "_" + "xyz"[i] + "xyz"[j]).at(slice);
  return made;
}
/// One field of a frame.
std::vector<double> field_values(Stress& probe, const World& world, const std::string& name) {
  for (const Field& field : probe.fields(world))
    if (field.name == name) return field.values;
  throw Error("there is no field " + name);
}

/// A periodic simple cubic lattice of n³ grains of diameter 1 with these normal forces along x, y and z.
FakeWorld cubic(int n, const Vec3& forces) {
  FakeWorld world;
  const auto index = [n](int i, int j, int k) { return static_cast<std::uint32_t>(((i % n) * n + j % n) * n + k % n); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) world.add(Vec3(i, j, k).array() + 0.25, 0.5);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        world.add_contact(index(i, j, k), index(i + 1, j, k), Vec3::UnitX(), forces.x() * Vec3::UnitX());
        world.add_contact(index(i, j, k), index(i, j + 1, k), Vec3::UnitY(), forces.y() * Vec3::UnitY());
        world.add_contact(index(i, j, k), index(i, j, k + 1), Vec3::UnitZ(), forces.z() * Vec3::UnitZ());
      }
  world.make_periodic(Vec3::Zero(), Vec3::Constant(n));
  return world;
}

/// A column of five grains of diameter 1 between a floor and a lid, over 2 × 3, that carries `force` upwards and the
/// moment `at_floor` − z ẑ × force, so that each grain is in equilibrium.
FakeWorld column(const Vec3& force, const Vec3& at_floor) {
  FakeWorld world;
  world.wall = {still_wall("floor"), still_wall("lid")};
  const auto moment = [&](double z) -> Vec3 { return at_floor - z * Vec3::UnitZ().cross(force); };
  for (int k = 0; k < 5; ++k) world.add({0.7, 1.1, 0.5 + k}, 0.5);
  for (std::uint32_t k = 0; k + 1 < 5; ++k) {
    world.add_contact(k, k + 1, Vec3::UnitZ(), force);
    world.contact.back().moment = moment(k + 1.5);
  }
  world.add_wall_contact(4, 1, {0, 0, 0.5}, force);
  world.contact.back().moment = moment(5);
  world.add_wall_contact(0, 0, {0, 0, -0.5}, -force);
  world.contact.back().moment = -moment(0);
  world.whole = {Vec3::Zero(), {2, 3, 5}};
  return world;
}

/// Grains at random, whatever lies near touches, with random forces and moments, periodic along y.
FakeWorld random_world() {
  FakeWorld world;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1), sign(-1, 1);
  const Vec3 size(9, 5, 8);
  for (int i = 0; i < 300; ++i)
    world.add(Vec3(unit(random), unit(random), unit(random)).cwiseProduct(size), 0.3 + 0.4 * unit(random));
  for (std::uint32_t a = 0; a < world.position.size(); ++a)
    for (std::uint32_t b = a + 1; b < world.position.size(); ++b) {
      Vec3 branch = xyz(world.position[b]) - xyz(world.position[a]);
      branch.y() -= size.y() * std::round(branch.y() / size.y());
      if (branch.norm() >= world.position[a].w + world.position[b].w) continue;
      world.add_contact(a, b, branch, 10 * branch + Vec3(sign(random), sign(random), sign(random)));
      world.contact.back().moment = {sign(random), sign(random), sign(random)};
    }
  world.wall.push_back(still_wall("floor"));
  for (std::uint32_t a = 0; a < world.position.size(); ++a)
    if (world.position[a].z < world.position[a].w)
      world.add_wall_contact(a, 0, Vec3(0, 0, -world.position[a].z), Vec3(sign(random), 0, -5));
  world.whole = {Vec3::Zero(), size};
  world.box = {{-1e300, 0, -1e300}, {1e300, size.y(), 1e300}, {false, true, false}};
  return world;
}

TEST(Stress, KnowsTheCubicLattice) {
  const FakeWorld world = cubic(8, {1, 2, 3});
  Stress probe;
  const Mat3 expected = Vec3(1, 2, 3).asDiagonal();
  EXPECT_NEAR((channel_tensor(probe, world, "stress") - expected).norm(), 0, 1e-12);
  EXPECT_NEAR(channel_tensor(probe, world, "couple_stress").norm(), 0, 1e-12);
  EXPECT_NEAR(channel_value(probe, world, "mean_stress"), 2, 1e-12);
  EXPECT_NEAR(channel_value(probe, world, "deviatoric_stress"), std::sqrt(3), 1e-12);
  EXPECT_NEAR(channel_value(probe, world, "friction_angle"), 30, 1e-10);  // asin((3 − 1) / (3 + 1))
  const auto cells = field_values(probe, world, "stress");
  ASSERT_EQ(cells.size(), 4 * 4 * 4 * 9u);  // cubes of 5, moved by 1, in 8
  for (std::size_t n = 0; n < 64; ++n) EXPECT_NEAR((tensor(cells, n) - expected).norm(), 0, 1e-12) << n;
  EXPECT_THAT(field_values(probe, world, "friction_angle"), testing::Each(testing::DoubleNear(30, 1e-10)));
}

TEST(Stress, OfAColumnIsTheWallsForceOverTheArea) {
  const Vec3 force(0.3, -0.2, 7);
  const FakeWorld world = column(force, Vec3::Zero());
  Stress probe;
  probe.averaging.slices = 7;  // which cut grains and contacts anywhere
  Mat3 expected = Mat3::Zero();
  expected.col(2) = force / 6;
  EXPECT_NEAR((channel_tensor(probe, world, "stress") - expected).norm(), 0, 1e-14);
  for (std::size_t s = 0; s < 7; ++s)
    EXPECT_NEAR((slice_tensor(probe, world, "stress_profile", s) - expected).norm(), 0, 1e-14) << s;
  const auto places = channel_values(probe, world, "position");
  for (std::size_t s = 0; s < 7; ++s) EXPECT_NEAR(places[s], (static_cast<double>(s) + 0.5) * 5 / 7, 1e-14);
}

TEST(Stress, OfAColumnThatIsBentAndTwistedHasTheMomentOfEachSection) {
  const Vec3 force(0.3, -0.2, 7), at_floor(0.11, 0.23, 0.05);
  FakeWorld world = column(force, at_floor);
  Stress probe;
  probe.averaging.slices = 9;
  const auto expect_moments = [&] {
    const auto places = channel_values(probe, world, "position");
    for (std::size_t s = 0; s < 9; ++s) {
      Mat3 expected = Mat3::Zero();
      expected.col(2) = (at_floor - places[s] * Vec3::UnitZ().cross(force)) / 6;
      EXPECT_NEAR((slice_tensor(probe, world, "couple_stress_profile", s) - expected).norm(), 0, 1e-14) << s;
    }
  };
  expect_moments();

  // The same column of clumps whose spheres lie off their centres, the forces' lines of action staying where they were.
  for (std::uint32_t k = 0; k < 5; ++k) {
    world.arm.push_back({0.1, 0.05 * k, 0.02});
    world.position[k].x += 0.1, world.position[k].y += 0.05 * k, world.position[k].z += 0.02;
  }
  for (Contact& contact : world.contact) {
    contact.branch -= world.arm[contact.a];
    if (contact.with_wall) continue;
    contact.branch += world.arm[contact.b];
    contact.moment -= world.arm[contact.b].cross(contact.force);
  }
  expect_moments();
}

TEST(Stress, AgreesWithTheMeanOfEachCell) {
  const FakeWorld world = random_world();
  for (const auto& [depth, size, step] :
       std::vector<std::tuple<std::string, double, double>>{{"", 3, 1}, {"y", 2.5, 1}, {"x", 1.3, 0.7}, {"", 1, 2}}) {
    Stress probe;
    probe.averaging.depth_axis = depth, probe.averaging.cell_size = size, probe.averaging.cell_step = step;
    const AveragingCells cells = probe.averaging.cells(world, world.whole);
    const auto stress = field_values(probe, world, "stress");
    ASSERT_EQ(stress.size(), 9 * cells.cells());
    ASSERT_GT(cells.cells(), 8u);
    for (std::size_t n = 0; n < cells.cells(); ++n)
      EXPECT_NEAR((tensor(stress, n) - mean_stress(world, cells.cell(n))).norm(), 0, 1e-10);
  }
}

TEST(Stress, OfSlicesAddsUpToThatOfTheRegion) {
  const FakeWorld world = random_world();
  for (const char* axis : {"x", "y", "z"}) {
    Stress probe;
    probe.averaging.along = axis, probe.averaging.slices = 6;
    Mat3 sum = Mat3::Zero(), couples = Mat3::Zero();
    for (std::size_t s = 0; s < 6; ++s) {
      sum += slice_tensor(probe, world, "stress_profile", s) / 6;
      couples += slice_tensor(probe, world, "couple_stress_profile", s) / 6;
    }
    const Mat3 stress = mean_stress(world, world.whole);
    EXPECT_NEAR((sum - stress).norm(), 0, 1e-12 * stress.norm()) << axis;
    EXPECT_NEAR((couples - channel_tensor(probe, world, "couple_stress")).norm(), 0, 1e-12 * couples.norm()) << axis;
    EXPECT_GT(couples.norm(), 1e-3);
  }
}

TEST(Stress, LooksAtTheRegionThatIsGiven) {
  const FakeWorld world = random_world();
  Stress probe;
  probe.averaging.region_low = Vec3(2, 1, 1), probe.averaging.region_high = Vec3(6, 4.5, 3);
  const Mat3 expected = mean_stress(world, {{2, 1, 1}, {6, 4.5, 3}});
  EXPECT_NEAR((channel_tensor(probe, world, "stress") - expected).norm(), 0, 1e-12 * expected.norm());
  EXPECT_GT((expected - mean_stress(world, world.whole)).norm(), 1e-3 * expected.norm());
}

TEST(Stress, SaysWhatAMapIsToFill) {
  Stress probe;
  probe.averaging.depth_axis = "y", probe.averaging.cell_size = 4, probe.averaging.cell_step = 2;
  const FakeWorld world = cubic(8, {1, 1, 1});
  const auto centre = field_values(probe, world, "centre"), size = field_values(probe, world, "size");
  ASSERT_EQ(centre.size(), 3 * 9u);
  for (std::size_t n = 0; n < 9; ++n) {
    EXPECT_NEAR(centre[3 * n], 2 + 2 * static_cast<double>(n / 3), 1e-12);
    EXPECT_NEAR(centre[3 * n + 1], 4, 1e-12);
    EXPECT_NEAR(centre[3 * n + 2], 2 + 2 * static_cast<double>(n % 3), 1e-12);
    EXPECT_NEAR(size[3 * n], 2, 1e-12);
    EXPECT_NEAR(size[3 * n + 1], 8, 1e-12);
    EXPECT_NEAR(size[3 * n + 2], 2, 1e-12);
  }
}

TEST(Stress, SaysWhereEachNumberOfAListIs) {
  Stress probe;
  int lists = 0;
  for (const Channel& channel : probe.channels()) {
    if (channel.shape != std::vector<std::size_t>{20} || channel.name == "position") continue;
    EXPECT_EQ(channel.coordinate, "position") << channel.name;
    ++lists;
  }
  EXPECT_EQ(lists, 3 + 9 + 9);
}

TEST(Stress, HasNoFrictionAngleInTension) {
  Stress probe;
  EXPECT_TRUE(std::isnan(channel_value(probe, cubic(3, {1, 2, -1}), "friction_angle")));
  EXPECT_TRUE(std::isnan(channel_value(probe, cubic(3, {0, 0, 0}), "friction_angle")));
  EXPECT_NEAR(channel_value(probe, cubic(3, {1, 2, 0}), "friction_angle"), 90, 1e-5);
}

TEST(Stress, IsUnknownInARegionWithoutVolume) {
  Stress probe;
  FakeWorld world = cubic(3, {1, 2, 3});
  world.whole.high.x() = 0;
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "mean_stress")));
  EXPECT_TRUE(field_values(probe, world, "stress").empty());
}

TEST(Stress, HasNoCellsWhereThereWouldBeTooMany) {
  Stress probe;
  probe.averaging.cell_step = 0.1;
  FakeWorld world = cubic(3, {1, 2, 3});
  world.whole.high = Vec3::Constant(30);
  EXPECT_TRUE(field_values(probe, world, "stress").empty());  // 500³ parts
  EXPECT_NEAR(channel_value(probe, world, "mean_stress"), 2, 1e-12) << "the profile does not mind";
}

TEST(Stress, RefusesARegionThatIsInsideOut) {
  Stress probe;
  probe.averaging.region_low = Vec3(0, 0, 2), probe.averaging.region_high = Vec3(1, 1, 2);
  EXPECT_EQ(complaints(probe), "region_high: found z = 2.000000 m, allowed: above that of region_low, 2.000000 m\n");
}

INSTANTIATE_TEST_SUITE_P(Stress, ProbeContract,
                         testing::Values(ProbeCase{"cubes", [] { return std::make_shared<Stress>(); }},
                                         ProbeCase{"columns",
                                                   [] {
                                                     auto probe = std::make_shared<Stress>();
                                                     probe->averaging.depth_axis = "y", probe->averaging.cell_size = 2;
                                                     probe->averaging.along = "x";
                                                     return probe;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
