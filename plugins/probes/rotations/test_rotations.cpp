#include "rotations.hpp"

#include <gmock/gmock.h>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsNan;
using testing::Pointwise;

/// Columns of bodies of diameter 0.01 from z = 0 to 1, a thousandth apart, whose rotation about y is turn(z).
template <class Turn>
FakeWorld column(Turn turn) {
  FakeWorld world;
  for (int k = 0; k < 1000; ++k) {
    const double z = (k + 0.5) / 1000;
    world.add({0.5, 0.5, z}, 0.005);
    world.rotation.push_back({100, turn(z), -100});
  }
  world.whole = {Vec3::Zero(), Vec3::Ones()};
  return world;
}
double figure(Rotations& probe, const FakeWorld& world, const std::string& channel) {
  return channel_values(probe, world, channel).at(0);
}

TEST(Rotations, ProfileOfALinearOneIsItself) {
  const FakeWorld world = column([](double z) { return 3 * z - 1; });
  Rotations probe;
  probe.profile.points = 11;
  probe.prepare(world);
  const auto place = channel_values(probe, world, "position"), profile = channel_values(probe, world, "profile");
  for (std::size_t k = 0; k < 11; ++k) EXPECT_NEAR(place[k], 0.1 * static_cast<double>(k), 1e-15);
  for (std::size_t k = 0; k < 11; ++k) EXPECT_NEAR(profile[k], 3 * place[k] - 1, 1e-12) << k;
  EXPECT_NEAR(figure(probe, world, "mean"), 0.5, 1e-12);
  EXPECT_NEAR(figure(probe, world, "mean_magnitude"), (1.0 / 3 * 0.5 + 2.0 / 3 * 1), 1e-3);
}

// A bell exp(−(z − c)² / 2σ²) has its inflections at c ± σ; the probe's own triangle of reach h, whose variance is
// h²/6, widens it to √(σ² + h²/6).
TEST(Rotations, ZoneLiesBetweenTheInflectionsOfABell) {
  for (const double sign : {1.0, -1.0}) {
    const double centre = 0.43, sigma = 0.1, reach = 0.04;
    const FakeWorld world =
        column([=](double z) { return sign * std::exp(-0.5 * (z - centre) * (z - centre) / (sigma * sigma)); });
    Rotations probe;
    probe.profile.averaging_length = 4, probe.profile.points = 101;
    probe.prepare(world);
    const double widened = std::sqrt(sigma * sigma + reach * reach / 6);
    EXPECT_NEAR(figure(probe, world, "zone_low"), centre - widened, 3e-3 * widened);
    EXPECT_NEAR(figure(probe, world, "zone_high"), centre + widened, 3e-3 * widened);
    EXPECT_NEAR(figure(probe, world, "zone_thickness"), 2 * widened, 3e-3 * 2 * widened);
    EXPECT_NEAR(figure(probe, world, "zone_diameters"), 2 * widened / 0.01, 3e-3 * 2 * widened / 0.01);
    const double extent = 2 * widened * std::sqrt(2 * std::log(20)) / 0.01;
    EXPECT_NEAR(figure(probe, world, "zone_extent_diameters"), extent, 5e-3 * extent);
  }
}

TEST(Rotations, ZoneAtASideEndsThere) {
  const double sigma = 0.1;
  const FakeWorld world = column([=](double z) { return std::exp(-0.5 * z * z / (sigma * sigma)); });
  Rotations probe;
  probe.profile.points = 101;
  probe.prepare(world);
  EXPECT_EQ(figure(probe, world, "zone_low"), 0);
  EXPECT_NEAR(figure(probe, world, "zone_high"), sigma, 1e-2 * sigma);
  EXPECT_NEAR(figure(probe, world, "zone_extent_diameters"), sigma * std::sqrt(2 * std::log(20)) / 0.01, 0.2);
}

// What decays from a side on, as sand on a smooth surface turns, has no inflection point, however fine the profile.
TEST(Rotations, ZoneThatFallsOffFastestAtItsSideHasNoThickness) {
  for (const bool at_low : {true, false}) {
    const double length = 0.1;
    const FakeWorld world = column([=](double z) { return std::exp(-(at_low ? z : 1 - z) / length); });
    for (const int places : {21, 101}) {
      Rotations probe;
      probe.profile.points = places;
      probe.prepare(world);
      EXPECT_EQ(figure(probe, world, at_low ? "zone_low" : "zone_high"), at_low ? 0 : 1);
      for (const char* none : {at_low ? "zone_high" : "zone_low", "zone_thickness", "zone_diameters"})
        EXPECT_THAT(figure(probe, world, none), IsNan()) << none;
      EXPECT_NEAR(figure(probe, world, "zone_extent_diameters"), length * std::log(20) / 0.01, 1);
    }
  }
}

TEST(Rotations, AboutTheAxisThatIsAskedForAndBodyByBody) {
  FakeWorld world;
  world.add({0, 0, 0.2}, 0.1), world.add({0, 0, 0.8}, 0.1);
  world.rotation = {{1, 2, 3}, {-4, 5, 6}};
  Rotations probe;
  probe.about = "x";
  probe.prepare(world);
  EXPECT_THAT(channel_values(probe, world, "mean"), ElementsAre(-1.5));
  EXPECT_THAT(channel_values(probe, world, "mean_magnitude"), ElementsAre(2.5));
}

TEST(Rotations, KnowsNothingWhereThereAreNoBodies) {
  FakeWorld world = column([](double z) { return std::exp(-0.5 * (z - 0.3) * (z - 0.3) / 0.01); });
  world.whole.high.z() = 2;  // half empty
  Rotations probe;
  probe.profile.points = 101;
  probe.prepare(world);
  const auto profile = channel_values(probe, world, "profile");
  EXPECT_TRUE(std::isfinite(profile[49]));
  EXPECT_TRUE(std::isnan(profile[60]));
  EXPECT_NEAR(figure(probe, world, "zone_high"), 0.4, 0.01);
  world.whole = {{0, 0, 3}, {1, 1, 4}};
  EXPECT_TRUE(std::isnan(figure(probe, world, "zone_thickness")));
}

TEST(Rotations, HaveNoZoneWhereNothingTurns) {
  const FakeWorld world = column([](double) { return 0.0; });
  Rotations probe;
  probe.profile.points = 101;
  probe.prepare(world);
  for (const char* of_zone : {"zone_low", "zone_high", "zone_thickness", "zone_diameters", "zone_extent_diameters"})
    EXPECT_TRUE(std::isnan(figure(probe, world, of_zone))) << of_zone;
}

TEST(Rotations, OfAZoneIsNotDrawnAwayByOneFarPlace) {
  const FakeWorld world = column(
      [](double z) { return std::exp(-0.5 * (z - 0.3) * (z - 0.3) / 0.01) + (z > 0.9 && z < 0.92 ? -0.9 : 0.0); });
  Rotations probe;
  probe.profile.points = 101, probe.profile.averaging_length = 1;
  probe.prepare(world);
  EXPECT_NEAR(figure(probe, world, "zone_high"), 0.4, 0.01);
}

TEST(Rotations, RefusesAnAxisWithoutSides) {
  FakeWorld world = column([](double) { return 0.0; });
  world.make_periodic(Vec3::Zero(), Vec3::Ones());
  Rotations probe;
  try {
    probe.prepare(world);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "across: found z, along which the domain is periodic; allowed is an axis that is not periodic, "
                 "of which this domain has none: remove the probe");
  }
}

INSTANTIATE_TEST_SUITE_P(Rotations, ProbeContract,
                         testing::Values(ProbeCase{"lattice", [] { return std::make_shared<Rotations>(); },
                                                   [] {
                                                     FakeWorld world = lattice_world(6, 4, 8);
                                                     for (const Row& x : world.position)
                                                       world.rotation.push_back({0.1, 100 * x.z, 0});
                                                     return world;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
