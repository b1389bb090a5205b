// Spring energy left when a contact opens: the normal force vanishes within a step, so that friction and rolling do not
// dissipate the rest.
#include <gtest/gtest.h>

#include <string>

#include "support/packing.hpp"
#include "support/verified.hpp"

namespace grit::test::parting_tests {
namespace {

constexpr double radius = 1e-3, speed = 0.1;

/// An impact at 45° of a spinning ball on a plane or on another ball, with high friction and rolling resistance, at the
/// default time step.
Description impact(const std::string& law, bool wall) {
  std::vector<Grain> balls{{{0, 0, 1.01 * radius}, radius, {speed, 0, -speed}, {50, 20, 0}}};
  if (!wall) balls.push_back({{0, 0, -1.01 * radius}, radius, {-speed, 0, speed}});
  Description material{{"density", 2500}, {"friction_angle", "78 deg"}};
  if (law != "linear-frictional") material.update({{"rolling_stiffness", 2}, {"rolling_limit", 5}});
  if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
  Description d = description(law, material, balls);
  if (wall) d["walls"]["floor"] = {{"type", "plane"}, {"material", "grain"}};
  return d;
}

class Parting : public testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(Parting, IsBookedAsFrictionAndRolling) {
  const auto& [law, wall] = GetParam();
  Trial trial(impact(law, wall), 1, BodyState::energy);
  const World& world = trial.world();
  Energies before = world.energies();
  const auto touching = [&] { return world.contacts().size() > 0; };
  for (int steps = 0; !touching() && steps < 100000; ++steps) trial.step(1);
  ASSERT_TRUE(touching());
  while (touching()) before = world.energies(), trial.step(1);
  const Energies after = world.energies();
  ASSERT_GT(before.elastic_shear, 1e-5 * before.kinetic);
  EXPECT_EQ(after.elastic(), 0);
  EXPECT_NEAR(after.friction - before.friction, before.elastic_shear, 1e-9 * before.elastic_shear);
  EXPECT_NEAR(after.rolling - before.rolling, before.elastic_rolling, 1e-9 * before.elastic_rolling);
  EXPECT_EQ(before.elastic_rolling > 1e-5 * before.kinetic, law != "linear-frictional");
}

INSTANTIATE_TEST_SUITE_P(All, Parting,
                         testing::Combine(testing::Values("linear-frictional", "linear-rolling", "hertz-mindlin"),
                                          testing::Bool()),
                         [](const auto& one) {
                           std::string name = std::get<0>(one.param) + (std::get<1>(one.param) ? "_wall" : "_pair");
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace grit::test::parting_tests
