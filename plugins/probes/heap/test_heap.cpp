#include "heap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

constexpr double degree = std::numbers::pi / 180;

constexpr double diameter = 1e-3;
const Vec3 base(0.02, -0.01, 0.1);

void touch(FakeWorld& world) {
  const auto count = static_cast<std::uint32_t>(world.positions().size());
  for (std::uint32_t i = 0; i + 1 < count; ++i) world.add_contact(i, i + 1, {1e-3, 0, 0}, {1, 0, 0});
}

/// One grain in each column of one diameter, whose top is on a cone of this slope, or at the height at which it is cut.
struct Cone {
  double angle, height;  // rad, m
  double cut = 1;
  double layer_until = 0;  // radius up to which single grains surround it [m]
};
FakeWorld cone(const Cone& of) {
  FakeWorld world;
  const double most = std::max(of.layer_until, of.height / std::tan(of.angle));
  for (double x = 0.5 * diameter - std::ceil(most / diameter) * diameter; x < most; x += diameter)
    for (double y = 0.5 * diameter - std::ceil(most / diameter) * diameter; y < most; y += diameter) {
      const double distance = std::hypot(x, y);
      double top = std::min(of.cut, of.height - distance * std::tan(of.angle));
      if (distance < of.layer_until) top = std::max(top, diameter);
      if (top > 0) world.add(base + Vec3(x, y, top - 0.5 * diameter), 0.5 * diameter);
    }
  touch(world);
  return world;
}

/// Grains at random under a cone, as densely as sand.
FakeWorld random_cone(double angle, double height, unsigned seed) {
  FakeWorld world;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  constexpr double spacing = 0.95 * diameter;
  const int most = static_cast<int>(height / std::tan(angle) / spacing) + 2;
  for (int i = -most; i <= most; ++i)
    for (int j = -most; j <= most; ++j)
      for (int k = 0; k <= most; ++k) {
        const Vec3 place = spacing * Vec3(i + shift(random), j + shift(random), k + shift(random));
        if (place.z() > 0 && place.z() < height - std::hypot(place.x(), place.y()) * std::tan(angle))
          world.add(base + place, 0.5 * diameter);
      }
  touch(world);
  return world;
}

std::shared_ptr<Heap> probe() {
  auto made = std::make_shared<Heap>();
  made->base = base;
  return made;
}

INSTANTIATE_TEST_SUITE_P(Heap, ProbeContract,
                         testing::Values(ProbeCase{"on_a_lattice", [] { return std::make_shared<Heap>(); }},
                                         ProbeCase{"of_a_cone", [] { return probe(); },
                                                   [] {
                                                     return cone({25 * degree, 0.01});
                                                   }}),
                         probe_case_name);

TEST(Heap, HasTheAngleOfACone) {
  for (const double angle : {15.0, 25.0, 40.0}) {
    const FakeWorld world = cone({angle * degree, 0.012});
    const auto heap = probe();
    EXPECT_NEAR(channel_value(*heap, world, "angle") / degree, angle, 1e-6);
    EXPECT_NEAR(channel_value(*heap, world, "angle_deviation"), 0, 1e-6);
    EXPECT_NEAR(channel_value(*heap, world, "height"), 0.012 - diameter * std::sqrt(0.5) * std::tan(angle * degree),
                1e-12);
    EXPECT_NEAR(channel_value(*heap, world, "radius"), 0.012 / std::tan(angle * degree), 1.1e-3);
  }
}

TEST(Heap, HasTheAngleOfTheSlopeBelowACutTop) {
  const FakeWorld world = cone({.angle = 25 * degree, .height = 0.012, .cut = 0.008});
  EXPECT_NEAR(channel_value(*probe(), world, "angle") / degree, 25, 1e-6);
  EXPECT_NEAR(channel_value(*probe(), world, "height"), 0.008, 1e-12);
}

/// Choosing parts of the surface by their own heights would flatten it.
TEST(Heap, HasTheAngleOfGrainsAtRandomUnderACone) {
  for (const double angle : {15.0, 25.0, 35.0})
    for (const double height : {8e-3, 16e-3}) {
      double mean = 0;
      for (unsigned seed = 1; seed <= 4; ++seed)
        mean += 0.25 * channel_value(*probe(), random_cone(angle * degree, height, seed), "angle") / degree;
      EXPECT_NEAR(mean, angle, height < 10e-3 ? 2.5 : 0.6) << height;
    }
}

TEST(Heap, LeavesOutSingleGrainsAroundTheFoot) {
  for (const double lower : {0.0, 0.1})
    for (const double height : {5e-3, 8e-3}) {
      const FakeWorld world = cone({.angle = 25 * degree, .height = height, .layer_until = 0.03});
      const auto heap = probe();
      heap->lower = lower;
      EXPECT_NEAR(channel_value(*heap, world, "angle") / degree, 25, 1e-6) << height;
    }
}

TEST(Heap, IgnoresGrainsInFlight) {
  FakeWorld world = cone({25 * degree, 0.012});
  const double height = channel_value(*probe(), world, "height");
  world.add(base + Vec3(0, 0, 0.2), 0.5 * diameter);
  EXPECT_EQ(channel_value(*probe(), world, "height"), height);
}

TEST(Heap, IsNotSlowedDownByAGrainFarAway) {
  FakeWorld world = cone({25 * degree, 0.012});
  world.add(base + Vec3(1e6, 0, 0), 0.5 * diameter);
  world.add_contact(0, static_cast<std::uint32_t>(world.positions().size() - 1), {1e-3, 0, 0}, {1, 0, 0});
  EXPECT_NEAR(channel_value(*probe(), world, "angle") / degree, 25, 1e-6);
}

TEST(Heap, HasNoAngleWithAShortSlope) {
  EXPECT_TRUE(std::isnan(channel_value(*probe(), cone({25 * degree, 2.5e-3}), "angle")));
}

TEST(Heap, HasNoAngleWithoutASlope) {
  FakeWorld world;
  world.add({0.02, -0.01, 0.1}, 1e-3);
  EXPECT_TRUE(std::isnan(channel_value(*probe(), world, "angle")));
  EXPECT_TRUE(std::isnan(channel_value(*probe(), world, "angle_deviation")));
  EXPECT_EQ(channel_value(*probe(), world, "height"), 0) << "it touches nothing";
}

}  // namespace
}  // namespace grit
