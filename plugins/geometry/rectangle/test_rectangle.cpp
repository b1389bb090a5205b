#include <gmock/gmock.h>

#include "grit/testing/geometry.hpp"
#include "rectangle.hpp"

namespace grit {
namespace {

// A floor of 2 m × 1 m, from the origin.
std::shared_ptr<Rectangle> floor(bool two_sided) {
  return made<Rectangle>(
      {{"corner", Vec3(0, 0, 0)}, {"edge_a", Vec3(2, 0, 0)}, {"edge_b", Vec3(0, 1, 0)}, {"two_sided", two_sided}});
}

const std::vector<Path> flanks{{{0.5, 0.5, 0.07}, {1.5, 0.2, 0.05}}, {{1, 0.5, 0.05}, {2.04, 0.5, 0.05}}};
const std::vector<Path> across{{{-0.3, 0.5, 0.05}, {2.3, 0.6, 0.05}},      // edge, face, edge
                               {{-0.2, -0.2, 0.02}, {1, 1, 0.06}},         // over a corner
                               {{-0.01, 0.5, 0.15}, {-0.01, 0.5, -0.15}},  // down past an edge
                               {{1, 0.5, 0.2}, {1, 0.5, 0.01}}};
const Bounds around{{-0.3, -0.3, -0.2}, {2.3, 1.3, 0.2}};

GeometryCase oblique() {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 corner(0.1, 0.2, -0.3);
  return {.name = "oblique",
          .geometry = made<Rectangle>(
              {{"corner", corner}, {"edge_a", Vec3(turn * Vec3(0.7, 0, 0))}, {"edge_b", Vec3(turn * Vec3(0, 0.4, 0))}}),
          .where = {corner - Vec3::Constant(0.6), corner + Vec3::Constant(0.8)},
          .radius = 0.3,
          .across = {{corner - Vec3(0.5, 0.5, 0.5), corner + Vec3(0.8, 0.9, 0.7)}}};
}

INSTANTIATE_TEST_SUITE_P(Rectangle, GeometryContract,
                         testing::Values(GeometryCase{.name = "two_sided",
                                                      .geometry = floor(true),
                                                      .where = around,
                                                      .radius = 0.1,
                                                      .flanks = flanks,
                                                      .across = across},
                                         GeometryCase{.name = "one_sided",
                                                      .geometry = floor(false),
                                                      .where = around,
                                                      .radius = 0.1,
                                                      .flanks = flanks,
                                                      .across = across,
                                                      .in_front = [](const Vec3& c) { return c.z() >= 0; }},
                                         oblique()),
                         case_name);

TEST(Rectangle, TouchesFaceEdgeAndCornerOnce) {
  const auto sheet = floor(true);
  const auto only = [&](const Vec3& centre, double radius) {
    const auto contacts = contacts_of(*sheet, centre, radius);
    EXPECT_EQ(contacts.size(), 1u);
    return contacts.at(0);
  };
  const SurfaceContact face = only({1, 0.5, 0.09}, 0.1), edge = only({2.03, 0.5, 0.04}, 0.1),
                       corner = only({2.02, 1.03, 0.06}, 0.1);
  EXPECT_EQ(face.normal, Vec3(0, 0, -1));
  EXPECT_NEAR(face.overlap, 0.01, 1e-15);
  EXPECT_NEAR((edge.normal - Vec3(-0.6, 0, -0.8)).norm(), 0, 1e-14);
  EXPECT_NEAR(edge.overlap, 0.05, 1e-15);
  EXPECT_NEAR((corner.normal - Vec3(-2, -3, -6) / 7).norm(), 0, 1e-14);
  EXPECT_NEAR(corner.overlap, 0.03, 1e-15);
  EXPECT_EQ(face.feature, edge.feature);
  EXPECT_EQ(face.feature, corner.feature);
}

TEST(Rectangle, TwoSidedPushesToTheSideOfTheCentre) {
  const auto sheet = floor(true);
  EXPECT_EQ(contacts_of(*sheet, {1, 0.5, -0.04}, 0.1).at(0).normal, Vec3(0, 0, 1));
  EXPECT_NEAR(contacts_of(*sheet, {1, 0.5, -0.04}, 0.1).at(0).overlap, 0.06, 1e-15);
  EXPECT_EQ(contacts_of(*sheet, {1, 0.5, 0}, 0.1).at(0).normal, Vec3(0, 0, -1))
      << "a centre on the sheet is pushed along the normal";
}

TEST(Rectangle, OneSidedPushesBackACentreUpToOneRadiusBehind) {
  const auto face = floor(false);
  EXPECT_EQ(contacts_of(*face, {1, 0.5, -0.04}, 0.1).at(0).normal, Vec3(0, 0, -1));
  EXPECT_NEAR(contacts_of(*face, {1, 0.5, -0.04}, 0.1).at(0).overlap, 0.14, 1e-15);
  EXPECT_EQ(contacts_of(*face, {1, 0.5, -0.0999}, 0.1).size(), 1u);
  EXPECT_TRUE(contacts_of(*face, {1, 0.5, -0.1001}, 0.1).empty());
}

// Walls act independently: the limit stated in the README, and the reason for `box`.
TEST(Rectangle, TwoWallsDoubleTheForceAtTheirSeam) {
  const auto left = floor(true);
  const auto right = made<Rectangle>({{"corner", Vec3(2, 0, 0)}, {"edge_a", Vec3(2, 0, 0)}, {"edge_b", Vec3(0, 1, 0)}});
  const auto lift = [&](double x) {
    double sum = 0;
    for (const auto& wall : {left, right})
      for (const SurfaceContact& contact : contacts_of(*wall, {x, 0.5, 0.09}, 0.1))
        sum -= contact.overlap * contact.normal.z();
    return sum;
  };
  EXPECT_NEAR(lift(1.9), 0.01, 1e-15);
  EXPECT_NEAR(lift(2.1), 0.01, 1e-15);
  EXPECT_NEAR(lift(2), 0.02, 1e-15);
  const double width = std::sqrt(0.1 * 0.1 - 0.09 * 0.09);  // radius of the contact circle on the floor
  EXPECT_NEAR(lift(2 - 1.001 * width), 0.01, 1e-15);
  EXPECT_GT(lift(2 - 0.9 * width), 0.0101);
}

TEST(Rectangle, GivesAreaAndNormal) {
  const auto wall = made<Rectangle>({{"corner", Vec3(1, 1, 1)}, {"edge_a", Vec3(0, 2, 0)}, {"edge_b", Vec3(0, 0, 3)}});
  EXPECT_DOUBLE_EQ(wall->area(), 6);
  EXPECT_EQ(wall->normal(), Vec3::UnitX());
  EXPECT_EQ(wall->bounds().low, Vec3(1, 1, 1));
  EXPECT_EQ(wall->bounds().high, Vec3(1, 3, 4));
}

TEST(Rectangle, RefusesEdgesThatAreNotPerpendicular) {
  const auto complaint = [](const Vec3& a, const Vec3& b) -> std::string {
    try {
      made<Rectangle>({{"corner", Vec3(0, 0, 0)}, {"edge_a", a}, {"edge_b", b}});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint({1, 0, 0}, {1, 1, 0}),
            "edge_b: found an edge whose angle to edge_a has the cosine 0.707107, allowed: an edge perpendicular to "
            "edge_a; ");
  EXPECT_EQ(complaint({0, 0, 0}, {1, 1, 0}),
            "edge_a: found a vector of length 0, allowed: a vector of non-zero length; ");
  EXPECT_EQ(complaint({1, 0, 0}, {0, 0, 0}),
            "edge_b: found a vector of length 0, allowed: a vector of non-zero length; ");
  EXPECT_EQ(complaint({0.8660254, 0, 0.5}, {-0.5, 0, 0.8660254}), "");
}

}  // namespace
}  // namespace grit
