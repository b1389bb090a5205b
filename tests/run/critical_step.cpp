// The critical time step follows contacts that form and open between searches.
#include "contact/critical_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/packing.hpp"
#include "support/stl_file.hpp"

namespace grit::test::critical_step_tests {
namespace {

constexpr double radius = 5e-4, shear = 0.3;  // over the normal stiffness

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
  Description d =
      description("linear-rolling",
                  {{"contact_modulus", 1e8}, {"shear_to_normal_stiffness", shear}, {"rolling_stiffness", 0}}, grains);
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
  // Along each axis the one in the middle has two contacts along the normal, and four in shear; the others have one.
  const double one = 3.5 * shear, six = 2 + 4 * shear;
  EXPECT_NEAR(critical() / alone, std::sqrt(2 * one / (six + one)), 1e-6);
  const std::uint64_t searches = t.kernel().state().lists.rebuilds();
  EXPECT_DOUBLE_EQ(critical(), Trial(description_of(as_they_are(t.world()))).kernel().critical_time_step());
  while (t.kernel().state().pairs.touching_count() > 0) t.step();
  EXPECT_EQ(t.kernel().state().lists.rebuilds(), searches) << "without a search";
  t.step(50);
  EXPECT_DOUBLE_EQ(critical(), alone);
}

/// A column of soft grains on a floor, or what has become of it.
Description column(const std::vector<Grain>& grains) {
  Description d = description(
      "linear-frictional",
      {{"density", 2600}, {"contact_modulus", 1e6}, {"friction_angle", "25 deg"}, {"restitution", 0.5}}, grains);
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -9.81}}};
  return d;
}

TEST(CriticalStep, LagsInAColumnThatCollapsesByLessThanTheSafety) {
  std::vector<Grain> grains = jumble({6, 6, 16}, 1e-3, 0, 3);
  for (Grain& grain : grains) grain.radius *= 0.9;  // apart
  Trial t(column(grains));
  double most = 0;
  int samples = 0, late = 0;
  for (; t.world().time() < 0.1; ++samples) {
    t.step(7);
    std::vector<Grain> now;
    for (std::size_t i = 0; i < t.world().ids().size(); ++i)
      now.push_back({xyz(t.world().positions()[i]), t.world().positions()[i].w});
    const double lag = t.kernel().critical_time_step() / Trial(column(now)).kernel().critical_time_step();
    most = std::max(most, lag), late += lag > 1.05;
  }
  EXPECT_LT(most, 1.25) << "a safety of 0.8 covers it";
  RecordProperty("most", std::to_string(most)), RecordProperty("late", late), RecordProperty("samples", samples);
}

/// A funnel of this many triangles, whose slope is 45° at its edges; its tip is at 0.
std::vector<Vec3> funnel(int facets) {
  const auto rim = [&](int i) {
    const double angle = 2 * std::numbers::pi * i / facets;
    return Vec3(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.05);
  };
  std::vector<Vec3> corners;
  for (int i = 0; i < facets; ++i)
    for (const Vec3& corner : {Vec3(Vec3::Zero()), rim(i), rim(i + 1)}) corners.push_back(corner);
  return corners;
}

TEST(CriticalStep, CountsFacetsThatAreHitAtOnce) {
  constexpr int facets = 16;
  constexpr double ball = 0.01, modulus = 1e7, g = 9.81;
  const std::vector<Vec3> corners = funnel(facets);
  const StlFile file(stl_text(corners));
  Description d =
      description("linear-frictional",
                  {{"density", 2600}, {"contact_modulus", modulus}, {"friction_angle", "20 deg"}, {"restitution", 0.5}},
                  {{{0, 0, 0.02}, ball}});
  d["walls"]["funnel"] = {
      {"type", "mesh"}, {"path", file.path()}, {"scale", "1 m"}, {"open", true}, {"material", "grain"}};
  d["engines"] = {{"gravity", {{"type", "gravity"}, {"acceleration", {0, 0, -g}}}},
                  {"damping", {{"type", "local-damping"}, {"coefficient", 0.3}}}};
  Trial t(d);
  const double alone = t.world().dt();
  while (t.world().contacts().empty()) t.step();
  // One impact on all springs, K = 16 E R n_z², takes seven steps as those of two bodies do, K = 2 E R.
  const double n_z = corners[1].cross(corners[2]).normalized().z();
  EXPECT_NEAR(t.world().dt() / alone, std::sqrt(2 / (facets * n_z * n_z)), 1e-6);
  while (t.world().time() < 0.5) t.step();  // within the energy guard
  EXPECT_EQ(t.world().contacts().size(), std::size_t{facets});
  EXPECT_LT(t.velocity(0).norm(), 1e-6);
}

TEST(CriticalStep, IsNotShorterInAValleyOfTwoFacets) {
  // A valley of two facets is not stiffer than a body of the same size.
  const std::vector<Vec3> corners{{0, -1, 0}, {0, 1, 0}, {-1, -1, 0.2}, {0, 1, 0}, {0, -1, 0}, {1, 1, 0.2}};
  const StlFile file(stl_text(corners));
  Description d = description("linear-frictional", {{"density", 2600}, {"contact_modulus", 1e7}, {"restitution", 0.5}},
                              {{{0, 0, 0.0104}, 0.01}});
  Description with = d;
  with["walls"]["valley"] = {
      {"type", "mesh"}, {"path", file.path()}, {"scale", "1 m"}, {"open", true}, {"material", "grain"}};
  const Trial valley(with), free(d);
  EXPECT_EQ(valley.world().dt(), free.world().dt());
}

}  // namespace
}  // namespace grit::test::critical_step_tests
