#include "force-chains.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <numeric>

#include "contracts/probe.hpp"

namespace grit {
namespace {

using testing::ElementsAre;

constexpr double degree = std::numbers::pi / 180;

/// Two grains with contacts between them: {angle in the xz plane [degrees], normal force}.
FakeWorld world_of(const std::vector<std::pair<double, double>>& contacts) {
  FakeWorld world;
  world.add({0, 0, 0}, 1), world.add({0, 0, 2}, 1);
  for (const auto& [angle, force] : contacts) {
    const Vec3 normal(std::cos(angle * degree), 0, std::sin(angle * degree));
    world.touch(0, 1, 2 * normal, force * normal);
  }
  return world;
}

TEST(ForceChains, TellsStrongContactsFromWeakOnes) {
  const FakeWorld world = world_of({{5, 1}, {15, 2}, {25, 3}, {35, 10}});
  ForceChainsProbe probe;
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "mean_normal_force"), 4);
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "share_above_mean"), 0.25);
  EXPECT_THAT(probe.fields(world)[3].values, ElementsAre(0, 0, 0, 1));
}

TEST(ForceChains, CountsAContactInBothOfItsDirections) {
  const FakeWorld world = world_of({{15, 2}, {12, 4}, {195, 6}, {275, 1}});
  ForceChainsProbe probe;
  std::vector<double> count(36), force(36);
  count[1] = count[19] = 3, count[9] = count[27] = 1;
  force[1] = force[19] = 4, force[9] = force[27] = 1;
  const auto counted = channel_values(probe, world, "contacts_by_direction");
  EXPECT_EQ(counted, count);
  const auto forces = channel_values(probe, world, "force_by_direction");
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(forces[i], force[i], 1e-12) << i;
}

TEST(ForceChains, CountsEveryDirectionInItsBin) {
  for (int bin = 0; bin < 36; ++bin) {
    ForceChainsProbe probe;
    const auto counted = channel_values(probe, world_of({{10 * bin + 3.0, 1}}), "contacts_by_direction");
    for (int i = 0; i < 36; ++i) EXPECT_EQ(counted[i], i % 18 == bin % 18 ? 1 : 0) << bin << ", " << i;
  }
}

TEST(ForceChains, TakesDirectionsInThePlane) {
  FakeWorld world;
  world.add({0, 0, 0}, 1), world.add({0, 0, 2}, 1);
  const Vec3 normal = Vec3(std::cos(25 * degree), std::sin(25 * degree), 0);
  world.touch(0, 1, 2 * normal, 5 * normal);
  for (const auto& [plane, bin] :
       std::vector<std::pair<std::string, int>>{{"xy", 2}, {"yx", 6}, {"xz", 0}, {"zy", 9}}) {
    ForceChainsProbe probe;
    probe.plane = plane;
    const auto counted = channel_values(probe, world, "contacts_by_direction");
    EXPECT_EQ(counted[bin], 1) << plane;
    EXPECT_EQ(std::accumulate(counted.begin(), counted.end(), 0.0), 2) << plane;
  }
}

TEST(ForceChains, LeavesOutContactsAtRightAnglesToThePlane) {
  FakeWorld world = world_of({{25, 2}});
  world.touch(0, 1, Vec3(0, 2, 0), Vec3(0, 8, 0));
  ForceChainsProbe probe;
  const auto counted = channel_values(probe, world, "contacts_by_direction");
  EXPECT_EQ(std::accumulate(counted.begin(), counted.end(), 0.0), 2);
  EXPECT_NEAR(channel_value(probe, world, "mean_normal_force"), 5, 1e-12);
  EXPECT_NEAR(channel_value(probe, world, "anisotropy"), 2, 1e-12);
}

TEST(ForceChains, FindsTheDirectionOfAlignedContacts) {
  for (const double angle : {-80.0, -30.0, 10.0, 30.0, 75.0}) {
    const FakeWorld world = world_of({{angle, 1}, {angle + 180, 3}});
    ForceChainsProbe probe;
    EXPECT_NEAR(channel_value(probe, world, "anisotropy"), 2, 1e-12);
    EXPECT_NEAR(channel_value(probe, world, "anisotropy_direction"), angle * degree, 1e-12);
  }
}

TEST(ForceChains, FindsNoAnisotropyInEvenDirections) {
  ForceChainsProbe probe;
  EXPECT_NEAR(channel_value(probe, world_of({{15, 1}, {60, 1}, {105, 5}, {150, 1}}), "anisotropy"), 0, 1e-12);
}

TEST(ForceChains, FindsTheAmplitudeOfADistribution) {
  // Contacts at equal steps of the cumulative distribution θ + a/2 sin 2(θ − θ_a), inverted by bisection.
  const double amplitude = 0.4, direction = 20 * degree;
  std::vector<std::pair<double, double>> contacts;
  const int count = 4000;
  for (int i = 0; i < count; ++i) {
    const double wanted = (i + 0.5) / count * std::numbers::pi;
    double low = -1, high = 5;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      const double reached = middle + 0.5 * amplitude * (std::sin(2 * (middle - direction)) + std::sin(2 * direction));
      (reached < wanted ? low : high) = middle;
    }
    contacts.push_back({low / degree, 1});
  }
  const FakeWorld world = world_of(contacts);
  ForceChainsProbe probe;
  EXPECT_NEAR(channel_value(probe, world, "anisotropy"), amplitude, 1e-5);
  EXPECT_NEAR(channel_value(probe, world, "anisotropy_direction"), direction, 1e-5);
}

TEST(ForceChains, TakesWallsOnlyIfAsked) {
  FakeWorld world = world_of({{25, 2}});
  world.wall.push_back(still_wall("floor"));
  world.touch_wall(0, 0, Vec3(0, 0, -1), Vec3(0, 0, -8));
  ForceChainsProbe probe;
  EXPECT_NEAR(channel_value(probe, world, "mean_normal_force"), 2, 1e-12);
  EXPECT_EQ(probe.fields(world)[0].values.size(), 3u);
  probe.with_walls = true;
  EXPECT_NEAR(channel_value(probe, world, "mean_normal_force"), 5, 1e-12);
  EXPECT_EQ(channel_values(probe, world, "contacts_by_direction")[27], 1);
  const auto fields = probe.fields(world);
  EXPECT_EQ(fields[1].values[5], -1);
}

TEST(ForceChains, ReachesFromCentreToCentre) {
  FakeWorld world;
  world.add({1, 2, 3}, 1), world.add({9, 2, 3}, 1);
  world.touch(0, 1, Vec3(-2, 0, 0), Vec3(-7, 1, 0));  // across a periodic side
  const auto fields = ForceChainsProbe().fields(world);
  EXPECT_THAT(fields[0].values, ElementsAre(1, 2, 3));
  EXPECT_THAT(fields[1].values, ElementsAre(-1, 2, 3));
  EXPECT_THAT(fields[2].values, ElementsAre(7));
}

INSTANTIATE_TEST_SUITE_P(ForceChains, ProbeContract,
                         testing::Values(ProbeCase{"grains", [] { return std::make_shared<ForceChainsProbe>(); }},
                                         ProbeCase{"walls_in_zy",
                                                   [] {
                                                     auto probe = std::make_shared<ForceChainsProbe>();
                                                     probe->with_walls = true, probe->plane = "zy";
                                                     return probe;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
