#include "slip.hpp"

#include <gmock/gmock.h>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A surface below and a lid above a specimen from z = 0 to 1; a mean diameter of 0.2.
FakeWorld world_between() {
  FakeWorld world;
  world.wall = {still_wall("surface"), still_wall("lid")};
  world.wall[0].normal = Vec3::UnitZ(), world.wall[1].normal = -Vec3::UnitZ();
  world.surface = {flat_surface(Vec3::Zero(), Vec3::UnitZ()), flat_surface(Vec3::UnitZ(), -Vec3::UnitZ())};
  return world;
}
void add(FakeWorld& world, const Vec3& at_start, const Vec3& displacement) {
  world.add(at_start + displacement, 0.1);
  world.displacement.push_back(displacement);
}

Slip made(const std::string& wall = "surface", const std::string& driven_by = "lid") {
  Slip probe;
  probe.layer.wall = wall, probe.layer.driven_by = driven_by;
  return probe;
}

TEST(Slip, IsTheMeanOfTheLayerThatLayAtTheWallWhenTheStageBegan) {
  FakeWorld world = world_between();
  world.wall[1].stage_position = {0.4, 0, 0};
  add(world, {0.5, 0, 0.09}, {0.1, 7, 0.5});    // has risen since
  add(world, {0.5, 0, -0.5}, {0.0, 7, 0});      // in a groove
  add(world, {0.5, 0, 0.11}, {9.0, 7, -0.11});  // has come down to the wall
  Slip probe = made();
  probe.prepare(world);
  EXPECT_THAT(channel_values(probe, world, "displacement"), ElementsAre(testing::DoubleEq(0.05)));
  EXPECT_THAT(channel_values(probe, world, "fraction"), ElementsAre(testing::DoubleEq(0.125)));
  EXPECT_THAT(channel_values(probe, world, "bodies"), ElementsAre(2));
  probe.layer.thickness = 0.6;
  EXPECT_THAT(channel_values(probe, world, "bodies"), ElementsAre(3));
}

TEST(Slip, IsTheSameForASurfaceThatMovesAndForOneOnTop) {
  FakeWorld world = world_between();
  // The surface is driven by -0.4 and down by 0.2; the specimen's face is where the surface is now.
  world.wall[0].stage_position = {-0.4, 0, -0.2}, world.whole.low.z() = -0.2;
  world.surface[0] = flat_surface(Vec3(0, 0, -0.2), Vec3::UnitZ());
  add(world, {0.5, 0, 0.05}, {-0.3, 0, -0.2});
  Slip below = made();
  below.prepare(world);
  EXPECT_THAT(channel_values(below, world, "fraction"), ElementsAre(testing::DoubleEq(0.25)));

  FakeWorld turned = world_between();
  turned.wall[0].stage_position = {0.4, 0, 0};
  add(turned, {0.5, 0, 0.95}, {0.1, 0, 0});
  add(turned, {0.5, 0, 0.05}, {0.3, 0, 0});
  Slip above = made("lid", "surface");
  above.prepare(turned);
  EXPECT_THAT(channel_values(above, turned, "fraction"), ElementsAre(testing::DoubleEq(0.25)));
}

TEST(Slip, IsNoneBeforeAnythingMovesAndWithoutALayer) {
  FakeWorld world = world_between();
  add(world, {0.5, 0, 0.05}, Vec3::Zero());
  Slip probe = made();
  probe.prepare(world);
  EXPECT_THAT(channel_values(probe, world, "fraction"), ElementsAre(0));
  FakeWorld empty = world_between();
  empty.wall[1].stage_position = {0.4, 0, 0};
  EXPECT_THAT(channel_values(probe, empty, "displacement"), ElementsAre(0));
}

std::string refusal(Slip probe, FakeWorld world = world_between()) {
  try {
    probe.prepare(world);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Slip, RefusesWallsThatThereAreNotOrThatFaceTheWrongWay) {
  EXPECT_THAT(refusal(made("surfaces")), HasSubstr("wall: found \"surfaces\", which is not a wall; did you mean"));
  EXPECT_THAT(refusal(made("surface", "led")), HasSubstr("driven_by: found \"led\", which is not a wall"));
  Slip across = made();
  across.layer.axis = "z";
  EXPECT_EQ(
      refusal(across),
      "axis: found z, to which wall \"surface\" is perpendicular; allowed is an axis in the plane of the wall, along "
      "which bodies slip");
  FakeWorld aslant = world_between();
  aslant.wall[0].normal = Vec3(0, 0.6, 0.8);
  EXPECT_EQ(refusal(made(), aslant), "wall: found wall \"surface\"; allowed is a wall perpendicular to x, y or z");
}

TEST(Slip, RefusesAWallAtWhichTheSpecimenDoesNotEnd) {
  FakeWorld world = world_between();
  add(world, {0.5, 0, 0.3}, Vec3::Zero());
  EXPECT_EQ(refusal(made(), world), "");
  EXPECT_EQ(refusal(made("lid", "surface"), world), "");
  const char* const not_there =
      "wall: found wall \"surface\", at which the specimen does not end; allowed is a wall that bounds the specimen; "
      "name "
      "it in /specimen";
  for (const double way : {-0.11, 1e-3}) {  // off by more than half a diameter, or before the face
    FakeWorld elsewhere = world;
    elsewhere.surface[0] = flat_surface(Vec3(0, 0, way), Vec3::UnitZ());
    EXPECT_EQ(refusal(made(), elsewhere), not_there) << way;
  }
  FakeWorld grooved = world;
  grooved.surface[0] = flat_surface(Vec3(0, 0, -0.09), Vec3::UnitZ());  // as the bottom of a groove
  EXPECT_EQ(refusal(made(), grooved), "");
  FakeWorld deep = world;
  deep.surface[0] = flat_surface(Vec3(0, 0, -0.6), Vec3::UnitZ());
  EXPECT_EQ(refusal(made(), deep), not_there);
  deep.with_grooves = deep.whole, deep.with_grooves->low.z() = -0.6;  // of a groove three diameters deep
  EXPECT_EQ(refusal(made(), deep), "");
  grooved.whole.low.z() = -std::numeric_limits<double>::infinity();  // the specimen ends at its bodies
  EXPECT_EQ(refusal(made(), grooved), not_there);
}

INSTANTIATE_TEST_SUITE_P(Slip, ProbeContract,
                         testing::Values(ProbeCase{"lattice",
                                                   [] {
                                                     auto probe = std::make_shared<Slip>();
                                                     probe->layer.wall = "bottom", probe->layer.driven_by = "top-wall";
                                                     return probe;
                                                   },
                                                   [] {
                                                     FakeWorld world = lattice_world(6, 4, 8);
                                                     world.displacement.assign(world.position.size(), {1e-3, 0, 0});
                                                     world.wall[1].stage_position = {2e-3, 0, 0};
                                                     return world;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
