// Clouds in a sphere, a cylinder or a mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "bodies/cloud.hpp"
#include "bodies/mesh_interior.hpp"
#include "grit/error.hpp"
#include "support/scene.hpp"
#include "support/stl_file.hpp"

namespace grit::test::cloud_regions_tests {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

const Cell open_cell{Vec3::Constant(-std::numeric_limits<double>::infinity()),
                     Vec3::Constant(std::numeric_limits<double>::infinity())};

CloudSource cloud(std::int64_t count, double diameter) {
  CloudSource source;
  source.count = count;
  source.sizes.choose("list");
  std::get<ListSizes>(source.sizes.value()).diameters = {diameter, 0.6 * diameter};
  return source;
}

template <class R>
R& region_of(CloudSource& source) {
  source.region.emplace().is.choose(R::type_name);
  return std::get<R>(source.region->is.value());
}

/// Two triangles for each side of a box.
std::vector<Vec3> box_of_triangles(const Vec3& low, const Vec3& high) {
  const auto corner = [&](int k) {
    return Vec3((k & 1) != 0 ? high.x() : low.x(), (k & 2) != 0 ? high.y() : low.y(),
                (k & 4) != 0 ? high.z() : low.z());
  };
  std::vector<Vec3> corners;
  for (const int k :
       {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
    corners.push_back(corner(k));
  return corners;
}

/// A prism of an L in the x-z plane: the square (0, 2) × (0, 2) without its upper right quarter; 0 to 1 along y.
std::vector<Vec3> l_of_triangles() {
  const std::vector<Vec3> outline{{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {1, 0, 1}, {1, 0, 2}, {0, 0, 2}};
  std::vector<Vec3> corners;
  const Vec3 up(0, 1, 0);
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec3 &a = outline[k], &b = outline[(k + 1) % outline.size()];
    for (const Vec3& corner : {a, Vec3(a + up), b, b, Vec3(a + up), Vec3(b + up)}) corners.push_back(corner);
  }
  for (const int k : {0, 1, 3, 1, 2, 3, 0, 3, 5, 3, 4, 5}) corners.push_back(outline[as_index(k)]);
  for (const int k : {3, 1, 0, 3, 2, 1, 5, 3, 0, 5, 4, 3}) corners.push_back(outline[as_index(k)] + up);
  return corners;
}

void expect_no_overlap(const std::vector<Row>& grains) {
  for (std::size_t i = 0; i < grains.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GE((xyz(grains[i]) - xyz(grains[j])).norm(), (grains[i].w + grains[j].w) * (1 - 1e-14));
}

TEST(CloudRegions, ABoxIsTheBoxOfLowAndHigh) {
  CloudSource by_corners = cloud(200, 0.1), by_region = cloud(200, 0.1);
  by_corners.low = Vec3(1, 2, 3), by_corners.high = Vec3(2, 3, 4);
  region_of<BoxRegion>(by_region).low = *by_corners.low;
  region_of<BoxRegion>(by_region) = {*by_corners.low, *by_corners.high};
  Random a(1), b(1);
  const auto first = make_cloud(by_corners, open_cell, a), second = make_cloud(by_region, open_cell, b);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) ASSERT_EQ(xyz(first[i]), xyz(second[i]));
}

TEST(CloudRegions, ASphereHoldsWholeBodies) {
  CloudSource source = cloud(300, 0.2);
  auto& sphere = region_of<SphereRegion>(source);
  sphere.centre = Vec3(1, 2, 3), sphere.radius = 1;
  Random random(1);
  const auto grains = make_cloud(source, open_cell, random);
  ASSERT_EQ(grains.size(), 300u);
  double furthest = 0;
  for (const Row& g : grains) furthest = std::max(furthest, (xyz(g) - sphere.centre).norm() + g.w);
  EXPECT_LE(furthest, 1);
  EXPECT_GT(furthest, 0.98);  // up to its surface
  expect_no_overlap(grains);
}

TEST(CloudRegions, ACylinderHoldsWholeBodies) {
  for (const Vec3& way : {Vec3(0, 0, 3), Vec3(0, -3, 0), Vec3(1, 2, 2)}) {
    CloudSource source = cloud(300, 0.2);
    auto& cylinder = region_of<CylinderRegion>(source);
    cylinder.start = Vec3(1, 2, 3), cylinder.end = cylinder.start + way, cylinder.radius = 0.7;
    Random random(1);
    const auto grains = make_cloud(source, open_cell, random);
    ASSERT_EQ(grains.size(), 300u);
    double furthest = 0, lowest = 3, highest = 0;
    for (const Row& g : grains) {
      const double along = (xyz(g) - cylinder.start).dot(way) / 3;
      furthest = std::max(furthest, (xyz(g) - cylinder.start - along * way / 3).norm() + g.w);
      lowest = std::min(lowest, along - g.w), highest = std::max(highest, along + g.w);
    }
    EXPECT_LE(furthest, 0.7 * (1 + 1e-14));
    EXPECT_GT(furthest, 0.68);
    EXPECT_GE(lowest, -1e-14);
    EXPECT_LE(highest, 3 * (1 + 1e-14));
    EXPECT_LT(lowest, 0.1);
    EXPECT_GT(highest, 2.9);
    expect_no_overlap(grains);
  }
}

TEST(CloudRegions, ACylinderContinuesAcrossPeriodicEnds) {
  const Cell cell{Vec3(-1, -1, 0), Vec3(1, 1, 2), {false, false, true}};
  CloudSource source = cloud(200, 0.2);
  auto& cylinder = region_of<CylinderRegion>(source);
  cylinder.start = Vec3::Zero(), cylinder.end = Vec3(0, 0, 2), cylinder.radius = 0.7;
  Random random(1);
  const auto grains = make_cloud(source, cell, random);
  int across = 0;
  for (const Row& g : grains) {
    across += g.z < g.w || g.z > 2 - g.w;
    for (const Row& other : grains) {
      const Vec3 image = xyz(other) + Vec3(0, 0, 2);
      ASSERT_GE((xyz(g) - image).norm(), (g.w + other.w) * (1 - 1e-14));
    }
  }
  EXPECT_GT(across, 5);
  cylinder.end.z() = 1.9;
  for (const Row& g : make_cloud(source, cell, random)) ASSERT_TRUE(g.z >= g.w && g.z <= 1.9 - g.w);
}

TEST(CloudRegions, CentresOfADiscAreInOnePlane) {
  CloudSource source = cloud(60, 0.1);
  source.plane_normal = "y";
  auto& cylinder = region_of<CylinderRegion>(source);
  cylinder.start = Vec3(0, 1, 0), cylinder.end = Vec3(0, 2, 0), cylinder.radius = 0.7;
  Random random(1);
  for (const Row& g : make_cloud(source, open_cell, random)) {
    EXPECT_EQ(g.y, 1.5);
    EXPECT_LE(std::hypot(g.x, g.z) + g.w, 0.7);
  }
}

TEST(CloudRegions, AMeshHoldsWholeBodies) {
  const StlFile file(stl_text(l_of_triangles()));
  CloudSource source = cloud(150, 0.25);
  auto& mesh = region_of<MeshRegion>(source);
  mesh.path = file.path(), mesh.scale = 0.5, mesh.position = Vec3(1, 1, 1);
  source.sizes.choose("list");
  std::get<ListSizes>(source.sizes.value()).diameters = {0.12, 0.06};
  Random random(1);
  const auto grains = make_cloud(source, open_cell, random);
  ASSERT_EQ(grains.size(), 150u);
  for (const Row& g : grains) {
    const Vec3 at = xyz(g) - mesh.position;
    EXPECT_GE(at.minCoeff(), g.w);
    EXPECT_TRUE(at.y() <= 0.5 - g.w && at.x() <= 1 - g.w && at.z() <= 1 - g.w);
    EXPECT_TRUE(at.x() <= 0.5 - g.w || at.z() <= 0.5 - g.w || std::hypot(0.5 - at.x(), 0.5 - at.z()) >= g.w);
  }
  expect_no_overlap(grains);
}

TEST(MeshInteriors, AreThoseOfTheirSolids) {
  struct Solid {
    std::vector<Vec3> corners;
    double volume;
    std::function<bool(const Vec3&)> holds;
  };
  const auto in_box = [](const Vec3& at) { return at.minCoeff() > 0 && at.maxCoeff() < 1; };
  std::vector<Vec3> hollow = box_of_triangles(Vec3::Zero(), Vec3::Ones());
  std::vector<Vec3> cavity = box_of_triangles(Vec3::Constant(0.25), Vec3::Constant(0.75));
  for (std::size_t k = 0; k < cavity.size(); k += 3) std::swap(cavity[k], cavity[k + 1]);
  hollow.insert(hollow.end(), cavity.begin(), cavity.end());
  std::vector<Vec3> inverted = box_of_triangles(Vec3::Zero(), Vec3::Ones());
  for (std::size_t k = 0; k < inverted.size(); k += 3) std::swap(inverted[k], inverted[k + 1]);
  const Solid solids[] = {
      {box_of_triangles(Vec3::Zero(), Vec3::Ones()), 1, in_box},
      {inverted, 1, in_box},
      {l_of_triangles(), 3,
       [](const Vec3& at) {
         return at.minCoeff() > 0 && at.y() < 1 && at.x() < 2 && at.z() < 2 && (at.x() < 1 || at.z() < 1);
       }},
      {hollow, 0.875,
       [&](const Vec3& at) { return in_box(at) && (at - Vec3::Constant(0.5)).cwiseAbs().maxCoeff() > 0.25; }}};
  for (const Solid& solid : solids)
    for (const bool binary : {false, true}) {
      const StlFile file(binary ? stl_binary(solid.corners) : stl_text(solid.corners));
      const MeshInterior inside({file.path(), 1, Vec3::Zero()});
      EXPECT_NEAR(inside.volume(), solid.volume, 1e-12);
      Random random(1);
      int within = 0;
      for (int k = 0; k < 20'000; ++k) {
        // Multiples of 1/8 meet corners, edges and planes of facets.
        Vec3 at(2.5 * random.uniform() - 0.25, 2.5 * random.uniform() - 0.25, 2.5 * random.uniform() - 0.25);
        if (k % 2 == 0) at = (8 * at).array().round() / 8 + 1.0 / 1024 * Vec3::UnitX().array();
        const bool wanted = solid.holds(at);
        const bool near = std::ranges::any_of(
            std::array{0, 1, 2}, [&](int axis) { return std::abs(4 * at[axis] - std::round(4 * at[axis])) == 0; });
        if (!near) {
          ASSERT_EQ(inside.holds(at, 1e-9), wanted) << at.transpose();
        } else if (inside.holds(at, 1e-9)) {
          ASSERT_TRUE(wanted) << at.transpose();
        }
        within += wanted;
      }
      EXPECT_GT(within, 500);
    }
}

TEST(MeshInteriors, KeepTheirDistance) {
  const std::array<Vec3, 3> triangle{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)};
  EXPECT_DOUBLE_EQ(distance_to_triangle({0.5, 0.5, 3}, triangle), 3);
  EXPECT_DOUBLE_EQ(distance_to_triangle({0.5, 0.5, -3}, triangle), 3);
  EXPECT_DOUBLE_EQ(distance_to_triangle({1, -2, 0}, triangle), 2);
  EXPECT_DOUBLE_EQ(distance_to_triangle({-3, -4, 0}, triangle), 5);
  EXPECT_DOUBLE_EQ(distance_to_triangle({2, 2, 0}, triangle), std::sqrt(2.0));
  const StlFile file(stl_text(box_of_triangles(Vec3::Zero(), Vec3::Ones())));
  const MeshInterior box({file.path(), 1, Vec3::Zero()});
  EXPECT_TRUE(box.holds({0.5, 0.5, 0.5}, 0.5));
  EXPECT_FALSE(box.holds({0.5, 0.5, 0.5}, 0.5 + 1e-12));
  EXPECT_TRUE(box.holds({0.25, 0.3, 0.7}, 0.25));
  EXPECT_FALSE(box.holds({0.25, 0.3, 0.7}, 0.26));
}

std::string message(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(CloudRegions, ReportWhatDoesNotFit) {
  Random random(1);
  CloudSource source = cloud(5000, 0.2);
  auto& sphere = region_of<SphereRegion>(source);
  sphere.radius = 1;
  EXPECT_THAT(
      message([&] { make_cloud(source, open_cell, random); }),
      ContainsRegex("cloud: only [0-9]+ of 5000 grains fit into the sphere in the box \\(-1 -1 -1\\) … \\(1 1 1\\) "
                    "m: solid fraction 0\\.[2-4][0-9]+, .*use a larger sphere, or fewer or smaller grains"));
  source = cloud(1, 2.1);
  region_of<SphereRegion>(source).radius = 1;
  EXPECT_THAT(
      message([&] { make_cloud(source, open_cell, random); }),
      HasSubstr("a grain of diameter 2.1 m does not fit into the sphere in the box (-1 -1 -1) … (1 1 1) m; use a "
                "larger sphere or smaller grains"));
  // Too large for an inclined cylinder, not for the box around it.
  source = cloud(1, 0.3);
  region_of<CylinderRegion>(source) = {Vec3::Zero(), Vec3(1, 1, 0), 0.1};
  EXPECT_THAT(message([&] { make_cloud(source, open_cell, random); }), HasSubstr("does not fit into the cylinder"));
  const Cell cell{Vec3::Constant(-1), Vec3::Constant(1), {true, true, true}};
  region_of<SphereRegion>(source) = {Vec3(0.5, 0, 0), 0.9};
  EXPECT_THAT(message([&] { make_cloud(source, cell, random); }), HasSubstr("leaves the periodic cell"));
}

TEST(CloudRegions, ReportMeshesThatAreNotClosed) {
  std::vector<Vec3> corners = box_of_triangles(Vec3::Zero(), Vec3::Ones());
  corners.resize(corners.size() - 3);
  const StlFile open(stl_text(corners)), empty("solid\nendsolid\n");
  CloudSource source = cloud(1, 0.1);
  region_of<MeshRegion>(source) = {open.path(), 1, Vec3::Zero()};
  EXPECT_THAT(
      message([&] { check_region(source); }),
      testing::StartsWith("region/path: found " + open.path() + ": a surface that is not closed, with 3 edges "));
  region_of<MeshRegion>(source) = {empty.path(), 1, Vec3::Zero()};
  EXPECT_EQ(message([&] { check_region(source); }),
            "region/path: found " + empty.path() + ": a file without facets; allowed is at least one facet");
  region_of<MeshRegion>(source) = {"/nowhere/a.stl", 1, Vec3::Zero()};
  EXPECT_THAT(message([&] { check_region(source); }), HasSubstr("cannot be read: No such file"));
}

Description scene_of_cloud(const Description& source) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, {});
  Description& cloud = d["bodies"]["grains"]["source"];
  cloud = {{"type", "cloud"}, {"count", 5}, {"sizes", {{"type", "list"}, {"diameters", {0.1}}}}};
  cloud.update(source);
  return d;
}

TEST(CloudRegions, OfADescriptionAreChecked) {
  const auto refusal = [](const Description& source) {
    return message([&] { LiveScene(scene_of(scene_of_cloud(source))); });
  };
  const std::string at = "/bodies/grains/source/";
  const Description sphere{{"type", "sphere"}, {"centre", {0, 0, 0}}, {"radius", 1}};
  EXPECT_EQ(refusal({{"region", sphere}}), "");
  EXPECT_THAT(
      refusal(Description::object()),
      HasSubstr("/bodies/grains/source: found neither a box nor a region; allowed is low and high, or a region"));
  EXPECT_THAT(refusal({{"low", {0, 0, 0}}}),
              HasSubstr("/bodies/grains/source: found one corner of a box; allowed is low and high, or a region"));
  EXPECT_THAT(refusal({{"low", {0, 0, 0}}, {"high", {1, 1, 0}}}), HasSubstr(at + "high/2: found high not above low"));
  EXPECT_THAT(refusal({{"low", {0, 0, 0}}, {"high", {1, 1, 1}}, {"region", sphere}}),
              HasSubstr(at + "region: found a region and a box; allowed is a region, or low and high"));
  EXPECT_THAT(refusal({{"region", {{"type", "cone"}}}}),
              HasSubstr(at + "region/type: unknown region \"cone\"; allowed are box, sphere, cylinder, mesh"));
}

TEST(CloudRegions, ReachTheBodies) {
  const Trial trial(scene_of_cloud({{"region", {{"type", "sphere"}, {"centre", {1, 2, 3}}, {"radius", 0.3}}}}));
  ASSERT_EQ(trial.world().ids().size(), 5u);
  for (const Row& x : trial.world().positions()) EXPECT_LE((xyz(x) - Vec3(1, 2, 3)).norm(), 0.25);
}

/// A mesh of a group that appears later is read at the start, too.
TEST(CloudRegions, OfALaterStageAreReadAtOnce) {
  Description d = scene_of_cloud({{"region", {{"type", "mesh"}, {"path", "/nowhere/a.stl"}, {"scale", 1}}}});
  d["bodies"]["grains"]["stage"] = "only";
  EXPECT_THAT(message([&] { Trial trial(d); }), HasSubstr("/nowhere/a.stl"));
}

}  // namespace
}  // namespace grit::test::cloud_regions_tests
