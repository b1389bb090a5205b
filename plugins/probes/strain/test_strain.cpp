#include "strain.hpp"

#include <gmock/gmock.h>

#include <random>
#include <stdexcept>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

const std::vector<double>& values_of(const std::vector<Field>& fields, const std::string& name) {
  for (const Field& field : fields)
    if (field.name == name) return field.values;
  throw std::runtime_error("no field " + name);
}

/// Bodies strewn over a block, moved by a deformation x = F X + shift.
FakeWorld deformed(const Mat3& gradient, const Vec3& shift = Vec3::Zero()) {
  FakeWorld world;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(0, 1);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 place(0.06 * draw(random), 0.005 * draw(random), 0.02 * draw(random));
    const Vec3 moved = gradient * place + shift - place;
    world.add(place + moved, 0.5e-3);
    world.displacement.push_back(moved);
  }
  world.whole = {Vec3::Zero(), {0.06, 0.005, 0.02}};
  return world;
}

void expect_everywhere(const Mat3& gradient, const Vec3& shift, double exx, double ezz, double exz) {
  const FakeWorld world = deformed(gradient, shift);
  Strain probe;
  probe.prepare(world);
  const auto whole = channel_values(probe, world, "strain");
  EXPECT_NEAR(whole[0], exx, 1e-10);
  EXPECT_NEAR(whole[1], ezz, 1e-10);
  EXPECT_NEAR(whole[2], exz, 1e-10);
  EXPECT_NEAR(channel_values(probe, world, "largest_shear").at(0), std::abs(exz), 1e-10);
  const auto fields = probe.fields(world);
  const auto &bodies = values_of(fields, "bodies"), &strain = values_of(fields, "strain");
  const std::size_t subsets = bodies.size();
  ASSERT_GT(subsets, 500u);
  for (std::size_t s = 0; s < subsets; ++s) {
    ASSERT_GT(bodies[s], 20);
    EXPECT_NEAR(strain[3 * s], exx, 1e-10) << s;
    EXPECT_NEAR(strain[3 * s + 1], ezz, 1e-10) << s;
    EXPECT_NEAR(strain[3 * s + 2], exz, 1e-10) << s;
  }
}

TEST(Strain, OfAUniformOneIsThatEverywhere) {
  Mat3 gradient = Mat3::Identity();
  gradient(0, 0) = 1.02, gradient(2, 2) = 0.97, gradient(0, 2) = 0.1;
  // FᵀF − 1 over two.
  expect_everywhere(gradient, {1e-3, 0, -2e-3}, 0.5 * (1.02 * 1.02 - 1), 0.5 * (0.97 * 0.97 + 0.01 - 1),
                    0.5 * 1.02 * 0.1);
}

TEST(Strain, OfARigidTurnIsNone) {
  expect_everywhere(Eigen::AngleAxisd(0.4, Vec3::UnitY()).toRotationMatrix(), {0.01, 0, 0}, 0, 0, 0);
}

TEST(Strain, IsLocal) {
  // Sheared above the middle alone.
  FakeWorld world = deformed(Mat3::Identity());
  for (std::size_t i = 0; i < world.position.size(); ++i) {
    const double shear = 0.2 * std::max(0.0, world.position[i].z - 0.01);
    world.position[i].x += shear, world.displacement[i].x() += shear;
  }
  Strain probe;
  probe.subset = 4;
  probe.prepare(world);
  const auto fields = probe.fields(world);
  int below = 0, above = 0;
  const auto &began = values_of(fields, "start_position"), &strain = values_of(fields, "strain");
  for (std::size_t s = 0; s < strain.size() / 3; ++s) {
    const double z = began[2 * s + 1];
    const double shear = strain[3 * s + 2];
    if (z < 0.0079) {
      ++below;
      EXPECT_NEAR(shear, 0, 1e-12);
    } else if (z > 0.0121) {
      ++above;
      EXPECT_NEAR(shear, 0.1, 1e-10);
    }
  }
  EXPECT_GT(below, 100);
  EXPECT_GT(above, 100);
}

TEST(Strain, IsUnknownWhereBodiesAreTooFew) {
  FakeWorld world;
  for (const double x : {0.0, 1e-3, 2e-3}) world.add({x, 0, x * x}, 0.5e-3), world.displacement.push_back({x, 0, 0});
  Strain probe;
  EXPECT_TRUE(std::isnan(channel_values(probe, world, "strain").at(0)));
  EXPECT_EQ(channel_values(probe, world, "largest_shear").at(0), 0);
  // In one line.
  for (const double x : {3e-3, 4e-3}) world.add({x, 0, 0}, 0.5e-3), world.displacement.push_back({x, 0, 0});
  for (Row& row : world.position) row.z = 0;
  EXPECT_TRUE(std::isnan(channel_values(probe, world, "strain").at(0)));
}

TEST(Strain, IsUnknownInACellThatDeforms) {
  FakeWorld world = deformed(Mat3::Identity());
  world.box = {Vec3::Zero(), {0.06, 0.005, 0.02}, {true, false, false}};
  Strain probe;
  EXPECT_EQ(channel_values(probe, world, "strain").at(0), 0);
  world.box.strain_rate.x() = -1;
  EXPECT_TRUE(std::isnan(channel_values(probe, world, "strain").at(0)));
  EXPECT_THAT(values_of(probe.fields(world), "bodies"), testing::IsEmpty());
}

TEST(Strain, CountsBodiesThatCrossedAPeriodicSideWhereTheyBegan) {
  FakeWorld world = deformed(Mat3::Identity(), {0.01, 0, 0});
  world.box = {Vec3::Zero(), {0.06, 0.005, 0.02}, {true, false, false}};
  for (Row& row : world.position)
    if (row.x > 0.06) row.x -= 0.06;
  Strain probe;
  for (const double strain : channel_values(probe, world, "strain")) EXPECT_NEAR(strain, 0, 1e-12);
  const auto fields = probe.fields(world);
  for (const double place : values_of(fields, "start_position")) EXPECT_LT(place, 0.06);
  const auto& centre = values_of(fields, "centre");
  double least = 1;
  for (std::size_t i = 0; i < centre.size(); i += 3) {
    EXPECT_LT(centre[i], 0.06);
    least = std::min(least, centre[i]);
  }
  EXPECT_LT(least, 0.01) << "the last have come round";
}

TEST(Strain, HasItsSubsetsGoAsTheirBodiesDo) {
  const FakeWorld world = deformed(Mat3::Identity(), {0.01, 0, -2e-3});
  Strain probe;
  const auto fields = probe.fields(world);
  const auto &centre = values_of(fields, "centre"), &size = values_of(fields, "size"),
             &began = values_of(fields, "start_position");
  ASSERT_EQ(centre.size() / 3, began.size() / 2);
  ASSERT_EQ(size.size(), centre.size());
  for (std::size_t s = 0; s < centre.size() / 3; ++s) {
    EXPECT_NEAR(centre[3 * s], began[2 * s] + 0.01, 1e-12);
    EXPECT_EQ(centre[3 * s + 1], 0.0025) << "the middle of the specimen";
    EXPECT_NEAR(centre[3 * s + 2], began[2 * s + 1] - 2e-3, 1e-12);
    EXPECT_NEAR(size[3 * s], 1e-3, 1e-12);
    EXPECT_EQ(size[3 * s + 1], 0.005);
  }
  EXPECT_THAT(fields.back().components, testing::ElementsAre("xx", "zz", "xz"));
}

/// Rows of grains of 1 mm between two walls that are perpendicular to z, of which the lower one has gone back by 3 mm.
/// Bodies in its layer went with it, but for those with x below `slides_below`, which stayed.
FakeWorld sliding_along(double slides_below) {
  FakeWorld world;
  world.whole = {Vec3::Zero(), {0.06, 0.005, 0.02}};
  for (const double sign : {1.0, -1.0}) {
    WallView wall;
    wall.name = sign > 0 ? "low" : "high";
    wall.normal = sign * Vec3::UnitZ();
    wall.position = wall.stage_position = Vec3(sign > 0 ? -3e-3 : 0, 0, 0);
    world.wall.push_back(wall);
  }
  for (int i = 0; i < 60; ++i)
    for (int k = 0; k < 20; ++k) {
      const Vec3 place((i + 0.5) * 1e-3, 2.5e-3, (k + 0.5) * 1e-3);
      world.add(place, 0.5e-3);
      world.displacement.push_back({k == 0 && place.x() > slides_below ? -2.9e-3 : 0, 0, 0});
    }
  return world;
}
Strain told_along(const FakeWorld& world, const std::string& wall = "low") {
  Strain probe;
  probe.sliding.emplace();
  probe.sliding->wall = wall, probe.sliding->driven_by = "high";
  probe.prepare(world);
  return probe;
}

TEST(Sliding, IsToldFromShearByWhatGoesWithTheWall) {
  FakeWorld world = sliding_along(0.02);
  Strain probe = told_along(world);
  EXPECT_NEAR(channel_value(probe, world, "surface_length"), 0.02, 1e-15);
  EXPECT_NEAR(channel_value(probe, world, "internal_length"), 0.04, 1e-15);
  EXPECT_NEAR(channel_value(probe, world, "contact_factor"), 1.0 / 3, 1e-14);
  // The same upside down, and driven the other way.
  for (std::size_t i = 0; i < world.position.size(); ++i) world.position[i].z = 0.02 - world.position[i].z;
  for (WallView& wall : world.wall) wall.normal = -wall.normal;
  for (Vec3& moved : world.displacement) moved = -moved;
  world.wall[0].stage_position = -world.wall[0].stage_position;
  EXPECT_NEAR(channel_value(probe, world, "contact_factor"), 1.0 / 3, 1e-14);
}

TEST(Sliding, IsToldBySharesOfWhatTheWallWasDriven) {
  FakeWorld world = sliding_along(0.06);
  for (std::size_t i = 0; i < world.position.size(); ++i)
    if (world.position[i].z < 1e-3) world.displacement[i].x() = -3e-3 * (1 - world.position[i].x / 0.06);
  Strain probe = told_along(world);
  EXPECT_NEAR(channel_value(probe, world, "contact_factor"), 0.5, 1e-14);
  probe.sliding->min_fraction = 0.75;
  EXPECT_NEAR(channel_value(probe, world, "contact_factor"), 0.25, 1e-14);
}

TEST(Sliding, IsNeitherWithoutBodiesAndUnknownBeforeTheWallIsDriven) {
  FakeWorld world = sliding_along(0.02);
  for (std::size_t i = 0; i < world.position.size(); ++i)
    if (world.position[i].x > 0.05) world.position[i].z += 5e-3;
  Strain probe = told_along(world);
  EXPECT_NEAR(channel_value(probe, world, "surface_length"), 0.02, 1e-15);
  EXPECT_NEAR(channel_value(probe, world, "internal_length"), 0.03, 1e-15);
  world.wall[0].stage_position.setZero();
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "contact_factor")));
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "surface_length")));
}

TEST(Sliding, NeedsAWallInThePlane) {
  FakeWorld world = sliding_along(0.02);
  const auto refusal = [&](const std::string& wall) -> std::string {
    try {
      told_along(world, wall);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal("low"), "");
  EXPECT_THAT(refusal("lower"), testing::HasSubstr("sliding/wall: found \"lower\", which is not a wall"));
  world.wall[0].normal = Vec3::UnitY();
  EXPECT_EQ(
      refusal("low"),
      "sliding/wall: found wall \"low\"; allowed is a wall perpendicular to x or z, the axes of the probe's plane; "
      "name another wall, or another depth_axis");
}

INSTANTIATE_TEST_SUITE_P(Strain, ProbeContract,
                         testing::Values(ProbeCase{"lattice", [] { return std::make_shared<Strain>(); },
                                                   [] {
                                                     FakeWorld world = lattice_world(9, 4, 8);
                                                     for (const Row& x : world.position)
                                                       world.displacement.push_back({0.1 * x.z, 0, x.x * x.z});
                                                     return world;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
