#include "displacements.hpp"

#include <gmock/gmock.h>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

/// Bodies of diameter 0.01 from z = 0 to 1, a thousandth apart, that have gone by moved(z).
template <class Moved>
FakeWorld column(Moved moved) {
  FakeWorld world;
  for (int k = 0; k < 1000; ++k) {
    const double z = (k + 0.5) / 1000;
    world.add({0.5, 0.5, z}, 0.005);
    world.displacement.push_back(moved(z));
  }
  world.whole = {Vec3::Zero(), Vec3::Ones()};
  return world;
}
double figure(Displacements& probe, const FakeWorld& world, const std::string& channel) {
  return channel_values(probe, world, channel).at(0);
}

TEST(Displacements, ALinearFieldHasOneGradientAndNoFluctuation) {
  const FakeWorld world = column([](double z) { return Vec3(0.3 * z, -z, 7); });
  Displacements probe;
  probe.profile.points = 11;
  probe.prepare(world);
  const auto gradient = channel_values(probe, world, "gradient"), left = channel_values(probe, world, "fluctuation");
  for (std::size_t k = 0; k < 11; ++k) {
    EXPECT_NEAR(gradient[k], 0.3, 1e-10) << k;
    EXPECT_NEAR(left[k], 0, 1e-10) << k;
  }
}

TEST(Displacements, FluctuationsAreWhatTheMeanLeaves) {
  int count = 0;
  const FakeWorld world = column([&](double z) { return Vec3(0.3 * z, ++count % 2 == 0 ? 0.1 : -0.1, 0); });
  Displacements probe;
  probe.profile.points = 11, probe.profile.averaging_length = 10;
  probe.prepare(world);
  const auto left = channel_values(probe, world, "fluctuation");
  for (std::size_t k = 3; k < 8; ++k) EXPECT_NEAR(left[k], 0.1, 1e-4) << k;
  const auto fields = probe.fields(world);
  const auto& fluctuation = fields.at(3).values;
  EXPECT_NEAR(std::abs(fluctuation.at(3 * 500 + 1)), 0.1, 1e-4);
  EXPECT_NEAR(fluctuation.at(3 * 500), 0, 1e-12);
}

// What frames take for a map: a tile as large as the body, where it is.
TEST(Displacements, FluctuationsAreAMapOfBodies) {
  const FakeWorld world = column([](double z) { return Vec3(z, 0, 0); });
  Displacements probe;
  probe.prepare(world);
  const auto fields = probe.fields(world);
  ASSERT_EQ(fields.at(1).name, "centre");
  ASSERT_EQ(fields.at(2).name, "size");
  EXPECT_EQ(fields.at(3).name, "fluctuation");
  for (const std::size_t body : {0u, 500u, 999u}) {
    EXPECT_EQ(fields[0].values[body], world.id[body]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(fields[2].values[3 * body + k], 0.01);
    EXPECT_EQ(fields[1].values[3 * body + 2], world.position[body].z);
  }
}

// Two columns, of which one shears the other way and stands beyond the last strip, where it counts.
TEST(Displacements, StripsHaveGradientsOfTheirOwn) {
  FakeWorld world;
  for (int k = 0; k < 1000; ++k)
    for (const double x : {0.1, 1.3}) {
      const double z = (k + 0.5) / 1000;
      world.add({x, 0.5, z}, 0.005);
      world.displacement.push_back({x < 0.5 ? 0.3 * z : -0.7 * z, 0, 0});
    }
  world.whole = {Vec3::Zero(), Vec3::Ones()};
  Displacements probe;
  probe.profile.points = 11, probe.strips = 3;
  probe.prepare(world);
  const auto first = channel_values(probe, world, "gradient_strip_1"),
             none = channel_values(probe, world, "gradient_strip_2"),
             last = channel_values(probe, world, "gradient_strip_3"), all = channel_values(probe, world, "gradient");
  for (std::size_t k = 0; k < 11; ++k) {
    EXPECT_NEAR(first[k], 0.3, 1e-10) << k;
    EXPECT_TRUE(std::isnan(none[k])) << k;
    EXPECT_NEAR(last[k], -0.7, 1e-10) << k;
    EXPECT_NEAR(all[k], -0.2, 1e-10) << k;
  }
  EXPECT_THROW(channel_values(probe, world, "gradient_strip_4"), Error);
}

// Who has just gone past a side belongs to the strip at the other one.
TEST(Displacements, StripsHaveBodiesThatArePastAPeriodicSide) {
  FakeWorld world;
  for (int k = 0; k < 1000; ++k)
    for (const double x : {-0.02, 0.1, 0.9, 1.01, 2.03}) {
      const double z = (k + 0.5) / 1000;
      world.add({x, 0.5, z}, 0.005);
      world.displacement.push_back({x < 0 || x == 0.9 ? 0.3 * z : -0.7 * z, 0, 0});
    }
  world.make_periodic(Vec3::Zero(), Vec3::Ones());
  world.box.periodic[2] = false;
  Displacements probe;
  probe.profile.points = 11, probe.strips = 3;
  probe.prepare(world);
  const auto first = channel_values(probe, world, "gradient_strip_1"),
             last = channel_values(probe, world, "gradient_strip_3");
  for (std::size_t k = 0; k < 11; ++k) {
    EXPECT_NEAR(first[k], -0.7, 1e-10) << k;
    EXPECT_NEAR(last[k], 0.3, 1e-10) << k;
  }
}

TEST(Displacements, StripsLieAcrossTheirProfiles) {
  Displacements probe;
  probe.strips = 4, probe.strips_along = "z";
  EXPECT_EQ(complaints(probe), "strips_along: found z, allowed: an axis other than across, the axis of the profiles\n");
  probe.strips = 0;
  EXPECT_EQ(complaints(probe), "");
}

// u = tanh((z − c) / w) shears by sech² ((z − c) / w), whose inflections are where tanh² = 1/3.
TEST(Displacements, ZoneLiesBetweenTheInflectionsOfTheShear) {
  const double centre = 0.55, width = 0.1;
  const FakeWorld world = column([=](double z) { return Vec3(-std::tanh((z - centre) / width), 0, 0); });
  Displacements probe;
  probe.profile.averaging_length = 1, probe.profile.points = 201;
  probe.prepare(world);
  const double half = width * std::atanh(std::sqrt(1.0 / 3));
  EXPECT_NEAR(figure(probe, world, "zone_low"), centre - half, 2e-2 * half);
  EXPECT_NEAR(figure(probe, world, "zone_high"), centre + half, 2e-2 * half);
  EXPECT_NEAR(figure(probe, world, "zone_thickness"), 2 * half, 2e-2 * half);
}

// Sand on a rough surface shears the most at it.
TEST(Displacements, ZoneAtASideBeginsThere) {
  const double width = 0.1;
  const FakeWorld world = column([=](double z) { return Vec3(z < width ? std::sin(z / width) : std::sin(1.0), 0, 0); });
  Displacements probe;
  probe.profile.points = 101, probe.profile.averaging_length = 1;
  probe.prepare(world);
  EXPECT_EQ(figure(probe, world, "zone_low"), 0);
  EXPECT_NEAR(figure(probe, world, "zone_high"), width, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Displacements, ProbeContract,
                         testing::Values(ProbeCase{"lattice",
                                                   [] {
                                                     auto probe = std::make_shared<Displacements>();
                                                     probe->strips = 3;
                                                     return probe;
                                                   },
                                                   [] {
                                                     FakeWorld world = lattice_world(6, 4, 8);
                                                     for (const Row& x : world.position)
                                                       world.displacement.push_back({x.z * x.z, 0.1 * x.x, 0});
                                                     return world;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
