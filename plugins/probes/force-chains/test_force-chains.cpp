#include "force-chains.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <numeric>

#include "grit/testing/probe.hpp"

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
    world.add_contact(0, 1, 2 * normal, force * normal);
  }
  return world;
}

TEST(ForceChains, TellsStrongContactsFromWeakOnes) {
  const FakeWorld world = world_of({{5, 1}, {15, 2}, {25, 3}, {35, 10}});
  ForceChainsProbe probe;
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "mean_normal_force"), 4);
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "fraction_above_mean"), 0.25);
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
  for (std::size_t i = 0; i < 36; ++i) EXPECT_NEAR(forces[i], force[i], 1e-12) << i;
}

TEST(ForceChains, CountsEveryDirectionInItsBin) {
  for (int bin = 0; bin < 36; ++bin) {
    ForceChainsProbe probe;
    const auto counted = channel_values(probe, world_of({{10 * bin + 3.0, 1}}), "contacts_by_direction");
    for (int i = 0; i < 36; ++i) EXPECT_EQ(counted[as_index(i)], i % 18 == bin % 18 ? 1 : 0) << bin << ", " << i;
  }
}

TEST(ForceChains, TakesDirectionsInThePlane) {
  FakeWorld world;
  world.add({0, 0, 0}, 1), world.add({0, 0, 2}, 1);
  const Vec3 normal = Vec3(std::cos(25 * degree), std::sin(25 * degree), 0);
  world.add_contact(0, 1, 2 * normal, 5 * normal);
  for (const auto& [plane, bin] :
       std::vector<std::pair<std::string, std::size_t>>{{"xy", 2}, {"yx", 6}, {"xz", 0}, {"zy", 9}}) {
    ForceChainsProbe probe;
    probe.plane = plane;
    const auto counted = channel_values(probe, world, "contacts_by_direction");
    EXPECT_EQ(counted[bin], 1) << plane;
    EXPECT_EQ(std::accumulate(counted.begin(), counted.end(), 0.0), 2) << plane;
  }
}

TEST(ForceChains, LeavesOutContactsAtRightAnglesToThePlane) {
  FakeWorld world = world_of({{25, 2}});
  world.add_contact(0, 1, Vec3(0, 2, 0), Vec3(0, 8, 0));
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
    EXPECT_NEAR(channel_value(probe, world, "anisotropy_direction"), angle, 5e-11);
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
  EXPECT_NEAR(channel_value(probe, world, "anisotropy_direction"), direction / degree, 5e-4);
}

TEST(ForceChains, TakesWallsOnlyIfAsked) {
  FakeWorld world = world_of({{25, 2}});
  world.wall.push_back(still_wall("floor"));
  world.add_wall_contact(0, 0, Vec3(0, 0, -1), Vec3(0, 0, -8));
  ForceChainsProbe probe;
  EXPECT_NEAR(channel_value(probe, world, "mean_normal_force"), 2, 1e-12);
  EXPECT_EQ(probe.fields(world)[0].values.size(), 3u);
  probe.include_walls = true;
  EXPECT_NEAR(channel_value(probe, world, "mean_normal_force"), 5, 1e-12);
  EXPECT_EQ(channel_values(probe, world, "contacts_by_direction")[27], 1);
  const auto fields = probe.fields(world);
  EXPECT_EQ(fields[1].values[5], -1);
}

TEST(ForceChains, ReachesFromCentreToCentre) {
  FakeWorld world;
  world.add({1, 2, 3}, 1), world.add({9, 2, 3}, 1);
  world.add_contact(0, 1, Vec3(-2, 0, 0), Vec3(-7, 1, 0));  // across a periodic side
  const auto fields = ForceChainsProbe().fields(world);
  EXPECT_THAT(fields[0].values, ElementsAre(1, 2, 3));
  EXPECT_THAT(fields[1].values, ElementsAre(-1, 2, 3));
  EXPECT_THAT(fields[2].values, ElementsAre(7));
}

/// Contacts whose directions have E = (1 + a cos 2(θ − θ_0)) / 2π, at equal steps of its sum, found by bisection; and
/// whose forces are those of Rothenburg and Bathurst, with the same θ_0.
FakeWorld distributed(double a, double a_n, double a_t, double theta_0, int count = 4000) {
  FakeWorld world;
  world.add({0, 0, 0}, 1), world.add({0, 0, 2}, 1);
  for (int i = 0; i < count; ++i) {
    const double wanted = (i + 0.5) / count * std::numbers::pi;
    double low = -1, high = 5;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      const double reached = middle + 0.5 * a * (std::sin(2 * (middle - theta_0)) + std::sin(2 * theta_0));
      (reached < wanted ? low : high) = middle;
    }
    const double normal = 5 * (1 + a_n * std::cos(2 * (low - theta_0))),
                 along = -5 * a_t * std::sin(2 * (low - theta_0));
    const Vec3 n(std::cos(low), 0, std::sin(low)), t(-std::sin(low), 0, std::cos(low));
    world.add_contact(0, 1, 2 * n, normal * n + along * t);
  }
  return world;
}

TEST(ForceChains, FindsTheAnisotropiesOfForces) {
  const double direction = 20 * degree;
  const FakeWorld world = distributed(0.4, 0.3, 0.2, direction);
  ForceChainsProbe probe;
  EXPECT_NEAR(channel_value(probe, world, "normal_force_anisotropy"), 0.3, 1e-12);
  EXPECT_NEAR(channel_value(probe, world, "normal_force_direction"), 20, 5e-11);
  EXPECT_NEAR(channel_value(probe, world, "tangential_force_anisotropy"), 0.2, 1e-12);
  EXPECT_NEAR(channel_value(probe, world, "tangential_force_direction"), 20, 5e-11);
}

// (σ1 − σ3) / (σ1 + σ3) = (a + a_n + a_t) / 2 / (1 + a a_n / 2) (Rothenburg, Bathurst 1989, eq. 15 with the product
// kept).
TEST(ForceChains, HasAnisotropiesThatMakeTheStressRatio) {
  const FakeWorld world = distributed(0.4, 0.3, 0.2, -35 * degree);
  double xx = 0, zz = 0, xz = 0;
  for (const Contact& c : world.contact)
    xx += c.force.x() * c.branch.x(), zz += c.force.z() * c.branch.z(),
        xz += 0.5 * (c.force.x() * c.branch.z() + c.force.z() * c.branch.x());
  ForceChainsProbe probe;
  const double a = channel_value(probe, world, "anisotropy"),
               a_n = channel_value(probe, world, "normal_force_anisotropy"),
               a_t = channel_value(probe, world, "tangential_force_anisotropy");
  EXPECT_NEAR(std::hypot(xx - zz, 2 * xz) / (xx + zz), 0.5 * (a + a_n + a_t) / (1 + 0.5 * a * a_n), 1e-5);
}

TEST(ForceChains, KnowsNoAnisotropyOfForcesWhereDirectionsDoNotTell) {
  ForceChainsProbe probe;
  EXPECT_TRUE(std::isnan(channel_value(probe, world_of({{10, 1}, {80, 2}}), "normal_force_anisotropy")));
  EXPECT_TRUE(std::isnan(channel_value(probe, world_of({{10, 0}, {80, 0}, {120, 0}}), "normal_force_anisotropy")));
  EXPECT_NEAR(channel_value(probe, world_of({{10, 1}, {80, 1}, {120, 1}}), "normal_force_anisotropy"), 0, 1e-12);
}

/// Spheres of radius 1 at places in units of their diameter, `loads` between pairs of them along the line of centres.
struct Load {
  std::uint32_t a, b;
  double force;
};
FakeWorld packed(const std::vector<Vec3>& places, const std::vector<Load>& loads) {
  FakeWorld world;
  for (const Vec3& place : places) world.add(2 * place, 1);
  for (const auto& [a, b, force] : loads) {
    const Vec3 branch = 2 * (places[b] - places[a]);
    world.add_contact(a, b, branch, force * branch.normalized());
  }
  return world;
}
std::vector<double> chains_of(const FakeWorld& world, double angle = 45) {
  ForceChainsProbe probe;
  probe.angle = angle * degree;
  std::vector<double> found;
  for (const auto* name : {"chains", "chain_grains", "mean_chain_length", "longest_chain"})
    found.push_back(channel_value(probe, world, name));
  return found;
}
Vec3 on_arc(double angle) { return {std::cos(angle * degree), 0, std::sin(angle * degree)}; }

/// A column of five and a row of three, loaded, and three that bear nothing.
FakeWorld column_and_row() {
  std::vector<Vec3> places;
  std::vector<Load> loads;
  for (int k = 0; k < 5; ++k) places.push_back({0, 0, 1.0 * k});
  for (int k = 0; k < 3; ++k) places.push_back({5.0 + k, 0, 0});
  for (int k = 0; k < 3; ++k) places.push_back({0, 9, 1.0 * k});
  for (std::uint32_t k = 0; k < 4; ++k) loads.push_back({k, k + 1, 10});
  for (std::uint32_t k = 5; k < 7; ++k) loads.push_back({k, k + 1, 10});
  return packed(places, loads);
}

TEST(LinearChains, AreColumnsAndRowsOfGrainsThatBear) {
  const FakeWorld world = column_and_row();
  // The ends of the column and of the row bear one contact: F R / V; those within two.
  const double one = 10 * 1 / (4.0 / 3 * std::numbers::pi);
  ForceChainsProbe probe;
  EXPECT_NEAR(channel_value(probe, world, "mean_major_stress"), one * 12 / 11, 1e-12);
  // The mean is more than an end bears: only what lies within is above it.
  EXPECT_THAT(chains_of(world), ElementsAre(1, 3, 3, 3));
  FakeWorld held = world;  // the ends bear more where walls hold them
  held.wall.push_back(still_wall("walls"));
  for (const auto& [body, out] :
       std::vector<std::pair<std::uint32_t, Vec3>>{{0, {0, 0, -1}}, {4, {0, 0, 1}}, {5, {-1, 0, 0}}, {7, {1, 0, 0}}})
    held.add_wall_contact(body, 0, out, 10 * out);
  EXPECT_THAT(chains_of(held), ElementsAre(2, 8, 4, 5));
  const auto fields = probe.fields(held);
  EXPECT_THAT(fields[4].values, ElementsAre(1, 1, 1, 1, 2, 2));
  probe.include_walls = true;
  EXPECT_THAT(probe.fields(held)[4].values, ElementsAre(1, 1, 1, 1, 2, 2, 0, 0, 0, 0));
}

TEST(LinearChains, BendNoMoreThanTheAngle) {
  // Seven grains, each link turned on from the one before; the ends bear less than the mean: each grain's major stress
  // halves the angle between its links.
  for (const double bend : {30.0, 60.0}) {
    std::vector<Vec3> places{Vec3::Zero()};
    for (int k = 0; k < 6; ++k) places.push_back(places.back() + on_arc(bend * k));
    const FakeWorld world = packed(places, {{0, 1, 10}, {1, 2, 10}, {2, 3, 10}, {3, 4, 10}, {4, 5, 10}, {5, 6, 10}});
    EXPECT_THAT(chains_of(world, 0.5 * bend + 0.1), ElementsAre(1, 5, 5, 5)) << bend;
    EXPECT_THAT(chains_of(world, 0.5 * bend - 0.1), ElementsAre(0, 0, 0, 0)) << bend;
  }
}

// A row that leans on the top of a column at 80°: their contact is in line with the row's grain alone.
TEST(LinearChains, AreInLineAtBothGrains) {
  std::vector<Vec3> places;
  for (int k = 0; k < 5; ++k) places.push_back({0, 0, 1.0 * k});
  for (int k = 1; k < 6; ++k) places.push_back(Vec3(0, 0, 4) + k * on_arc(10));
  for (int k = 0; k < 20; ++k) places.push_back({0, 50, 2.0 * k});  // bear nothing and lower the mean
  const FakeWorld world = packed(
      places,
      {{0, 1, 20}, {1, 2, 20}, {2, 3, 20}, {3, 4, 20}, {4, 5, 10}, {5, 6, 10}, {6, 7, 10}, {7, 8, 10}, {8, 9, 10}});
  EXPECT_THAT(ForceChainsProbe().fields(world)[4].values, ElementsAre(1, 1, 1, 1, 0, 2, 2, 2, 2));
}

TEST(LinearChains, TakeTheStrongerBranch) {
  // A column 0 … 5 and, beside its grain 4, a weaker one that meets grain 2 at 40°.
  std::vector<Vec3> places;
  for (int k = 0; k < 6; ++k) places.push_back({0, 0, 1.0 * k});
  const Vec3 aside(std::sin(40 * degree), 0, std::cos(40 * degree));
  for (int k = 1; k < 5; ++k) places.push_back(Vec3(0, 0, 2) + k * aside);
  for (int k = 0; k < 20; ++k) places.push_back({0, 50, 2.0 * k});  // bear nothing and lower the mean
  const FakeWorld world = packed(
      places, {{2, 6, 6}, {6, 7, 6}, {7, 8, 6}, {8, 9, 6}, {0, 1, 10}, {1, 2, 10}, {2, 3, 9}, {3, 4, 9}, {4, 5, 9}});
  EXPECT_THAT(ForceChainsProbe().fields(world)[4].values, ElementsAre(0, 2, 2, 2, 1, 1, 1, 1, 1));
  EXPECT_THAT(chains_of(world), ElementsAre(2, 10, 5, 6));
}

TEST(LinearChains, MayCloseUponThemselves) {
  FakeWorld world = packed({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 0, 5}}, {{0, 1, 5}, {1, 2, 5}, {2, 3, 5}});
  world.make_periodic({-1, -1, -1}, {7, 9, 19});
  world.add_contact(3, 0, Vec3(2, 0, 0), Vec3(5, 0, 0));
  EXPECT_THAT(chains_of(world), ElementsAre(1, 4, 4, 4));
  EXPECT_THAT(ForceChainsProbe().fields(world)[4].values, ElementsAre(1, 1, 1, 1));
}

LinearChains with(std::vector<std::vector<std::uint32_t>> grains) {
  LinearChains chains;
  chains.grains = std::move(grains);
  return chains;
}

TEST(LinearChains, LiveOnWhereHalfOfThemAndTwoAtLeastStayTogether) {
  const auto change = [](std::vector<std::vector<std::uint32_t>> before,
                         std::vector<std::vector<std::uint32_t>> after) {
    const Turnover found = turnover(with(std::move(before)), with(std::move(after)));
    return std::pair(found.born, found.died);
  };
  using P = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(change({{1, 2, 3}}, {{3, 2, 1}}), P(0, 0));
  EXPECT_EQ(change({{1, 2, 3}}, {{9, 2, 3}}), P(0, 0));
  EXPECT_EQ(change({{1, 2, 3}}, {{9, 8, 3}}), P(1, 1));                // one grain is not two
  EXPECT_EQ(change({{1, 2, 3, 4, 5}}, {{4, 5, 6, 7}}), P(1, 1));       // two of five are no half
  EXPECT_EQ(change({{1, 2, 3, 4}}, {{1, 2, 9}, {3, 4, 8}}), P(0, 0));  // in both halves
  EXPECT_EQ(change({{1, 2, 3}, {4, 5, 6}}, {{1, 2, 3, 4, 5, 6}}), P(0, 0));
  EXPECT_EQ(change({}, {{1, 2, 3}}), P(1, 0));
  EXPECT_EQ(change({{1, 2, 3}}, {}), P(0, 1));
}

TEST(LinearChains, AreComparedWithThoseOfTheSampleBefore) {
  FakeWorld world = column_and_row();
  ForceChainsProbe probe;
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "chains_born")));
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "chains_died")));
  ++world.steps;
  world.id = {4, 3, 2, 1, 0, 5, 6, 7, 8, 9, 10};  // bodies were put in another order: the same three
  EXPECT_EQ(channel_value(probe, world, "chains_born"), 0);
  EXPECT_EQ(channel_value(probe, world, "chains_died"), 0);
  ++world.steps;
  world.id = {4, 13, 2, 11, 0, 5, 6, 7, 8, 9, 1};
  EXPECT_EQ(channel_value(probe, world, "chains_born"), 1);
  EXPECT_EQ(channel_value(probe, world, "chains_died"), 1);
  EXPECT_EQ(channel_value(probe, world, "chains_died"), 1);  // looked at again
  ++world.steps;
  world.contact.clear();
  EXPECT_EQ(channel_value(probe, world, "chains_born"), 0);
  EXPECT_EQ(channel_value(probe, world, "chains_died"), 1);
}

INSTANTIATE_TEST_SUITE_P(ForceChains, ProbeContract,
                         testing::Values(ProbeCase{"grains", [] { return std::make_shared<ForceChainsProbe>(); }},
                                         ProbeCase{"walls_in_zy",
                                                   [] {
                                                     auto probe = std::make_shared<ForceChainsProbe>();
                                                     probe->include_walls = true, probe->plane = "zy";
                                                     return probe;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
