// A packing in a box of smooth walls: what the contacts inside carry is what the walls feel.
#include <gtest/gtest.h>

#include "support/packing.hpp"
#include "support/verified.hpp"

namespace grit::test {
namespace {

constexpr double side_length = 6e-3;

Description boxed() {
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}}, jumble({6, 6, 6}, 1e-3, 0, 12));
  d["materials"]["smooth"] = {{"friction_angle", 0}, {"rolling_limit", 0}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][std::string(up ? "low_" : "high_") + "xyz"[axis]] =
          side(axis, up ? 0 : side_length, Vec3::Zero(), Vec3::Constant(side_length), up, "smooth");
  d["specimen"] = {{"low", {"low_x", "low_y", "low_z"}}, {"high", {"high_x", "high_y", "high_z"}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.7}};
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  return d;
}

/// Σ over walls of force ⊗ point of touch + Σ over bodies of net force ⊗ place, over the volume.
Mat3 from_outside(const World& world) {
  Mat3 sum = Mat3::Zero();
  for (const Contact& c : world.contacts())
    if (c.with_wall) sum += c.force * (xyz(world.positions()[c.a]) + c.branch).transpose();
  for (std::size_t i = 0; i < world.positions().size(); ++i)
    sum += xyz(world.forces()[i]) * xyz(world.positions()[i]).transpose();
  return sum / world.specimen().volume();
}

TEST(PackingStress, OfContactsIsThatOfWalls) {
  Trial t(boxed());
  t.step(20);
  Mat3 inside = mean_stress(t.world(), t.world().specimen());
  // Newton's law, moved about: it holds at every instant to round-off.
  EXPECT_LT((inside - from_outside(t.world())).norm(), 1e-14 * inside.norm()) << inside << "\n\n"
                                                                              << from_outside(t.world());

  while (unrest(t.world()).unbalanced_force > 1e-9 && t.world().step() < 60000) t.step(100);
  ASSERT_LT(unrest(t.world()).unbalanced_force, 1e-9);
  inside = mean_stress(t.world(), t.world().specimen());
  Mat3 outside = Mat3::Zero();
  const auto walls = t.world().walls();
  for (int axis = 0; axis < 3; ++axis)
    for (const WallView& wall : walls)
      if (wall.name == std::string("high_") + "xyz"[axis]) outside.col(axis) = wall.force / wall.area;
  // At rest but for the net forces that are left.
  EXPECT_LT((inside.diagonal() - outside.diagonal()).norm(), 1e-9 * inside.norm());
  for (int axis = 0; axis < 3; ++axis) EXPECT_GT(inside(axis, axis), 1e3) << "pressed";
  EXPECT_NEAR(inside(0, 1), inside(1, 0), 1e-9 * inside.norm()) << "moments balance";
  EXPECT_EQ(outside(0, 1), 0) << "smooth walls";
}

TEST(PackingStress, IsTheSameInSinglePrecision) {
  const auto at_rest = [](const char* precision) {
    Description d = boxed();
    d["contacts"]["precision"] = precision;
    Trial t(d);
    t.step(10000);
    EXPECT_LT(unrest(t.world()).unbalanced_force, 1e-4) << precision;
    return mean_stress(t.world(), t.world().specimen());
  };
  const Mat3 exact = at_rest("double"), rounded = at_rest("single");
  verify("mean stress after 10 000 steps in single precision against double, Pa", rounded.trace() / 3,
         exact.trace() / 3, 1e-3);
  EXPECT_LT((rounded - exact).norm(), 1e-3 * exact.norm());
  EXPECT_GT((rounded - exact).norm(), 0) << "the arithmetic was double";
}

}  // namespace
}  // namespace grit::test
