// The critical time step follows contacts that form and open between searches.
#include "contact/critical_step.hpp"

#include <gtest/gtest.h>

#include "support/packing.hpp"

namespace grit::test::critical_step_tests {
namespace {

constexpr double radius = 5e-4;

/// Grains at rest without contact, and one in their middle that six others approach.
std::vector<Grain> ambush(double speed) {
  std::vector<Grain> grains;
  const Vec3 middle = Vec3::Constant(10 * radius);
  for (int x = 0; x < 9; ++x)
    for (int y = 0; y < 9; ++y)
      for (int z = 0; z < 9; ++z) {
        const Vec3 place = 2.5 * radius * Vec3(x, y, z);
        if ((place - middle).norm() > 4.6 * radius) grains.push_back({place, radius});
      }
  grains.push_back({middle, radius});
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 out = side * Vec3::Unit(axis);
      grains.push_back({middle + 2.4 * radius * out, radius, -speed * out});
    }
  return grains;
}

std::vector<Grain> as_they_are(const World& world) {
  std::vector<Grain> grains;
  for (std::size_t i = 0; i < world.ids().size(); ++i)
    grains.push_back({xyz(world.positions()[i]), radius, xyz(world.velocities()[i])});
  return grains;
}

Description description_of(const std::vector<Grain>& grains) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e8}}, grains);
  d["guards"] = {{"overlap", 1}, {"travel", 0.5}, {"energy", 10}};
  d["time_step"]["value"] = 2e-7;
  return d;
}

TEST(CriticalStep, FollowsContactsBetweenSearches) {
  Trial t(description_of(ambush(8)));
  const auto critical = [&] { return t.kernel().critical_time_step(); };
  const double alone = critical();
  while (t.kernel().state().pairs.touching_count() < 6) t.step();
  t.step(25);
  ASSERT_EQ(t.kernel().state().pairs.touching_count(), 6u);
  EXPECT_LT(critical(), 0.6 * alone) << "a body with six contacts, another with one: √(2/7)";
  const std::uint64_t searches = t.kernel().state().lists.rebuilds();
  EXPECT_DOUBLE_EQ(critical(), Trial(description_of(as_they_are(t.world()))).kernel().critical_time_step());
  while (t.kernel().state().pairs.touching_count() > 0) t.step();
  EXPECT_EQ(t.kernel().state().lists.rebuilds(), searches) << "without a search";
  t.step(25);
  EXPECT_DOUBLE_EQ(critical(), alone);
}

}  // namespace
}  // namespace grit::test::critical_step_tests
