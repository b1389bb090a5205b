#include <gmock/gmock.h>

#include <numbers>

#include "cone.hpp"
#include "grit/testing/geometry.hpp"

namespace grit {
namespace {

constexpr double pi = std::numbers::pi;

/// A cone about z, from 0 to its height.
struct Shape {
  double start_radius = 0.4, end_radius = 1.3, height = 1.2;

  std::shared_ptr<Cone> made(bool inside, bool two_sided, const Vec3& start = Vec3::Zero(),
                             const Vec3& axis = Vec3::UnitZ()) const {
    return grit::made<Cone>({{"start", start},
                             {"end", Vec3(start + height * axis)},
                             {"start_radius", start_radius},
                             {"end_radius", end_radius},
                             {"inside", inside},
                             {"two_sided", two_sided}});
  }
  double radius(double z) const { return start_radius + (end_radius - start_radius) * z / height; }
  /// Vector from a point in the half plane x > 0 to the closest point of the section, by ternary search.
  Vec3 closest(double off_axis, double z) const {
    const auto at = [&](double part) {
      return Vec3(start_radius + part * (end_radius - start_radius), 0, part * height);
    };
    const Vec3 from(off_axis, 0, z);
    double low = 0, high = 1;
    for (int i = 0; i < 200; ++i) {
      const double left = low + (high - low) / 3, right = high - (high - low) / 3;
      if ((at(left) - from).norm() < (at(right) - from).norm()) high = right;
      else low = left;
    }
    return at(low) - from;
  }
  /// Whether a centre is inside the cone, extended past its ends.
  bool within(const Vec3& centre) const { return std::hypot(centre.x(), centre.y()) < radius(centre.z()); }
  /// Whether its closest point is on a rim.
  bool past_rim(const Vec3& centre) const {
    const double along =
        (std::hypot(centre.x(), centre.y()) - start_radius) * (end_radius - start_radius) + centre.z() * height;
    return along < 0 || along > std::pow(end_radius - start_radius, 2) + height * height;
  }
};

const Shape hopper{};
const Shape steep{.start_radius = 0.5, .end_radius = 0.35, .height = 2};
const Shape tip{.start_radius = 0, .end_radius = 1, .height = 1};

GeometryCase one_case(const std::string& name, const Shape& shape, bool inside, bool two_sided, double radius) {
  const double extent = std::max(shape.start_radius, shape.end_radius) + radius;
  return {.name = name,
          .geometry = shape.made(inside, two_sided),
          .where = {{-extent, -extent, -radius}, {extent, extent, shape.height + radius}},
          .radius = radius,
          .facet_error = extent * (1 - std::cos(pi / 64)),
          .hollow_radius = std::min(shape.start_radius, shape.end_radius),
          .in_front = [=](const Vec3& c) { return two_sided || shape.past_rim(c) || shape.within(c) == inside; }};
}

GeometryCase funnel() {
  GeometryCase one = one_case("hopper", hopper, true, false, 0.15);
  one.flanks = {{{0.4, 0, 0.2}, {0.85, 0, 0.8}},         // down the slope
                {{0.68, -0.1, 0.6}, {0.68, 0.1, 0.6}}};  // around the axis
  one.across = {{{0.35, 0, 0.2}, {0.33, 0.05, -0.15}},   // out through the outlet
                {{1.1, 0, 1.1}, {1.3, 0, 1.35}}};        // over the upper rim
  return one;
}

GeometryCase turned() {
  const Vec3 start(0.1, -0.2, 0.3), axis = Vec3(1, 2, 2) / 3;
  return {.name = "turned",
          .geometry = hopper.made(true, true, start, axis),
          .where = {Vec3(-1.5, -1.3, -1), Vec3(2.2, 2.2, 2.4)},
          .radius = 0.3,
          .facet_error = 1.7e-3};
}

INSTANTIATE_TEST_SUITE_P(Cone, GeometryContract,
                         testing::Values(funnel(), one_case("spike", hopper, false, false, 0.15),
                                         one_case("shell", steep, true, true, 0.2), turned()),
                         case_name);

TEST(Cone, TouchesWhereItIsClosest) {
  std::mt19937_64 random(5);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (const Shape& shape : {hopper, steep}) {
    const auto shell = shape.made(true, true);
    int touching = 0, on_rims = 0;
    for (int i = 0; i < 10000; ++i) {
      const double radius = 0.2 * draw(0.1, 1), angle = draw(-pi, pi), z = draw(-0.2, shape.height + 0.2),
                   off = std::abs(shape.radius(z) + draw(-0.2, 0.2));
      const Mat3 rotation = Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix();
      const Vec3 centre = rotation * Vec3(off, 0, z), to_wall = rotation * shape.closest(off, z);
      const auto contacts = contacts_of(*shell, centre, radius);
      if (std::abs(to_wall.norm() - radius) < 1e-12 * radius) continue;
      ASSERT_EQ(contacts.size(), to_wall.norm() < radius ? 1u : 0u) << centre.transpose();
      if (contacts.empty()) continue;
      EXPECT_NEAR(contacts[0].overlap, radius - to_wall.norm(), 1e-12 * radius);
      EXPECT_LE((contacts[0].normal - to_wall.normalized()).norm(), 1e-7 / std::sqrt(to_wall.norm()))
          << "to the accuracy of the search";
      ++touching, on_rims += shape.past_rim(centre);
    }
    EXPECT_GT(touching, 2000);
    EXPECT_GT(on_rims, 200);
  }
}

TEST(Cone, WallPushesAlongItsNormal) {
  const double half_angle = std::atan(0.75);
  const Vec3 inward(-std::cos(half_angle), 0, std::sin(half_angle));
  for (const double off : {0.04, 1e-12, 0.0, -0.04}) {
    const Vec3 centre = Vec3(0.85, 0, 0.6) + off * inward;
    const auto in_hopper = contacts_of(*hopper.made(true, false), centre, 0.05);
    ASSERT_EQ(in_hopper.size(), 1u);
    EXPECT_LE((in_hopper[0].normal + inward).norm(), 1e-15);
    EXPECT_NEAR(in_hopper[0].overlap, 0.05 - off, 1e-15);
    const auto on_spike = contacts_of(*hopper.made(false, false), centre, 0.05);
    ASSERT_EQ(on_spike.size(), 1u);
    EXPECT_LE((on_spike[0].normal - inward).norm(), 1e-15);
    EXPECT_NEAR(on_spike[0].overlap, 0.05 + off, 1e-15);
  }
  EXPECT_TRUE(contacts_of(*hopper.made(true, false), Vec3(0.85, 0, 0.6) - 0.051 * inward, 0.05).empty());
}

TEST(Cone, OutletIsAHoleWithARim) {
  const auto wall = hopper.made(true, false);
  EXPECT_TRUE(contacts_of(*wall, {0, 0, 0}, 0.31).empty()) << "0.32 m from the wall";
  EXPECT_TRUE(contacts_of(*wall, {0.1, 0, -0.1}, 0.3).empty());
  const auto rim = contacts_of(*wall, {0.34, 0, -0.08}, 0.11);
  ASSERT_EQ(rim.size(), 1u);
  EXPECT_NEAR(rim[0].overlap, 0.01, 1e-15);
  EXPECT_LE((rim[0].normal - Vec3(0.6, 0, 0.8)).norm(), 1e-14);
}

TEST(Cone, IsOneFeatureAroundItsAxis) {
  const auto wall = hopper.made(true, false);
  for (int i = 0; i <= 1000; ++i) {
    const double angle = 2 * pi * i / 1000, z = 0.2 + 0.9 * i / 1000;
    const auto contacts = contacts_of(
        *wall, {(hopper.radius(z) - 0.1) * std::cos(angle), (hopper.radius(z) - 0.1) * std::sin(angle), z}, 0.1);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].feature, 0u);
    EXPECT_NEAR(contacts[0].overlap, 0.1 - 0.08, 1e-14) << "0.1 m along the radius is 0.08 m along the normal";
  }
}

// A sphere held by a funnel has contacts on two sides, and neither replaces the other suddenly.
TEST(Cone, FunnelHoldsASphereThatCannotPass) {
  const auto funnel = tip.made(true, false);
  const double root = std::sqrt(0.5);
  for (const double offset : {0.0, 1e-9, 0.01}) {
    const auto contacts = contacts_of(*funnel, {offset, 0, 0.4}, 0.3);
    ASSERT_EQ(contacts.size(), 2u) << offset;
    EXPECT_NEAR(contacts[0].overlap, 0.3 - root * (0.4 - offset), 1e-15);
    EXPECT_NEAR(contacts[1].overlap, 0.3 - root * (0.4 + offset), 1e-15);
    EXPECT_LE((contacts[0].normal + contacts[1].normal - Vec3(0, 0, -2 * root)).norm(), 1e-15);
  }
  const auto below = contacts_of(*funnel, {0.03, 0, -0.04}, 0.1);
  ASSERT_EQ(below.size(), 1u) << "the tip is one contact";
  EXPECT_NEAR(below[0].overlap, 0.05, 1e-15);
  EXPECT_LE((below[0].normal - Vec3(-0.6, 0, 0.8)).norm(), 1e-14);
}

TEST(Cone, GivesBoundsAndTriangles) {
  EXPECT_LE((hopper.made(true, false)->bounds().low - Vec3(-1.3, -1.3, 0)).norm(), 1e-15);
  EXPECT_LE((hopper.made(true, false)->bounds().high - Vec3(1.3, 1.3, 1.2)).norm(), 1e-15);
  EXPECT_EQ(tip.made(true, false)->triangles().size(), 64u * 3) << "none degenerate at the tip";
  for (const bool inside : {true, false}) {
    const auto t = hopper.made(inside, false)->triangles();
    double area = 0;
    for (std::size_t i = 0; i < t.size(); i += 3) {
      const Vec3 half = 0.5 * (t[i + 1] - t[i]).cross(t[i + 2] - t[i]);
      EXPECT_EQ(half.z() > 0, inside) << "a hopper that widens upwards";
      area += half.norm();
    }
    EXPECT_NEAR(area, pi * 1.7 * 1.5, pi * 1.7 * 1.5 * 2e-3);
  }
}

TEST(Cone, RefusesInvalidShapes) {
  const auto complaint = [](const Shape& shape, const Vec3& axis = Vec3::UnitZ()) -> std::string {
    try {
      shape.made(true, false, Vec3::Zero(), axis);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint({.start_radius = 0, .end_radius = 0}),
            "end_radius: found a cone whose radii are both 0, allowed: at least one radius above 0; ");
  EXPECT_EQ(complaint(hopper, Vec3::Zero()), "end: found the same point as start, allowed: a different point; ");
  EXPECT_EQ(complaint(hopper), "");
  EXPECT_EQ(complaint(tip), "");
}

}  // namespace
}  // namespace grit
