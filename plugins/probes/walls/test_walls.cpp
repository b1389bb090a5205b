#include "walls.hpp"

#include <gmock/gmock.h>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

WallView wall_named(const std::string& name) {
  WallView wall = still_wall(name);
  wall.position = {1, 2, 3}, wall.stage_position = {-1, -2, -3}, wall.velocity = {4, 5, 6};
  wall.force = {7, 8, 9}, wall.moment = {10, 11, 12};
  wall.area = 0.5, wall.pressure = 18, wall.contacts = 42;
  return wall;
}

FakeWorld world_with(const std::vector<std::string>& names) {
  FakeWorld world;
  for (const auto& name : names) world.wall.push_back(wall_named(name));
  return world;
}

std::vector<std::string> names_of(const Probe& probe) {
  std::vector<std::string> names;
  for (const auto& channel : probe.channels()) names.push_back(channel.name);
  return names;
}

std::string error_of(WallsProbe& probe, const World& world) {
  try {
    probe.prepare(world);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(WallsProbe, ReportsWhatTheWallSays) {
  const FakeWorld world = world_with({"top"});
  WallsProbe probe;
  probe.prepare(world);
  EXPECT_THAT(names_of(probe),
              ElementsAre("top_position", "top_velocity", "top_force", "top_moment", "top_pressure", "top_contacts"));
  EXPECT_THAT(channel_values(probe, world, "top_position"), ElementsAre(1, 2, 3));
  EXPECT_THAT(channel_values(probe, world, "top_velocity"), ElementsAre(4, 5, 6));
  EXPECT_THAT(channel_values(probe, world, "top_force"), ElementsAre(7, 8, 9));
  EXPECT_THAT(channel_values(probe, world, "top_moment"), ElementsAre(10, 11, 12));
  EXPECT_THAT(channel_values(probe, world, "top_pressure"), ElementsAre(18));
  EXPECT_THAT(channel_values(probe, world, "top_contacts"), ElementsAre(42));
}

TEST(WallsProbe, ReportsSpinsIfWanted) {
  FakeWorld world = world_with({"top"});
  world.wall[0].spin = {13, 14, 15};
  WallsProbe probe;
  probe.spin = true;
  probe.prepare(world);
  ASSERT_EQ(names_of(probe).size(), 7u);
  EXPECT_EQ(names_of(probe)[6], "top_spin");
  EXPECT_THAT(channel_values(probe, world, "top_spin"), ElementsAre(13, 14, 15));
}

TEST(WallsProbe, ReportsAllWallsOrTheNamedOnesInTheirOrder) {
  FakeWorld world = world_with({"top", "left-upper", "2nd"});
  world.wall[2].pressure = 5;
  WallsProbe all;
  all.prepare(world);
  EXPECT_EQ(names_of(all).size(), 18u);
  EXPECT_EQ(names_of(all)[6], "left_upper_position");
  EXPECT_EQ(names_of(all)[12], "wall_2nd_position");

  WallsProbe two;
  two.walls = {"2nd", "top"};
  two.prepare(world);
  ASSERT_EQ(names_of(two).size(), 12u);
  EXPECT_EQ(names_of(two)[0], "wall_2nd_position");
  EXPECT_EQ(names_of(two)[6], "top_position");
  EXPECT_EQ(channel_value(two, world, "wall_2nd_pressure"), 5);
  EXPECT_EQ(channel_value(two, world, "top_pressure"), 18);
}

TEST(WallsProbe, RefusesAWallThatIsNotThere) {
  WallsProbe probe;
  probe.walls = {"botom"};
  EXPECT_EQ(error_of(probe, world_with({"top", "bottom"})),
            "walls: found \"botom\", which is not a wall; did you mean \"bottom\"? Allowed is one of the walls top, "
            "bottom");
  EXPECT_EQ(error_of(probe, world_with({})),
            "walls: found \"botom\", which is not a wall; allowed is none, as the description has no walls");
}

TEST(WallsProbe, RefusesWallsWithTheSameChannels) {
  WallsProbe probe;
  EXPECT_EQ(
      error_of(probe, world_with({"a-b", "a_b"})),
      "walls: found walls \"a-b\" and \"a_b\", whose channels would both be \"a_b_…\"; allowed is one of the two; "
      "remove one, or rename it");
  probe.walls = {"a-b"};
  EXPECT_EQ(error_of(probe, world_with({"a-b", "a_b"})), "no error");
}

INSTANTIATE_TEST_SUITE_P(Walls, ProbeContract,
                         testing::Values(ProbeCase{"all", [] { return std::make_shared<WallsProbe>(); }},
                                         ProbeCase{"one",
                                                   [] {
                                                     auto probe = std::make_shared<WallsProbe>();
                                                     probe->walls = {"top-wall"};
                                                     return probe;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
