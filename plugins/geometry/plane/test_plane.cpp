#include <gmock/gmock.h>

#include "grit/testing/geometry.hpp"
#include "plane.hpp"

namespace grit {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Vec3 up = Vec3::UnitZ();

GeometryCase plane_case(std::string name, const Vec3& point, const Vec3& normal) {
  const Vec3 unit = normal.normalized(), u = unit.unitOrthogonal();
  return {.name = std::move(name),
          .geometry = made<Plane>({{"point", point}, {"normal", normal}, {"extent", 5.0}}),
          .where = {point - Vec3::Constant(0.3), point + Vec3::Constant(0.3)},
          .radius = 0.1,
          .flanks = {{point + 0.09 * unit, point + 0.09 * unit + u}},
          .across = {{point + 0.2 * unit - u, point + 0.01 * unit + u}},
          .in_front = [=](const Vec3& centre) { return unit.dot(centre - point) >= 0; }};
}

INSTANTIATE_TEST_SUITE_P(Plane, GeometryContract,
                         testing::Values(plane_case("floor", {0, 0, -0.2}, {0, 0, 3}),
                                         plane_case("right_side", {1, 0, 0}, {-1, 0, 0}),
                                         plane_case("oblique", {0.3, -0.2, 0.1}, {1, -2, 0.5})),
                         case_name);

TEST(Plane, PushesBackAtAnyDepth) {
  const auto plane = made<Plane>({{"point", Vec3(0, 0, 1)}});
  for (const double height : {0.09, 0.0, -0.05, -0.1, -7.0}) {
    const auto contacts = contacts_of(*plane, {3, 4, 1 + height}, 0.1);
    ASSERT_EQ(contacts.size(), 1u) << height;
    EXPECT_EQ(contacts[0].normal, Vec3(-up));
    EXPECT_NEAR(contacts[0].overlap, 0.1 - height, 1e-15);
    EXPECT_EQ(contacts[0].feature, 0u);
  }
  EXPECT_TRUE(contacts_of(*plane, {3, 4, 1.1000001}, 0.1).empty());
}

TEST(Plane, IsFlatAlongTheAxisOfItsNormalOnly) {
  const Bounds floor = made<Plane>({{"point", Vec3(1, 2, 3)}, {"normal", Vec3(0, 0, -2)}})->bounds();
  EXPECT_EQ(floor.low, Vec3(-infinity, -infinity, 3));
  EXPECT_EQ(floor.high, Vec3(infinity, infinity, 3));
  const Bounds oblique = made<Plane>({{"normal", Vec3(0, 1e-3, 1)}})->bounds();
  EXPECT_EQ(oblique.low, Vec3::Constant(-infinity));
  EXPECT_EQ(oblique.high, Vec3::Constant(infinity));
}

TEST(Plane, DrawsASquareOfItsExtentOrItsArea) {
  const auto side = [](const Plane& plane) {
    const auto t = plane.triangles();
    return t.empty() ? 0 : (t[1] - t[0]).norm();
  };
  EXPECT_EQ(side(*made<Plane>({})), 0);
  EXPECT_NEAR(side(*made<Plane>({{"area", 4.0}})), 2, 1e-15);
  EXPECT_NEAR(side(*made<Plane>({{"area", 4.0}, {"extent", 3.0}})), 3, 1e-15);
  const auto t = made<Plane>({{"normal", Vec3(1, 2, -3)}, {"extent", 2.0}})->triangles();
  EXPECT_NEAR(((t[1] - t[0]).cross(t[2] - t[0]).normalized() - Vec3(1, 2, -3).normalized()).norm(), 0, 1e-15)
      << "counter-clockwise as seen by the bodies";
}

TEST(Plane, RefusesANormalWithoutDirection) {
  try {
    made<Plane>({{"normal", Vec3(0, 0, 0)}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "normal: found a vector of length 0, allowed: a vector of non-zero length; ");
  }
}

}  // namespace
}  // namespace grit
