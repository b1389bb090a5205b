#include "interface.hpp"

#include <gmock/gmock.h>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::HasSubstr;

Interface made(const std::string& wall = "surface", const std::string& driven_by = "lid") {
  Interface probe;
  probe.layer.wall = wall, probe.layer.driven_by = driven_by;
  return probe;
}

/// Three spheres of radius 0.1 on a surface of 2 m² at z = 0 that have gone `way` along x, rolling; one far above them.
FakeWorld rolling(double way) {
  FakeWorld world;
  world.wall = {still_wall("surface"), still_wall("lid")};
  world.wall[0].normal = Vec3::UnitZ(), world.wall[1].normal = -Vec3::UnitZ();
  world.surface = {flat_surface(Vec3::Zero(), Vec3::UnitZ()), flat_surface(Vec3::UnitZ(), -Vec3::UnitZ())};
  world.wall[0].area = world.wall[1].area = 2;
  world.wall[1].stage_position = {4 * way, 0, 0};
  for (const Vec3& start : {Vec3(0.2, 0, 0.1), Vec3(0.4, 0, 0.1), Vec3(0.6, 0, 0.1), Vec3(0.4, 0, 0.9)}) {
    world.add(start + Vec3(way, 0, 0), 0.1);
    world.displacement.push_back({way, 5, 0});
    world.rotation.push_back({7, way / 0.1, 7});
  }
  return world;
}

TEST(Interface, HasARotationRatioOfTwoWhereGrainsRollWithoutSlipping) {
  Interface probe = made();
  FakeWorld world = rolling(0);
  probe.prepare(world);
  for (const auto* name : {"rotation_ratio", "slip_ratio", "traction_ratio"})
    EXPECT_TRUE(std::isnan(channel_value(probe, world, name))) << name;
  for (const double way : {0.3, -0.3}) {
    world = rolling(way);
    EXPECT_NEAR(channel_value(probe, world, "slip"), way, 1e-15);
    EXPECT_NEAR(channel_value(probe, world, "rotation"), way / 0.1, 1e-14);
    EXPECT_NEAR(channel_value(probe, world, "rotation_ratio"), 2, 1e-14);
    EXPECT_NEAR(channel_value(probe, world, "slip_ratio"), 0.25, 1e-15);
    EXPECT_EQ(channel_value(probe, world, "bodies"), 3);
  }
}

TEST(Interface, AddsUpWhatContactsExertOnTheWall) {
  FakeWorld world = rolling(0.3);
  // Forces of 3 and 5 N along x, the second in a groove 0.02 deep; rolling resistance turns the wall as the grains
  // turn.
  world.add_wall_contact(0, 0, Vec3(0, 0, -0.1), Vec3(3, 0, -9));
  world.add_wall_contact(1, 0, Vec3(0, 0, -0.12), Vec3(5, 1, -9));
  world.add_wall_contact(3, 1, Vec3(0, 0, 0.1), Vec3(100, 0, 9));
  world.contact[0].moment = {9, 0.4, 9}, world.contact[1].moment = {9, 0.6, 9}, world.contact[2].moment = {9, 9, 9};
  Interface probe = made();
  probe.prepare(world);
  const double couple = 0.4 + 0.6 - 0.02 * 5;
  // The specimen covers half of the wall, 1 m² of 2 m²; then all of it.
  EXPECT_NEAR(channel_value(probe, world, "shear_traction"), 8, 1e-14);
  EXPECT_NEAR(channel_value(probe, world, "couple_traction"), couple, 1e-14);
  world.wall[0].area = 0.5;
  EXPECT_NEAR(channel_value(probe, world, "shear_traction"), 8 / 0.5, 1e-13);
  EXPECT_NEAR(channel_value(probe, world, "couple_traction"), couple / 0.5, 1e-13);
  EXPECT_NEAR(channel_value(probe, world, "traction_ratio"), 8 * 0.2 / couple, 1e-13);
  // arm.
  world.wall[0].area = 0;  // endless
  EXPECT_NEAR(channel_value(probe, world, "shear_traction"), 8, 1e-14);
  EXPECT_NEAR(channel_value(probe, world, "traction_ratio"), 8 * 0.2 / couple, 1e-13);
}

// Turned by half a turn about x and about z the same happens at a wall above, and along −x.
TEST(Interface, IsTheSameAtAWallAboveAndTheOtherWayAround) {
  FakeWorld world = rolling(0.3);
  world.add_wall_contact(0, 0, Vec3(0, 0, -0.12), Vec3(3, 0, -9));
  world.contact[0].moment = {0, 0.4, 0};
  Interface straight = made();
  straight.prepare(world);

  for (const Vec3& half : {Vec3(1, -1, -1), Vec3(-1, -1, 1)}) {
    const auto turn = [&](FakeWorld w) {
      const auto vector = [&](Vec3& v) { v = v.cwiseProduct(half); };
      for (Row& row : w.position) {
        const Vec3 at = (xyz(row) - Vec3::Constant(0.5)).cwiseProduct(half) + Vec3::Constant(0.5);
        row = {at.x(), at.y(), at.z(), row.w};
      }
      if (half.z() < 0)
        w.surface = {flat_surface(Vec3::UnitZ(), -Vec3::UnitZ()), flat_surface(Vec3::Zero(), Vec3::UnitZ())};
      for (Vec3& v : w.displacement) vector(v);
      for (Vec3& v : w.rotation) vector(v);
      for (WallView& wall : w.wall) vector(wall.normal), vector(wall.stage_position);
      for (Contact& c : w.contact) vector(c.branch), vector(c.normal), vector(c.force), vector(c.moment);
      return w;
    };
    Interface probe = made();
    const FakeWorld start = turn(rolling(0)), now = turn(world);
    probe.prepare(start);
    const double sign = half.x();
    for (const auto* name : {"slip", "rotation", "shear_traction", "couple_traction"})
      EXPECT_NEAR(channel_value(probe, now, name), sign * channel_value(straight, world, name), 1e-14) << name;
    for (const auto* name : {"bodies", "rotation_ratio", "slip_ratio", "traction_ratio"})
      EXPECT_NEAR(channel_value(probe, now, name), channel_value(straight, world, name), 1e-13) << name;
  }
}

TEST(Interface, RefusesAWallThatThereIsNot) {
  try {
    made("surfaces").prepare(rolling(0));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("wall: found \"surfaces\", which is not a wall; did you mean"));
  }
  Interface across = made();
  across.layer.axis = "z";
  EXPECT_THROW(across.prepare(rolling(0)), Error);
  FakeWorld elsewhere = rolling(0);
  elsewhere.whole.low.z() = -0.2;
  EXPECT_THAT([&] { made().prepare(elsewhere); },
              testing::ThrowsMessage<ParameterError>(
                  "wall: found wall \"surface\", at which the specimen does not end; allowed is a wall that bounds the "
                  "specimen; name it in /specimen"));
}

INSTANTIATE_TEST_SUITE_P(Interface, ProbeContract,
                         testing::Values(ProbeCase{"lattice",
                                                   [] {
                                                     auto probe = std::make_shared<Interface>();
                                                     probe->layer.wall = "bottom", probe->layer.driven_by = "top-wall";
                                                     return probe;
                                                   },
                                                   [] {
                                                     FakeWorld world = lattice_world(6, 4, 8);
                                                     world.displacement.assign(world.position.size(), {1e-3, 0, 0});
                                                     world.rotation.assign(world.position.size(), {0, 0.1, 0});
                                                     world.wall[1].stage_position = {2e-3, 0, 0};
                                                     return world;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
