#include "facets.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <numbers>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

/// Two triangles in the plane z = 0, of 0.5 and 1 m², towards +z, and one without an area.
struct Sheet final : Geometry {
  void declare(Parameters&) override {}
  Bounds bounds() const override { return {{0, 0, 0}, {2, 1, 0}}; }
  double area() const override { return 1.5; }
  Vec3 normal() const override { return Vec3::UnitZ(); }
  void find_contacts(const Pose&, std::span<const Sphere>, std::vector<SurfaceContact>&) const override {}
  bool near(const Pose&, const Vec3&, double) const override { return false; }
  std::vector<Vec3> triangles() const override {
    return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {2, 0, 0}, {0, -1, 0}, {1, 1, 0}, {1, 1, 0}, {1, 1, 0}};
  }
  std::optional<std::uint32_t> triangle_of(std::uint32_t feature) const override { return feature / 7; }
};
/// A shape of which a triangle is a picture.
struct Round final : Geometry {
  void declare(Parameters&) override {}
  Bounds bounds() const override { return {{0, 0, 0}, {1, 1, 1}}; }
  double area() const override { return 0; }
  Vec3 normal() const override { return Vec3::Zero(); }
  void find_contacts(const Pose&, std::span<const Sphere>, std::vector<SurfaceContact>&) const override {}
  bool near(const Pose&, const Vec3&, double) const override { return false; }
  std::vector<Vec3> triangles() const override { return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}; }
};
const Sheet sheet;
const Round round_one;

/// A mesh and another wall, with contacts that press down with `factor`.
FakeWorld world_with(double factor = 1) {
  FakeWorld world;
  world.wall = {still_wall("other"), still_wall("mesh")};
  world.wall[0].geometry = &round_one, world.wall[1].geometry = &sheet;
  const auto touch = [&](std::uint32_t wall, std::uint32_t feature, const Vec3& force) {
    world.add_wall_contact(world.add({0, 0, 0.1}, 0.1), wall, {0, 0, -0.1}, factor * force);
    world.contact.back().feature = feature;
  };
  touch(1, 0, {3, 0, -4});
  touch(1, 6, {0, 1, -2});   // on a corner of the first
  touch(0, 7, {0, 0, -50});  // of the other wall
  touch(1, 15, {0, 0, -7});  // of the one without an area
  return world;
}
FacetsProbe made() {
  FacetsProbe probe;
  probe.wall = "mesh";
  return probe;
}
std::vector<double> field(const std::vector<Field>& fields, const std::string& name) {
  return std::ranges::find(fields, name, &Field::name)->values;
}

TEST(Facets, ShowForcesOverAreas) {
  const FakeWorld world = world_with();
  FacetsProbe probe = made();
  probe.prepare(world);
  const auto fields = probe.fields(world);
  EXPECT_THAT(field(fields, "area"), ElementsAre(DoubleEq(0.5), DoubleEq(1), 0));
  EXPECT_THAT(field(fields, "pressure"), ElementsAre(DoubleEq(12), 0, 0));
  EXPECT_THAT(field(fields, "shear"), ElementsAre(DoubleEq(6), DoubleEq(2), 0, 0, 0, 0, 0, 0, 0));
  for (const Field& one : fields) EXPECT_EQ(one.wall, "mesh");
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "largest_pressure"), 12);
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "largest_shear"), std::sqrt(40));
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "loaded_fraction"), 1.0 / 3);
}

TEST(Facets, AverageTheSamplesSinceTheFrameBefore) {
  FacetsProbe probe = made();
  probe.prepare(world_with());
  for (const double factor : {1.0, 2.0, 6.0}) sampled(probe, world_with(factor));
  EXPECT_THAT(field(probe.fields(world_with(100)), "pressure"), ElementsAre(DoubleEq(36), 0, 0));
  EXPECT_THAT(field(probe.fields(world_with(5)), "pressure"), ElementsAre(DoubleEq(60), 0, 0)) << "no sample since";
  sampled(probe, world_with(2));
  EXPECT_THAT(field(probe.fields(world_with(9)), "shear"), ElementsAre(DoubleEq(12), DoubleEq(4), 0, 0, 0, 0, 0, 0, 0));
}

TEST(Facets, TurnWithTheWall) {
  FakeWorld world = world_with();
  const Mat3 turn = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()).toRotationMatrix();
  world.wall[1].pose.turn = turn;
  for (Contact& contact : world.contact) contact.force = turn * contact.force, contact.normal = turn * contact.normal;
  FacetsProbe probe = made();
  probe.prepare(world);
  EXPECT_NEAR(field(probe.fields(world), "pressure")[0], 12, 1e-14);
  EXPECT_NEAR(field(probe.fields(world), "shear")[2], 2, 1e-14);
}

TEST(Facets, AddPressuresOnBothSidesOfASheet) {
  FakeWorld world = world_with();
  world.add_wall_contact(world.add({0, 0, -0.1}, 0.1), 1, {0, 0, 0.1}, {0, 0, 10});
  FacetsProbe probe = made();
  probe.prepare(world);
  EXPECT_NEAR(field(probe.fields(world), "pressure")[0], 32, 1e-14);
}

std::string refusal(const std::string& wall) {
  FacetsProbe probe;
  probe.wall = wall;
  try {
    probe.prepare(world_with());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Facets, RefuseOtherWalls) {
  EXPECT_EQ(refusal("other"),
            "wall: found wall \"other\", whose surface does not consist of triangles; allowed is a wall of type mesh");
  EXPECT_THAT(refusal("mehs"), testing::HasSubstr("wall: found \"mehs\", which is not a wall; did you mean"));
}

INSTANTIATE_TEST_SUITE_P(Facets, ProbeContract,
                         testing::Values(ProbeCase{"sheet", [] { return std::make_shared<FacetsProbe>(made()); },
                                                   [] { return world_with(); }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
