#include "heap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Grains under a cone of this slope; each touches the one beside it. `lost`: one that falls, without contact.
/// `plateau`: the height at which the cone is cut; `missing`: a ring without grains, counted from the axis.
struct Cone {
  double angle, height;
  bool lost = false;
  double plateau = 1;
  int missing = -1;
};
FakeWorld cone(const Cone& of) {
  constexpr double radius = 0.5e-3;
  const double angle = of.angle, height = of.height;
  FakeWorld world;
  const double foot = height / std::tan(angle);
  // In the middle of each ring, all around; the top of each grain is on the cone.
  int ring = 0;
  for (double r = radius; r < foot; r += 2 * radius) {
    if (ring++ == of.missing) continue;
    const int around = std::max(16, static_cast<int>(2 * std::numbers::pi * r / (2 * radius)) / 8 * 8 + 8);
    for (int k = 0; k < around; ++k) {
      const double turn = 2 * std::numbers::pi * (k + 0.5) / around;
      const double top = std::min(of.plateau, height - r * std::tan(angle));
      world.add({0.02 + r * std::cos(turn), -0.01 + r * std::sin(turn), 0.1 + top - radius}, radius);
    }
  }
  const auto count = static_cast<std::uint32_t>(world.positions().size());
  for (std::uint32_t i = 0; i + 1 < count; ++i) world.add_contact(i, i + 1, {1e-3, 0, 0}, {1, 0, 0});
  if (of.lost) world.add({0.02, -0.01, 0.3}, radius);
  return world;
}

std::shared_ptr<Heap> probe() {
  auto made = std::make_shared<Heap>();
  made->base = {0.02, -0.01, 0.1};
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
    EXPECT_NEAR(channel_value(*heap, world, "height"), 0.012 - 0.5e-3 * std::tan(angle * degree), 1e-12);
    EXPECT_NEAR(channel_value(*heap, world, "radius"), 0.012 / std::tan(angle * degree), 1.1e-3);
  }
}

TEST(Heap, HasTheAngleOfTheSlopeBelowACutTop) {
  const FakeWorld world = cone({.angle = 25 * degree, .height = 0.012, .plateau = 0.008});
  EXPECT_NEAR(channel_value(*probe(), world, "angle") / degree, 25, 1e-6);
  EXPECT_NEAR(channel_value(*probe(), world, "height"), 0.008, 1e-12);
}

/// A ring without a grain has no height: it is no ring of the height 0.
TEST(Heap, IgnoresEmptyRings) {
  for (const int missing : {0, 4, 12}) {
    const FakeWorld world = cone({.angle = 25 * degree, .height = 0.012, .missing = missing});
    const auto heap = probe();
    EXPECT_NEAR(channel_value(*heap, world, "angle") / degree, 25, 1e-6) << missing;
    heap->lower = 0;
    EXPECT_NEAR(channel_value(*heap, world, "angle") / degree, 25, 1e-6) << missing;
  }
}

TEST(Heap, IgnoresGrainsInFlight) {
  EXPECT_EQ(channel_value(*probe(), cone({25 * degree, 0.012, true}), "height"),
            channel_value(*probe(), cone({25 * degree, 0.012}), "height"));
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
