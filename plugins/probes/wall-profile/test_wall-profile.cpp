#include "wall-profile.hpp"

#include <gmock/gmock.h>

#include <numbers>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::DoubleEq;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::Pointwise;

/// Walls at x = 0 and x = 1, and a floor; a specimen from z = 0 to 2.
FakeWorld silo() {
  FakeWorld world;
  world.wall = {still_wall("left"), still_wall("right"), still_wall("floor")};
  world.wall[0].normal = Vec3::UnitX(), world.wall[1].normal = -Vec3::UnitX(), world.wall[2].normal = Vec3::UnitZ();
  world.whole = {Vec3::Zero(), {1, 0.5, 2}};
  return world;
}
/// A grain at a height touches left (0) or right (1), presses into it and hangs on to it.
void contact(FakeWorld& world, std::uint32_t side, double z, double presses, double hangs) {
  const double out = side == 0 ? -1 : 1;
  const auto body = world.add({side == 0 ? 0.1 : 0.9, 0.25, z}, 0.1);
  world.add_wall_contact(body, side, {0.1 * out, 0, 0}, {presses * out, 0, -hangs});
}

WallProfile made(std::int64_t strips) {
  WallProfile probe;
  probe.walls = {"left", "right"}, probe.width = 1, probe.strips = strips;
  return probe;
}

TEST(WallProfile, IsForceOverAreaStripByStrip) {
  FakeWorld world = silo();
  contact(world, 0, 0.1, 3, 1), contact(world, 1, 1.9, 7, -1);
  // On the flank of a groove, below its centre.
  world.add_wall_contact(world.add({0.9, 0.25, 0.55}, 0.1), 1, {0.06, 0, -0.08}, {5, 0, -2});
  world.add_wall_contact(world.add({0.5, 0.25, 0.1}, 0.1), 2, {0, 0, -0.1}, {0, 0, -100});
  WallProfile probe = made(4);
  probe.width = 2;
  probe.prepare(world);
  EXPECT_THAT(channel_values(probe, world, "position"), ElementsAre(0.25, 0.75, 1.25, 1.75));
  EXPECT_THAT(channel_values(probe, world, "normal_stress"), ElementsAre(8, 0, 0, 7));
  EXPECT_THAT(channel_values(probe, world, "shear_stress"), ElementsAre(3, 0, 0, -1));
  EXPECT_THAT(channel_values(probe, world, "normal_force"), ElementsAre(15));
  EXPECT_THAT(channel_values(probe, world, "shear_force"), ElementsAre(2));
  EXPECT_THAT(channel_values(probe, world, "friction_angle"),
              ElementsAre(DoubleEq(std::atan(2.0 / 15) * 180 / std::numbers::pi)));
}

TEST(WallProfile, OfSandThatPressesWithItsDepthIsALine) {
  FakeWorld world = silo();
  constexpr int grains = 2000;
  const auto stress = [](double z) { return 1e3 * (2 - z); };
  for (int k = 0; k < grains; ++k) {
    const double z = (k + 0.5) * 2 / grains;
    contact(world, static_cast<std::uint32_t>(k % 2), z, stress(z) * 2 / grains, 0.3 * stress(z) * 2 / grains);
  }
  WallProfile probe = made(20);
  probe.prepare(world);
  const auto normal = channel_values(probe, world, "normal_stress"),
             shear = channel_values(probe, world, "shear_stress");
  for (std::size_t s = 0; s < 20; ++s) {
    const double z = 0.1 * (static_cast<double>(s) + 0.5);
    EXPECT_NEAR(normal[s], stress(z), 1e-9) << s;
    EXPECT_NEAR(shear[s], 0.3 * stress(z), 1e-9) << s;
  }
  EXPECT_THAT(channel_values(probe, world, "friction_angle"),
              ElementsAre(DoubleNear(std::atan(0.3) * 180 / std::numbers::pi, 1e-12)));
}

TEST(WallProfile, CountsTouchesBeyondItsEndsInTheResultantsAlone) {
  FakeWorld world = silo();
  contact(world, 0, 0.3, 3, 1), contact(world, 0, 1.5, 5, 1);
  WallProfile probe = made(1);
  probe.low = 1, probe.high = 2;
  probe.prepare(world);
  EXPECT_THAT(channel_values(probe, world, "normal_stress"), ElementsAre(5));
  EXPECT_THAT(channel_values(probe, world, "normal_force"), ElementsAre(8));
}

/// A column of grains between the walls that stands on the floor, each borne by the one below and by a wall; under
/// gravity [m/s²], and accelerated by what it has too little support for.
FakeWorld column(double gravity, double hangs, double presses, double support) {
  FakeWorld world = silo();
  constexpr std::uint32_t grains = 5;
  std::vector<double> on{0};  // from the top down
  for (std::uint32_t k = 0; k < grains; ++k) {
    const auto body = world.add({k % 2 == 0 ? 0.1 : 0.9, 0.25, 0.1 + 0.2 * (grains - 1 - k)}, 0.1);
    const double weight = gravity / world.velocity[body].w;
    on.push_back(support * (on[k] + weight - hangs));
    world.force[body] = {0, 0, hangs + on[k + 1] - on[k] - weight, 0};
  }
  for (std::uint32_t k = 0; k + 1 < grains; ++k) world.add_contact(k, k + 1, {0, 0, -0.2}, {0, 0, -on[k + 1]});
  for (std::uint32_t k = 0; k < grains; ++k) {
    const double out = k % 2 == 0 ? -1 : 1;
    world.add_wall_contact(k, k % 2, {0.1 * out, 0, 0}, {presses * out, 0, -hangs});
  }
  world.add_wall_contact(grains - 1, 2, {0, 0, -0.1}, {0, 0, -on[grains]});
  return world;
}

TEST(WallProfile, TellsWhatWallsAndBottomBearOfTheWeight) {
  const FakeWorld world = column(10, 30, 40, 1);
  const double mass = 5 / world.velocity[0].w, weight = 10 * mass;
  WallProfile probe = made(4);
  probe.bottom = {"floor"};
  probe.prepare(world);
  const auto value = [&](const char* name) { return channel_value(probe, world, name); };
  EXPECT_DOUBLE_EQ(value("weight"), weight);
  EXPECT_DOUBLE_EQ(value("bottom_force"), weight - 5 * 30);
  EXPECT_DOUBLE_EQ(value("bottom_fraction"), 1 - 5 * 30 / weight);
  EXPECT_DOUBLE_EQ(value("shear_fraction"), 5 * 30 / weight);
  EXPECT_DOUBLE_EQ(value("normal_fraction"), 5 * 40 / weight);
  EXPECT_DOUBLE_EQ(value("bottom_fraction") + value("shear_fraction"), 1);
}

TEST(WallProfile, TakesTheWeightOfWhatFallsToo) {
  const FakeWorld world = column(10, 30, 40, 0.5);
  const double weight = 10 * 5 / world.velocity[0].w;
  WallProfile probe = made(4);
  probe.bottom = {"floor"};
  probe.prepare(world);
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "weight"), weight);
  EXPECT_LT(channel_value(probe, world, "bottom_fraction") + channel_value(probe, world, "shear_fraction"), 0.5);
}

// Net forces on bodies of a clump are those of contacts alone; its own has the weight.
TEST(WallProfile, TakesTheWeightOfClumps) {
  struct : FakeWorld {
    std::vector<std::uint32_t> of;
    std::vector<ClumpView> clump{1};
    std::span<const std::uint32_t> clump_of() const override { return of; }
    std::span<const ClumpView> clumps() const override { return clump; }
  } world;
  static_cast<FakeWorld&>(world) = silo();
  for (const double z : {0.1, 0.5, 0.6}) world.add({0.5, 0.25, z}, 0.1);
  world.of = {no_clump, 0, 0};
  world.add_contact(0, 1, {0, 0, 0.2}, {0, 0, 4}), world.add_wall_contact(0, 2, {0, 0, -0.1}, {0, 0, -7});
  world.force[0] = {0, 0, 7 - 4 - 2, 0}, world.force[1] = {0, 0, 4, 0};
  world.clump[0].force = {0, 0, 4 - 5};
  WallProfile probe = made(4);
  probe.prepare(world);
  EXPECT_DOUBLE_EQ(channel_value(probe, world, "weight"), 2 + 5);
}

TEST(WallProfile, HasNoSharesWithoutWeight) {
  WallProfile probe = made(4);
  probe.bottom = {"floor"};
  // A third of a newton is no binary number: rounding is left.
  const FakeWorld weightless = column(0, -1.0 / 3, 40, 1), nobody = silo(), upwards = column(-10, -30, 40, 1);
  for (const FakeWorld* world : {&weightless, &nobody, &upwards}) {
    probe.prepare(*world);
    for (const char* name : {"weight", "bottom_fraction", "shear_fraction", "normal_fraction"})
      EXPECT_TRUE(std::isnan(channel_value(probe, *world, name))) << name;
  }
  probe.prepare(weightless);
  EXPECT_DOUBLE_EQ(channel_value(probe, weightless, "bottom_force"), 5.0 / 3);
  EXPECT_EQ(channel_value(probe, nobody, "bottom_force"), 0);
}

TEST(WallProfile, HasNoBottomUnlessItIsNamed) {
  const WallProfile probe = made(4);
  for (const Channel& channel : probe.channels()) EXPECT_THAT(channel.name, Not(HasSubstr("bottom")));
}

std::string refusal(WallProfile probe, const FakeWorld& world) {
  try {
    probe.prepare(world);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(WallProfile, RefusesWallsThatDoNotStand) {
  WallProfile probe = made(4);
  probe.walls = {"left", "flor"};
  EXPECT_THAT(refusal(probe, silo()), HasSubstr("walls: found \"flor\", which is not a wall; did you mean"));
  WallProfile bottomless = made(4);
  bottomless.bottom = {"flor"};
  EXPECT_THAT(refusal(bottomless, silo()), HasSubstr("bottom: found \"flor\", which is not a wall; did you mean"));
  bottomless.bottom = {"floor", "right"};
  EXPECT_EQ(complaints(bottomless),
            "bottom: found \"right\", which is in walls as well, allowed: names that are not in walls\n");
  probe.walls = {"floor"};
  EXPECT_EQ(
      refusal(probe, silo()),
      "walls: found wall \"floor\", which is not parallel to z; allowed is walls parallel to z, or another axis for "
      "`along`");
  FakeWorld round = silo();
  round.wall[0].normal = Vec3::Zero();
  EXPECT_EQ(refusal(made(4), round),
            "walls: found wall \"left\", which has no normal of its own; allowed is flat or grooved walls");
}

INSTANTIATE_TEST_SUITE_P(WallProfile, ProbeContract,
                         testing::Values(ProbeCase{"silo",
                                                   [] {
                                                     auto probe = std::make_shared<WallProfile>(made(7));
                                                     probe->bottom = {"floor"};
                                                     return probe;
                                                   },
                                                   [] {
                                                     FakeWorld world = silo();
                                                     for (int k = 0; k < 30; ++k)
                                                       contact(world, static_cast<std::uint32_t>(k % 2), 0.06 * k + 0.1,
                                                               1 + 0.1 * k, 0.5);
                                                     return world;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
