#include <gmock/gmock.h>

#include "box.hpp"
#include "grit/testing/geometry.hpp"

namespace grit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const Vec3 low(0, 0, 0), high(1, 2, 3);

std::shared_ptr<Box> container(std::vector<std::string> open = {}) {
  return made<Box>({{"low", low}, {"high", high}, {"open", std::move(open)}});
}
std::shared_ptr<Box> block() { return made<Box>({{"low", low}, {"high", high}, {"inside", false}}); }

std::vector<std::uint32_t> features(const Geometry& geometry, const Vec3& centre, double radius) {
  std::vector<std::uint32_t> result;
  for (const SurfaceContact& contact : contacts_of(geometry, centre, radius)) result.push_back(contact.feature);
  return result;
}

bool within(const Vec3& c) { return (c.array() >= low.array()).all() && (c.array() <= high.array()).all(); }

INSTANTIATE_TEST_SUITE_P(
    Box, GeometryContract,
    testing::Values(GeometryCase{.name = "container",
                                 .geometry = container(),
                                 .where = {low - Vec3::Constant(0.1), high + Vec3::Constant(0.1)},
                                 .radius = 0.4,
                                 .flanks = {{{0.5, 1, 0.2}, {0.55, 1.4, 0.3}}},
                                 .across = {{{0.5, 1, 1.5}, {0.05, 0.03, 0.02}}, {{0.05, 0.1, 0.1}, {0.1, 1.95, 0.05}}},
                                 .in_front = within},
                    GeometryCase{.name = "open_top",
                                 .geometry = container({"z_high"}),
                                 .where = {low - Vec3::Constant(0.3), high + Vec3::Constant(0.3)},
                                 .radius = 0.4,
                                 .flanks = {{{0.1, 1, 2}, {0.1, 1, 3.3}}},      // up a wall and past its rim
                                 .across = {{{0.2, 1, 2.5}, {0.1, 1, 3.5}},     // up past the rim
                                            {{0.5, 1, 3.2}, {-0.5, 1, 3.2}},    // over the rim
                                            {{0.1, 0.1, 2}, {0.1, 0.1, 3.5}}},  // up a corner
                                 .in_front = [](const Vec3& c) { return c.z() > high.z() || within(c); }},
                    GeometryCase{.name = "tube",
                                 .geometry = container({"x_low", "x_high"}),
                                 .where = {low - Vec3(0.3, 0, 0), high + Vec3(0.3, 0, 0)},
                                 .radius = 0.4,
                                 .across = {{{-0.5, 0.2, 0.3}, {1.5, 0.2, 0.1}}}},
                    GeometryCase{.name = "block",
                                 .geometry = block(),
                                 .where = {low - Vec3::Constant(0.5), high + Vec3::Constant(0.5)},
                                 .radius = 0.4,
                                 .flanks = {{{0.5, 1, 3.3}, {1.2, 1, 3.2}}},  // over a convex edge
                                 .across = {{{0.5, 1, 3.3}, {1.5, 1, 2.9}}, {{0.5, 0.5, 3.3}, {1.3, -0.3, 3.2}}},
                                 .in_front = [](const Vec3& c) { return !within(c); }}),
    case_name);

TEST(Box, ContainerHasOneContactPerFace) {
  const auto box = container();
  EXPECT_THAT(features(*box, {0.5, 1, 1.5}, 0.1), IsEmpty());
  EXPECT_THAT(features(*box, {0.09, 1, 1.5}, 0.1), ElementsAre(0));
  EXPECT_THAT(features(*box, {0.09, 1.91, 1.5}, 0.1), ElementsAre(0, 3));
  EXPECT_THAT(features(*box, {0.09, 1.91, 0.09}, 0.1), ElementsAre(0, 3, 4));
  EXPECT_THAT(features(*box, {0.5, 1, 1.5}, 0.6), ElementsAre(0, 1)) << "wider than the box";
  const auto contacts = contacts_of(*box, {0.91, 0.08, 2.93}, 0.1);
  ASSERT_EQ(contacts.size(), 3u);
  EXPECT_EQ(contacts[0].normal, Vec3(1, 0, 0));
  EXPECT_EQ(contacts[1].normal, Vec3(0, -1, 0));
  EXPECT_EQ(contacts[2].normal, Vec3(0, 0, 1));
  EXPECT_NEAR(contacts[0].overlap, 0.01, 1e-15);
  EXPECT_NEAR(contacts[1].overlap, 0.02, 1e-15);
  EXPECT_NEAR(contacts[2].overlap, 0.03, 1e-15);
}

TEST(Box, ContainerPushesBackACentreBehindItsFaces) {
  const auto contacts = contacts_of(*container(), {-0.02, -0.03, 1}, 0.1);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_EQ(contacts[0].normal, Vec3(-1, 0, 0));
  EXPECT_EQ(contacts[1].normal, Vec3(0, -1, 0));
  EXPECT_NEAR(contacts[0].overlap, 0.12, 1e-15);
  EXPECT_NEAR(contacts[1].overlap, 0.13, 1e-15);
  EXPECT_EQ(contacts_of(*container(), {-0.0999, 1, 1}, 0.1).size(), 1u);
  EXPECT_TRUE(contacts_of(*container(), {-0.1001, 1, 1}, 0.1).empty()) << "one radius behind";
}

TEST(Box, OpenFaceHasNoContactAndItsRimOnePerWall) {
  const auto cup = container({"z_high"});
  EXPECT_THAT(features(*cup, {0.5, 1, 2.95}, 0.1), IsEmpty());
  const auto rim = contacts_of(*cup, {0.03, 1, 3.04}, 0.1);
  ASSERT_EQ(rim.size(), 1u);
  EXPECT_NEAR((rim[0].normal - Vec3(-0.6, 0, -0.8)).norm(), 0, 1e-13);
  EXPECT_NEAR(rim[0].overlap, 0.05, 1e-15);
  EXPECT_THAT(features(*cup, {-0.03, 1, 3.04}, 0.1), ElementsAre(0)) << "from outside, over the rim";
  EXPECT_THAT(features(*cup, {0.03, 0.03, 3.04}, 0.1), ElementsAre(0, 2)) << "two rims in the corner";
  EXPECT_THAT(features(*cup, {-0.03, -0.03, 3.04}, 0.1), ElementsAre(0)) << "the corner that two rims share";
  EXPECT_THAT(features(*cup, {0.03, -0.03, 3.04}, 0.1), ElementsAre(2)) << "the rim that is closest where they meet";
  EXPECT_THAT(features(*cup, {0.5, 1, 3.11}, 0.1), IsEmpty());
  EXPECT_THAT(
      features(*made<Box>({{"low", low}, {"high", Vec3(1, 2, 0.02)}, {"open", std::vector<std::string>{"z_high"}}}),
               {0.05, 1, 0.09}, 0.1),
      ElementsAre(0, 4))
      << "a tray shallower than the grain";
}

TEST(Box, BlockHasOneContactAtItsClosestPoint) {
  const auto solid = block();
  const auto only = [&](const Vec3& centre) {
    const auto contacts = contacts_of(*solid, centre, 0.1);
    EXPECT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts.at(0).feature, 0u);
    return contacts.at(0);
  };
  EXPECT_EQ(only({0.5, 1, 3.09}).normal, Vec3(0, 0, -1));
  EXPECT_NEAR((only({1.03, 1, 3.04}).normal - Vec3(-0.6, 0, -0.8)).norm(), 0, 1e-13);
  EXPECT_NEAR(only({1.03, 1, 3.04}).overlap, 0.05, 1e-15);
  EXPECT_NEAR((only({1.02, 2.03, 3.06}).normal - Vec3(-2, -3, -6) / 7).norm(), 0, 1e-13);
  EXPECT_EQ(only({0.97, 1, 1}).normal, Vec3(-1, 0, 0)) << "pushed out by the nearest face";
  EXPECT_NEAR(only({0.97, 1, 1}).overlap, 0.13, 1e-15);
  EXPECT_NEAR(only({0.5, 1, 2.4}).overlap, 0.1 + 0.5, 1e-15) << "at any depth";
}

TEST(Box, TrianglesCoverClosedFacesAndFaceTheBodies) {
  const auto area = [](const Box& box, const Vec3& bodies) {
    double sum = 0;
    const auto t = box.triangles();
    for (std::size_t i = 0; i < t.size(); i += 3) {
      const Vec3 twice = (t[i + 1] - t[i]).cross(t[i + 2] - t[i]);
      sum += 0.5 * twice.norm();
      EXPECT_GT(twice.dot(bodies - t[i]), 0);
    }
    return sum;
  };
  EXPECT_NEAR(area(*container(), {0.5, 1, 1.5}), 22, 1e-13);
  EXPECT_NEAR(area(*container({"z_high", "x_low"}), {0.5, 1, 1.5}), 14, 1e-13);
  double outwards = 0;
  const auto t = block()->triangles();
  for (std::size_t i = 0; i < t.size(); i += 3) {
    outwards += (t[i + 1] - t[i]).cross(t[i + 2] - t[i]).dot(t[i]) / 6;
  }
  EXPECT_NEAR(outwards, 6, 1e-13) << "the volume that outward triangles enclose";
}

TEST(Box, RefusesInvalidBoxes) {
  const auto complaint = [](const std::vector<std::pair<std::string, Setting>>& settings) -> std::string {
    try {
      made<Box>(settings);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  using Faces = std::vector<std::string>;
  EXPECT_EQ(complaint({{"high", Vec3(1, 0, 1)}}),
            "high: found y = 0.000000 m, allowed: above that of low, 0.000000 m; ");
  EXPECT_EQ(complaint({{"open", Faces{"top"}}}),
            "open: found \"top\", allowed: x_low, x_high, y_low, y_high, z_low, z_high; ");
  EXPECT_EQ(complaint({{"open", Faces{"z_low", "z_low"}}}), "open: found \"z_low\" twice, allowed: each face once; ");
  EXPECT_EQ(complaint({{"open", Faces{"z_low"}}, {"inside", false}}),
            "open: found an open face of a solid block, allowed: open faces only where inside is true; ");
  EXPECT_EQ(complaint({{"open", Faces(Box::face_names.begin(), Box::face_names.end())}}),
            "open: found all six faces, allowed: at most five faces; ");
}

}  // namespace
}  // namespace grit
