#include <gmock/gmock.h>

#include <numbers>

#include "cylinder.hpp"
#include "grit/testing/geometry.hpp"

namespace grit {
namespace {

constexpr double pi = std::numbers::pi;

// A cylinder of radius 1 m about z, from 0 to 2 m by default.
std::shared_ptr<Cylinder> tube(bool inside, bool two_sided, const Vec3& start = Vec3::Zero(),
                               const Vec3& end = Vec3(0, 0, 2)) {
  return made<Cylinder>(
      {{"start", start}, {"end", end}, {"radius", 1.0}, {"inside", inside}, {"two_sided", two_sided}});
}

double off_axis(const Vec3& centre) { return std::hypot(centre.x(), centre.y()); }
bool beside(const Vec3& centre) { return centre.z() > 0 && centre.z() < 2; }

GeometryCase one_case(const std::string& name, bool inside, bool two_sided) {
  return {.name = name,
          .geometry = tube(inside, two_sided),
          .where = {{-1.3, -1.3, -0.3}, {1.3, 1.3, 2.3}},
          .radius = 0.2,
          .facet_error = 1 - std::cos(pi / 64),
          .hollow_radius = 1,
          .in_front = [=](const Vec3& c) { return two_sided || !beside(c) || (off_axis(c) < 1) == inside; }};
}

GeometryCase drum() {
  GeometryCase one = one_case("drum", true, false);
  one.flanks = {{{0.83, 0, 0.3}, {0.83, 0, 1.7}},    // along the axis
                {{0.81, -0.3, 1}, {0.81, 0.3, 1}},   // around the axis
                {{0.83, 0, 1.8}, {0.95, 0, 2.15}}};  // over the rim
  one.across = {{{-0.9, 0.1, 1}, {-0.7, 0.3, 1.1}},
                {{0.85, 0, 1.5}, {0.9, 0.1, 2.3}},      // out over the rim
                {{0.7, 0.2, -0.3}, {1.1, 0.2, -0.1}}};  // past the rim
  return one;
}

GeometryCase rod() {
  GeometryCase one = one_case("rod", false, false);
  one.flanks = {{{1.17, 0, 0.3}, {1.17, 0, 1.7}}, {{1.15, -0.1, 1}, {1.15, 0.1, 1}}};
  one.across = {{{1.3, 0.2, 1}, {0.2, 1.3, 1}}, {{1.15, 0, 1.5}, {1.05, 0, 2.3}}};
  return one;
}

GeometryCase turned() {
  const Vec3 start(0.1, -0.2, 0.3), axis = Vec3(1, 2, 2) / 3;
  return {.name = "turned",
          .geometry = tube(true, true, start, start + 2 * axis),
          .where = {Vec3(-1.2, -1.3, -1), Vec3(2, 2.4, 2.6)},
          .radius = 0.3,
          .facet_error = 1 - std::cos(pi / 64)};
}

INSTANTIATE_TEST_SUITE_P(Cylinder, GeometryContract,
                         testing::Values(drum(), rod(), one_case("shell", true, true), turned()), case_name);

// Closed forms: the distance is |R − off axis| to the face, else that to the rim.
TEST(Cylinder, TouchesWhereItIsClosest) {
  std::mt19937_64 random(5);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const auto shell = tube(true, true);
  int faces = 0, rims = 0;
  for (int i = 0; i < 20000; ++i) {
    const double radius = 0.3 * draw(0.1, 1), angle = draw(-pi, pi), off = draw(0.6, 1.4), z = draw(-0.3, 2.3);
    const Vec3 out(std::cos(angle), std::sin(angle), 0), centre = off * out + z * Vec3::UnitZ();
    const Vec3 to_wall = Vec3(out.x(), out.y(), std::clamp(z, 0.0, 2.0)) - centre;
    const auto contacts = contacts_of(*shell, centre, radius);
    ASSERT_EQ(contacts.size(), to_wall.norm() < radius ? 1u : 0u) << centre.transpose();
    if (contacts.empty()) continue;
    EXPECT_NEAR(contacts[0].overlap, radius - to_wall.norm(), 1e-12 * radius);
    EXPECT_LE((contacts[0].normal - to_wall.normalized()).norm(), 1e-15 / to_wall.norm());
    EXPECT_EQ(contacts[0].feature, 0u);
    ++(beside(centre) ? faces : rims);
  }
  EXPECT_GT(faces, 2000);
  EXPECT_GT(rims, 300);
}

TEST(Cylinder, FacePushesAlongItsNormalAtAnyDistance) {
  const Vec3 out(0.6, 0.8, 0);
  for (const double off : {1e-3, 1e-12, 0.0, -1e-12, -1e-3}) {  // in front and behind
    const auto contacts = contacts_of(*tube(true, false), (1 - off) * out + Vec3::UnitZ(), 0.1);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_LE((contacts[0].normal - out).norm(), 1e-15);
    EXPECT_NEAR(contacts[0].overlap, 0.1 - off, 1e-15);
  }
}

TEST(Cylinder, PushesBackACentreUpToOneRadiusBehind) {
  const auto only = [](const Geometry& geometry, const Vec3& centre) {
    const auto contacts = contacts_of(geometry, centre, 0.1);
    EXPECT_EQ(contacts.size(), 1u);
    return contacts.at(0);
  };
  const SurfaceContact drum = only(*tube(true, false), {1.05, 0, 1}), rod = only(*tube(false, false), {0.95, 0, 1}),
                       shell = only(*tube(true, true), {1.05, 0, 1});
  EXPECT_EQ(drum.normal, Vec3::UnitX());
  EXPECT_NEAR(drum.overlap, 0.15, 1e-15);
  EXPECT_EQ(rod.normal, Vec3(-Vec3::UnitX()));
  EXPECT_NEAR(rod.overlap, 0.15, 1e-15);
  EXPECT_EQ(shell.normal, Vec3(-Vec3::UnitX()));
  EXPECT_NEAR(shell.overlap, 0.05, 1e-15);
  EXPECT_TRUE(contacts_of(*tube(true, false), {1.101, 0, 1}, 0.1).empty());
  EXPECT_TRUE(contacts_of(*tube(false, false), {0.899, 0, 1}, 0.1).empty());
  EXPECT_NEAR(only(*tube(true, false), {1.03, 0, -0.04}).overlap, 0.05, 1e-15) << "no back side at the rim";
}

TEST(Cylinder, IsOneFeatureAroundTheAxisAndOverItsRim) {
  const auto drum = tube(true, false);
  for (int i = 0; i <= 1000; ++i) {
    const double angle = 2 * pi * i / 1000, z = 2.1 * i / 1000;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    const auto contacts = contacts_of(*drum, 0.85 * out + z * Vec3::UnitZ(), 0.2);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].feature, 0u);
    if (z <= 2) {
      EXPECT_LE((contacts[0].normal - out).norm(), 1e-14);
    }
  }
}

TEST(Cylinder, SphereTooLargeForItIsHeldOnBothSides) {
  const auto drum = tube(true, false);
  const auto within = contacts_of(*drum, {0.1, 0, 1}, 1.2);
  ASSERT_EQ(within.size(), 2u);
  EXPECT_NEAR(within[0].overlap, 0.3, 1e-15);
  EXPECT_NEAR(within[1].overlap, 0.1, 1e-15);
  EXPECT_LE((within[0].normal - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LE((within[1].normal - Vec3(-1, 0, 0)).norm(), 1e-15);
  const auto on_rim = contacts_of(*drum, {0, 0, 2.7}, 1.25);  // a sphere on a pipe
  ASSERT_EQ(on_rim.size(), 2u);
  for (const SurfaceContact& contact : on_rim) EXPECT_NEAR(contact.overlap, 1.25 - std::hypot(1, 0.7), 1e-15);
  EXPECT_LE((on_rim[0].normal + on_rim[1].normal - Vec3(0, 0, -1.4 / std::hypot(1, 0.7))).norm(), 1e-15);
  EXPECT_EQ(contacts_of(*tube(false, false), {2.1, 0, 1}, 3.2).size(), 1u) << "the near side hides the far one";
}

TEST(Cylinder, GivesBoundsAndNoArea) {
  const auto slanted = tube(true, false, {1, 1, 1}, {1, 4, 5});  // along (0, 0.6, 0.8)
  EXPECT_LE((slanted->bounds().low - Vec3(0, 0.2, 0.4)).norm(), 1e-15);
  EXPECT_LE((slanted->bounds().high - Vec3(2, 4.8, 5.6)).norm(), 1e-14);
  EXPECT_TRUE(slanted->hollow());
  EXPECT_FALSE(tube(false, false)->hollow());
  EXPECT_EQ(slanted->area(), 0);
}

TEST(Cylinder, TrianglesFaceTheBodies) {
  for (const bool inside : {true, false}) {
    const auto t = tube(inside, false)->triangles();
    ASSERT_FALSE(t.empty());
    double area = 0;
    for (std::size_t i = 0; i < t.size(); i += 3) {
      const Vec3 half = 0.5 * (t[i + 1] - t[i]).cross(t[i + 2] - t[i]);
      EXPECT_EQ(half.head<2>().dot((t[i] + t[i + 1] + t[i + 2]).head<2>()) < 0, inside);
      area += half.norm();
    }
    EXPECT_NEAR(area, 4 * pi, 4 * pi * 1e-3);
  }
}

TEST(Cylinder, RefusesZeroLengthAndRadius) {
  try {
    tube(true, false, {1, 2, 3}, {1, 2, 3});
    FAIL() << "a cylinder of no length";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "end: found the same point as start, allowed: a different point; ");
  }
  Cylinder cylinder;
  Parameters parameters;
  cylinder.declare(parameters);
  for (const Parameter& parameter : parameters.entries())
    if (parameter.name() == "radius") {
      EXPECT_TRUE(parameter.allows(1e-3) && !parameter.allows(0));
    }
}

}  // namespace
}  // namespace grit
