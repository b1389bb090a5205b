// Bounds of the specimen, the region over which averages are taken.
#include <gtest/gtest.h>

#include <cmath>

#include "support/scene.hpp"

namespace grit::test::specimen_tests {
namespace {

Region specimen_between(const Description& low, const Description& high) {
  Description d = description("linear-frictional", {{"density", 2600}}, {{{0.5, 0.5, 0.5}, 0.1}});
  d["walls"]["container"] = {
      {"type", "box"}, {"low", {0, 0, 0}}, {"high", {1, 2, 3}}, {"inside", true}, {"material", "grain"}};
  d["walls"]["block"] = {
      {"type", "box"}, {"low", {0, 0, 2}}, {"high", {1, 2, 2.5}}, {"inside", false}, {"material", "grain"}};
  d["specimen"] = {{"low", low}, {"high", high}};
  return Started(scene_of(d)).kernel.world().specimen();
}

TEST(Specimen, EndsAtTheInnerFacesOfAContainer) {
  const Region region =
      specimen_between({"container", "container", "container"}, {"container", "container", "container"});
  EXPECT_EQ(region.low, Vec3(0, 0, 0));
  EXPECT_EQ(region.high, Vec3(1, 2, 3));
}

TEST(Specimen, EndsAtTheNearFaceOfABlock) {
  const Region below = specimen_between({"container", "container", "container"}, {"container", "container", "block"});
  EXPECT_EQ(below.high, Vec3(1, 2, 2));
  const Region above = specimen_between({"container", "container", "block"}, {"container", "container", "container"});
  EXPECT_EQ(above.low, Vec3(0, 0, 2.5));
}

/// A floor with grooves from z = 0 to −0.1, tips 0.4 apart and flat between; above it a sinusoidal surface from z = 1
/// to 0.8, a sheet with two sides, a hollow cone of 45°, and a solid block.
class Clearances : public testing::Test {
 protected:
  Clearances() {
    Description d = description("linear-frictional", {{"density", 2600}}, {{{2, 2, 4}, 0.1}});
    const auto sheet = [](const char* type, double z) {
      return Description{
          {"type", type}, {"corner", {0, 0, z}}, {"edge_a", {4, 0, 0}}, {"edge_b", {0, 4, 0}}, {"material", "grain"}};
    };
    d["walls"]["floor"] = sheet("saw-tooth", 0);
    d["walls"]["floor"].update({{"depth", 0.1}, {"spacing", 0.4}, {"floor", 0.2}});
    d["walls"]["wave"] = sheet("sinusoidal", 1);
    d["walls"]["wave"].update({{"depth", 0.2}, {"wavelength", 1}});
    d["walls"]["sheet"] = sheet("rectangle", 2);
    d["walls"]["cone"] = {{"type", "cone"},    {"start", {2, 2, 3}}, {"end", {2, 2, 5}},
                          {"start_radius", 0}, {"end_radius", 2},    {"material", "grain"}};
    d["walls"]["block"] = {
        {"type", "box"}, {"low", {0, 0, 6}}, {"high", {4, 4, 7}}, {"inside", false}, {"material", "grain"}};
    d["specimen"] = {{"low", {"", "", "floor"}}, {"high", {"", "", "block"}}};
    started_.emplace(scene_of(d));
    kernel_ = &started_->kernel;
  }
  /// From wall `name`, at a distance below 3.
  Clearance from(const std::string& name, const Vec3& point) const {
    const auto found = kernel_->world().clearance(index(name), point, 3);
    if (!found) throw Error("too far from " + name);
    EXPECT_NEAR(found->normal.norm(), 1, 1e-15);
    return *found;
  }
  std::size_t index(const std::string& name) const {
    for (std::size_t w = 0; w < kernel_->world().walls().size(); ++w)
      if (kernel_->world().walls()[w].name == name) return w;
    throw Error("no wall " + name);
  }
  void expect(const std::string& name, const Vec3& point, double distance, const Vec3& normal) const {
    const Clearance found = from(name, point);
    EXPECT_NEAR(found.distance, distance, 1e-12) << name << ", " << point.transpose();
    EXPECT_NEAR((found.normal - normal.normalized()).norm(), 0, 1e-12) << name << ", " << point.transpose();
  }
  std::optional<Started> started_;
  Kernel* kernel_ = nullptr;
};

TEST_F(Clearances, AreDistancesInFrontOfWalls) {
  const double slanted = std::sqrt(0.5);
  expect("floor", {2.2, 2, 0}, 0.1, {0, 0, -1});
  expect("floor", {2.0, 2, 0.3}, 0.3, {0, 0, -1});
  expect("wave", {2, 2, 1.5}, 0.5, {0, 0, -1});
  expect("wave", {2.5, 2, 1}, 0.2, {0, 0, -1});
  expect("sheet", {2, 2, 2.5}, 0.5, {0, 0, -1});
  expect("sheet", {2, 2, 1.5}, 0.5, {0, 0, 1});
  expect("cone", {2.1, 2, 4}, 0.9 * slanted, {1, 0, -1});
  expect("block", {2, 2, 5.5}, 0.5, {0, 0, 1});
}

TEST_F(Clearances, AreNegativeBehindWalls) {
  const double slanted = std::sqrt(0.5);
  expect("floor", {2.01, 2, -0.05}, -0.04 * slanted, {-1, 0, -1});
  expect("floor", {2.2, 2, -1}, -0.9, {0, 0, -1});
  expect("wave", {2.5, 2, 0.5}, -0.3, {0, 0, -1});
  expect("cone", {3.5, 2, 4}, -0.5 * slanted, {1, 0, -1});
  expect("block", {2, 2, 6.2}, -0.2, {0, 0, 1});
}

TEST_F(Clearances, AreOfTheRimAHairBesideIt) { expect("sheet", {4 + 1e-8, 2, 1.5}, 0.5, {-1e-8, 0, 0.5}); }

TEST_F(Clearances, AreNoneOutOfReach) {
  EXPECT_TRUE(kernel_->world().clearance(index("block"), {2, 2, 3.001}, 3));
  EXPECT_FALSE(kernel_->world().clearance(index("block"), {2, 2, 3}, 3));
}

TEST_F(Clearances, EnvelopeReachesToTheFarSidesOfWalls) {
  EXPECT_EQ(kernel_->world().specimen().low.z(), 0);
  EXPECT_EQ(kernel_->world().specimen().high.z(), 6);
  EXPECT_EQ(kernel_->world().envelope().low.z(), -0.1);
  EXPECT_EQ(kernel_->world().envelope().high.z(), 7);
}

}  // namespace
}  // namespace grit::test::specimen_tests
