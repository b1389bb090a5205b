#include <gmock/gmock.h>

#include <numbers>

#include "grit/testing/geometry.hpp"
#include "mesh.hpp"
#include "support/stl_file.hpp"

namespace grit {
namespace {

using test::StlFile;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Corners = std::vector<Vec3>;
using Settings = std::vector<std::pair<std::string, Setting>>;

constexpr double degree = std::numbers::pi / 180;

std::shared_ptr<Mesh> mesh(const Corners& corners, const Settings& more = {}) {
  const StlFile file(test::stl_text(corners));
  Settings settings{{"path", file.path()}, {"scale", 1.0}};
  settings.insert(settings.end(), more.begin(), more.end());
  return made<Mesh>(settings);
}

std::string complaint(const Corners& corners, const Settings& more = {}) {
  try {
    mesh(corners, more);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void add_quad(Corners& corners, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  for (const Vec3& corner : {a, b, c, a, c, d}) corners.push_back(corner);
}

/// The faces of a box, facing outwards; the last two are its bottom and its top.
Corners box(const Vec3& low, const Vec3& high) {
  const auto at = [&](int x, int y, int z) {
    return Vec3((x ? high : low).x(), (y ? high : low).y(), (z ? high : low).z());
  };
  Corners corners;
  add_quad(corners, at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
  add_quad(corners, at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  add_quad(corners, at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
  add_quad(corners, at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0));
  add_quad(corners, at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0));
  add_quad(corners, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  return corners;
}
/// Each corner moved by up to 1e-7 along each axis.
Corners jittered(Corners corners) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto k = static_cast<double>(i);
    corners[i] += 1e-7 * Vec3(std::sin(k), std::cos(3 * k), std::sin(7 * k));
  }
  return corners;
}
const Vec3 low(0, 0, 0), high(1, 2, 3);
bool within(const Vec3& c) { return (c.array() >= low.array()).all() && (c.array() <= high.array()).all(); }
Corners without_top() {
  Corners corners = box(low, high);
  corners.resize(30);
  return corners;
}

/// A sheet over [0, 2] × [0, 1] whose height varies along x, in straight parts of 0.1 m.
constexpr double heights[] = {0,     0.02, 0.1,  0.03, 0,    0, 0,   0.15, 0.2,  0.12, 0,
                              -0.05, 0,    0.02, 0.03, 0.02, 0, 0.1, 0,    0.05, 0};
double height(double x) {
  const int i = std::clamp(static_cast<int>(x / 0.1), 0, 19);
  return heights[i] + (x / 0.1 - i) * (heights[i + 1] - heights[i]);
}
Corners hills() {
  Corners corners;
  const auto at = [&](int i, int j) { return Vec3(0.1 * i, 0.25 * j, heights[i]); };
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 4; ++j) add_quad(corners, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return corners;
}

/// n flat strips about the z axis, facing outwards, from z = −1 to 1; their corners at radius 1.
Corners pipe(int n) {
  Corners corners;
  const auto at = [&](int i, double z) {
    const double angle = 2 * std::numbers::pi * (i % n) / n;
    return Vec3(std::cos(angle), std::sin(angle), z);
  };
  for (int i = 0; i < n; ++i) add_quad(corners, at(i, -1), at(i + 1, -1), at(i + 1, 1), at(i, 1));
  return corners;
}

Corners turned(Corners corners, const Mat3& turn, const Vec3& shift) {
  for (Vec3& corner : corners) corner = turn * corner + shift;
  return corners;
}
const Mat3 askew = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();

INSTANTIATE_TEST_SUITE_P(
    Mesh, GeometryContract,
    testing::Values(GeometryCase{.name = "block",
                                 .geometry = mesh(box(low, high)),
                                 .where = {low - Vec3::Constant(0.5), high + Vec3::Constant(0.5)},
                                 .radius = 0.4,
                                 .flanks = {{{0.6, 0.5, 3.3}, {0.7, 0.5, 3.2}},   // on a facet
                                            {{1.1, 0.5, 3.2}, {1.2, 1.5, 3.1}},   // along an edge
                                            {{1.1, 2.2, 3.1}, {1.2, 2.1, 3.2}}},  // at a corner
                                 .across = {{{0.5, 1, 3.3}, {1.5, 1, 2.9}},
                                            {{0.5, 0.5, 3.3}, {1.3, -0.3, 3.2}},
                                            {{0.1, 1.9, 3.39}, {0.9, 0.1, 3.3}}},
                                 .hands_on = true,
                                 .in_front = [](const Vec3& c) { return !within(c); }},
                    GeometryCase{.name = "container",
                                 .geometry = mesh(box(low, high), {{"inside", true}}),
                                 .where = {low - Vec3::Constant(0.1), high + Vec3::Constant(0.1)},
                                 .radius = 0.4,
                                 .flanks = {{{0.5, 0.6, 0.2}, {0.55, 0.7, 0.3}}},
                                 .across = {{{0.5, 1, 1.5}, {0.05, 0.03, 0.02}}, {{0.05, 0.1, 0.1}, {0.1, 1.95, 0.05}}},
                                 .hands_on = true,
                                 .in_front = within},
                    GeometryCase{.name = "open_top",
                                 .geometry = mesh(without_top(), {{"inside", true}, {"open", true}}),
                                 .where = {low + Vec3(0.02, 0.02, 0.02), high + Vec3(-0.02, -0.02, 0.3)},
                                 .radius = 0.4,
                                 .flanks = {{{0.1, 1, 3.1}, {0.1, 1.2, 3.3}}},  // along the rim
                                 .across = {{{0.2, 1, 2.5}, {0.1, 1, 3.5}},     // up past the rim
                                            {{0.5, 1, 3.2}, {-0.5, 1, 3.2}},    // over the rim
                                            {{0.1, 0.1, 2}, {0.1, 0.1, 3.5}}},  // up a corner
                                 .hands_on = true},
                    GeometryCase{.name = "hills",
                                 .geometry = mesh(hills(), {{"open", true}}),
                                 .where = {{0, 0, -0.05}, {2, 1, 0.3}},
                                 .radius = 0.08,
                                 .flanks = {{{0.46, 0.3, 0.07}, {0.49, 0.3, 0.07}}},
                                 .across = {{{0.35, 0.1, 0.09}, {0.65, 0.9, 0.09}},   // over flat seams
                                            {{0.7, 0.5, 0.28}, {0.95, 0.55, 0.23}}},  // over a hill
                                 .hands_on = true,
                                 .in_front = [](const Vec3& c) { return c.z() >= height(c.x()); }},
                    GeometryCase{
                        .name = "two_sided",
                        .geometry = mesh(hills(), {{"open", true}, {"two_sided", true}}),
                        .where = {{-0.1, -0.1, -0.2}, {2.1, 1.1, 0.3}},
                        .radius = 0.08,
                        .flanks = {{{0.46, 0.3, -0.07}, {0.49, 0.3, -0.07}}},
                        .across = {{{0.45, 0.1, -0.09}, {0.55, 0.9, -0.07}}, {{1.9, 0.5, 0.09}, {2.1, 0.5, 0.02}}},
                        .hands_on = true},
                    GeometryCase{.name = "turned_in_millimetres",
                                 .geometry = mesh(turned(box(1e3 * low, 1e3 * high), askew, {1e3, 2e3, 3e3}),
                                                  {{"scale", 1e-3}, {"position", Vec3(-1, -2, -3)}}),
                                 .where = {low - Vec3::Constant(1.5), high + Vec3::Constant(0.5)},
                                 .radius = 0.3,
                                 .in_front = [](const Vec3& c) { return !within(askew.transpose() * c); }}),
    case_name);

TEST(Mesh, IsScaledThenTurnedThenShifted) {
  const Vec3 stretch(2, 1, 0.5), axis = Vec3(1, 2, 3).normalized(), position(-1, -2, 5);
  const double angle = 2.5;  // normals of the file point the other way
  const Mat3 turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  Corners in_metres = hills();
  for (Vec3& corner : in_metres) corner = turn * corner.cwiseProduct(stretch) + position;
  Corners in_millimetres = hills();
  for (Vec3& corner : in_millimetres) corner *= 1e3;
  const auto plain = mesh(in_metres, {{"open", true}}),
             placed = mesh(in_millimetres, {{"open", true},
                                            {"scale", 1e-3},
                                            {"stretch", stretch},
                                            {"orientation", Vec3(angle * axis)},
                                            {"position", position}});
  const auto one = plain->triangles(), other = placed->triangles();
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_LE((one[i] - other[i]).norm(), 1e-14);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> draw(0, 1);
  int touching = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 over(4 * draw(random), draw(random), 0.2 * draw(random)), centre = turn * over + position;
    const auto expected = contacts_of(*plain, centre, 0.1), found = contacts_of(*placed, centre, 0.1);
    ASSERT_EQ(expected.size(), found.size());
    for (std::size_t i = 0; i < found.size(); ++i, ++touching) {
      EXPECT_EQ(expected[i].feature, found[i].feature);
      EXPECT_NEAR(expected[i].overlap, found[i].overlap, 1e-14);
      EXPECT_LE((expected[i].normal - found[i].normal).norm(), 1e-12);
    }
  }
  EXPECT_GT(touching, 100);
}

TEST(Mesh, RefusesScalesThatAreNotPositive) {
  Mesh mesh;
  Parameters parameters;
  mesh.declare(parameters);
  for (const Parameter& one : parameters.entries())
    if (one.name() == "scale" || one.name() == "stretch") {
      EXPECT_FALSE(one.allows(0)) << one.name();
      EXPECT_FALSE(one.allows(-1)) << one.name();
      EXPECT_TRUE(one.allows(1e-3)) << one.name();
    }
}

TEST(Mesh, EachFaceOfACornerHasOneContact) {
  const auto contacts = contacts_of(*mesh(box(low, high), {{"inside", true}}), {0.91, 0.08, 2.93}, 0.1);
  ASSERT_EQ(contacts.size(), 3u);
  std::vector<double> overlaps;
  for (const SurfaceContact& contact : contacts) {
    EXPECT_EQ(contact.normal.lpNorm<1>(), 1);
    overlaps.push_back(contact.overlap);
  }
  EXPECT_THAT(overlaps,
              testing::UnorderedElementsAre(testing::DoubleNear(0.01, 1e-15), testing::DoubleNear(0.02, 1e-15),
                                            testing::DoubleNear(0.03, 1e-15)));
}

TEST(Mesh, ConvexEdgesAndCornersHaveTheirOwnContact) {
  const auto block = mesh(box(low, high));
  const auto edge = contacts_of(*block, high + Vec3(0.03, -1, 0.04), 0.06);
  ASSERT_EQ(edge.size(), 1u);
  EXPECT_LE((edge[0].normal - Vec3(-0.6, 0, -0.8)).norm(), 1e-14);
  EXPECT_NEAR(edge[0].overlap, 0.01, 1e-15);
  const auto corner = contacts_of(*block, high + Vec3(0.02, 0.03, 0.06), 0.08);
  ASSERT_EQ(corner.size(), 1u);
  EXPECT_LE((corner[0].normal - Vec3(-2, -3, -6) / 7).norm(), 1e-14);
  EXPECT_NEAR(corner[0].overlap, 0.01, 1e-15);
}

TEST(Mesh, AroundAConvexEdgeTheOverlapStaysAndTheNormalRotates) {
  const auto block = mesh(box(low, high));
  const Vec3 edge(1, 0.7, 3);
  for (int i = -20; i <= 120; ++i) {
    const double angle = std::clamp(i, 0, 100) * 0.9 * degree;
    const Vec3 away(std::sin(angle), 0, std::cos(angle));
    const Vec3 along = i < 0 ? Vec3(0.01 * i, 0, 0) : i > 100 ? Vec3(0, 0, -0.01 * (i - 100)) : Vec3(0, 0, 0);
    const auto contacts = contacts_of(*block, edge + along + 0.39 * away, 0.4);
    ASSERT_EQ(contacts.size(), 1u) << i;
    EXPECT_NEAR(contacts[0].overlap, 0.01, 2e-15);
    EXPECT_LE((contacts[0].normal + away).norm(), 2e-15);
  }
}

TEST(Mesh, ACentreOverASeamHasOneContact) {
  // A flat fan of unequal triangles about the origin, rotated so that coordinates are rounded.
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 3 + trial % 6;
    const Mat3 turn = Eigen::AngleAxisd(3 * draw(random), Vec3(draw(random), draw(random), draw(random)).normalized())
                          .toRotationMatrix();
    const Vec3 shift(draw(random), draw(random), draw(random));
    Corners corners;
    const auto at = [&](int i) {
      const double angle = 2 * std::numbers::pi * (i % n) / n;
      return Vec3((1 + i % n) * std::cos(angle), (1 + i % n) * std::sin(angle), 0);
    };
    for (int i = 0; i < n; ++i) corners.insert(corners.end(), {Vec3::Zero(), at(i), at(i + 1)});
    const auto fan = mesh(turned(corners, turn, shift), {{"open", true}, {"feature_angle", 0.0}});
    for (const Vec3& over : {Vec3(0, 0, 0), Vec3(0.3 * at(1)), Vec3(1e-16, -2e-16, 0), Vec3(1e-13, 1e-13, 0)}) {
      const auto contacts = contacts_of(*fan, turn * (over + Vec3(0, 0, 0.09)) + shift, 0.1);
      ASSERT_EQ(contacts.size(), 1u) << "trial " << trial;
      EXPECT_NEAR(contacts[0].overlap, 0.01, 1e-14);
      EXPECT_LE((contacts[0].normal + turn.col(2)).norm(), 1e-11);
    }
  }
}

TEST(Mesh, PushesBackACentreUpToOneRadiusBehind) {
  const auto block = mesh(box(low, high));
  const auto inside = contacts_of(*block, {0.5, 1, 2.92}, 0.1);
  ASSERT_EQ(inside.size(), 1u);
  EXPECT_EQ(inside[0].normal, Vec3(0, 0, -1));
  EXPECT_NEAR(inside[0].overlap, 0.18, 1e-15);
  EXPECT_THAT(contacts_of(*block, {0.5, 1, 2.89}, 0.1), IsEmpty());
  const auto under_an_edge = contacts_of(*block, {0.95, 1, 2.96}, 0.1);
  ASSERT_EQ(under_an_edge.size(), 1u) << "by the nearest face";
  EXPECT_EQ(under_an_edge[0].normal, Vec3(0, 0, -1));
  const auto past_an_edge = contacts_of(*mesh(box(low, high), {{"inside", true}}), {-0.03, 1, -0.04}, 0.1);
  ASSERT_EQ(past_an_edge.size(), 1u);
  EXPECT_LE((past_an_edge[0].normal - Vec3(-0.6, 0, -0.8)).norm(), 1e-14);
  EXPECT_NEAR(past_an_edge[0].overlap, 0.15, 1e-15);
}

TEST(Mesh, AThinPlateHasOneContactOnTheSideOfTheCentre) {
  const auto plate = mesh(box({0, 0, 0}, {1, 1, 0.01}));
  for (const double side : {-1.0, 1.0}) {
    const auto contacts = contacts_of(*plate, {0.5, 0.4, 0.005 + side * 0.09}, 0.1);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].normal, Vec3(0, 0, -side));
    EXPECT_NEAR(contacts[0].overlap, 0.015, 1e-15);
  }
  EXPECT_THAT(contacts_of(*plate, {1.05, 0.4, 0.005}, 0.1), SizeIs(1)) << "its narrow side, not its four edges";
}

TEST(Mesh, ASharpValleyKeepsBothFacesAShallowOneTheDeeper) {
  const double radius = 0.3;
  for (const int n : {8, 12, 23}) {
    const auto tube = mesh(pipe(n), {{"open", true}, {"inside", true}});
    EXPECT_THAT(contacts_of(*tube, {0.71, 0, 0.1}, radius), SizeIs(2)) << n;
  }
  for (const int n : {25, 60, 1000}) {
    const auto tube = mesh(pipe(n), {{"open", true}, {"inside", true}}),
               unlike = mesh(pipe(n), {{"open", true}, {"inside", true}, {"feature_angle", 0.0}});
    for (const double turn : {0.0, 0.3, 0.5, 0.9}) {
      const double angle = turn * 2 * std::numbers::pi / n;
      const Vec3 centre = 0.71 * Vec3(std::cos(angle), std::sin(angle), 0) + Vec3(0, 0, 0.1);
      const auto contacts = contacts_of(*tube, centre, radius);
      ASSERT_EQ(contacts.size(), 1u) << n;
      double deepest = 0;
      for (const SurfaceContact& contact : contacts_of(*unlike, centre, radius))
        deepest = std::max(deepest, contact.overlap);
      EXPECT_EQ(contacts[0].overlap, deepest);
    }
    EXPECT_THAT(contacts_of(*unlike, {0.71, 0, 0.1}, radius), SizeIs(testing::Ge(2))) << n;
  }
}

TEST(Mesh, OneCurvedSurfaceHasContactsOnOppositeSides) {
  Corners oval = pipe(60);
  for (Vec3& corner : oval) corner.x() *= 3;
  const auto contacts = contacts_of(*mesh(oval, {{"open", true}, {"inside", true}}), {0, 0, 0.1}, 1.01);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_LE((contacts[0].normal + contacts[1].normal).norm(), 1e-14);
}

TEST(Mesh, TestsAsFewFacetsOnALargeSurfaceAsOnASmallOne) {
  const auto counted = [](int n) {
    Corners corners;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        add_quad(corners, Vec3(i, j, 0), Vec3(i + 1, j, 0), Vec3(i + 1, j + 1, 0), Vec3(i, j + 1, 0));
    const StlFile file(test::stl_text(corners));
    const Surface surface(read_stl(file.path()), {.open = true});
    std::vector<std::uint32_t> facets;
    surface.facets_near({2.4, 2.5, 0.1}, 0.3, facets);
    return facets.size();
  };
  EXPECT_EQ(counted(5), 2u);
  EXPECT_EQ(counted(100), 2u);
}

TEST(Mesh, FeaturesIdentifyTheFacet) {
  const auto sheet = mesh(hills(), {{"open", true}});
  const Corners corners = sheet->triangles();
  for (const double y : {0.05, 0.2, 0.4, 0.6, 0.9}) {
    const auto contacts = contacts_of(*sheet, {0.47, y, 0.07}, 0.08);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_EQ(contacts[0].feature % 7, 0u);
    EXPECT_EQ(sheet->triangle_of(contacts[0].feature + 6), contacts[0].feature / 7) << "of its corners, too";
    const std::size_t first = 3 * std::size_t{*sheet->triangle_of(contacts[0].feature)};
    const Vec3 below(0.47, y, 0);
    EXPECT_LE((closest_on_triangle(below, corners[first], corners[first + 1], corners[first + 2]) - below).norm(),
              1e-15);
  }
}

TEST(Mesh, GivesAreaNormalAndBounds) {
  const auto closed = mesh(box(low, high));
  EXPECT_EQ(closed->area(), 0);
  EXPECT_EQ(closed->normal(), Vec3::Zero());
  EXPECT_EQ(closed->bounds().low, low);
  EXPECT_EQ(closed->bounds().high, high);
  EXPECT_FALSE(closed->hollow());
  const auto cup = mesh(without_top(), {{"inside", true}, {"open", true}});
  EXPECT_NEAR(cup->area(), 2, 1e-14) << "of its floor: pressures on the walls balance";
  EXPECT_LE((cup->normal() - Vec3::UnitZ()).norm(), 1e-15);
  EXPECT_TRUE(cup->hollow());
  const auto tube = mesh(pipe(64), {{"open", true}, {"inside", true}});
  EXPECT_EQ(tube->area(), 0) << "despite rounding";
  EXPECT_EQ(tube->normal(), Vec3::Zero());
  EXPECT_NEAR(mesh(hills(), {{"open", true}})->area(), 2, 1e-14) << "of a flat sheet";
}

TEST(Mesh, RefusesARimUnlessOpen) {
  EXPECT_THAT(
      complaint(without_top()),
      HasSubstr(
          "path: found an open surface: 4 edges with one facet only, the first from (0, 0, 3) to (0, 2, 3) m, "
          "of facets 1, 4, 6, 7; allowed is a closed surface; close it (no \"merge_distance\" does), or set \"open\": "
          "true if it is a sheet"));
  EXPECT_EQ(complaint(without_top(), {{"open", true}}), "");
}

/// Whether a seam is refused with `open`, with and without `two_sided`.
bool both_refuse_a_seam(const Corners& corners) {
  const std::string why = "edges with one facet only that lie on other facets, where a body would have two contacts";
  const auto refused = [&](const Settings& more) { return complaint(corners, more).find(why) != std::string::npos; };
  return refused({{"open", true}}) && refused({{"open", true}, {"two_sided", true}});
}
bool both_accept(const Corners& corners) {
  return complaint(corners, {{"open", true}}).empty() &&
         complaint(corners, {{"open", true}, {"two_sided", true}}).empty();
}
Corners joined(Corners corners, const Corners& more) {
  corners.insert(corners.end(), more.begin(), more.end());
  return corners;
}
Corners quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Corners corners;
  add_quad(corners, a, b, c, d);
  return corners;
}

TEST(Mesh, RefusesAFacetThatEndsOnTheMiddleOfAnotherEvenIfOpen) {
  const Corners junction{{0, 0, 0}, {1, 0, 0},     {1, 1, 0}, {0, 0, 0}, {0.5, 0.5, 0},
                         {0, 1, 0}, {0.5, 0.5, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(complaint(junction, {{"open", true}}),
            "path: found edges with one facet only that lie on other facets, where a body would have two contacts: the "
            "first of facet 1 on facet 2, from (0, 0, 0) to (0.5, 0.5, 0) m, 0 m apart; of facets 1, 2, 3; allowed is "
            "facets that share their common edges; split facets in the file at corners of others that lie on them");
  EXPECT_TRUE(both_refuse_a_seam(junction));
  EXPECT_TRUE(both_refuse_a_seam(turned(junction, askew, {3, 4, 5})));
  Corners near = junction;
  near[4] = near[6] = Vec3(0.5, 0.5 + 4e-6, 3e-6);
  EXPECT_TRUE(both_refuse_a_seam(near)) << "rounding to six digits";
  near[4] = near[6] = Vec3(0.5, 0.52, 0);
  EXPECT_TRUE(both_accept(near)) << "a notch";
  const auto apart = [](double gap) {
    return joined(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
                  quad({0, 1 + gap, 0}, {1, 1 + gap, 0}, {1, 2, 0}, {0, 2, 0}));
  };
  EXPECT_TRUE(both_refuse_a_seam(apart(1e-5)));
  EXPECT_TRUE(both_accept(apart(3e-5))) << "a gap";
  EXPECT_TRUE(both_refuse_a_seam(joined(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
                                        quad({0.3, 1, 0}, {1.3, 1, 0}, {1.3, 2, 0}, {0.3, 2, 0}))))
      << "staggered";
  EXPECT_TRUE(both_refuse_a_seam(joined(quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}),
                                        quad({0.3, 0.8, 0}, {1.3, 0.8, 0}, {1.3, 2, 0}, {0.3, 2, 0}))))
      << "overlapping";
}

TEST(Mesh, RefusesCornersThatAreNotMergedEvenIfOpen) {
  const Corners apart{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1e-9, 0, 0}, {1, 1 + 1e-9, 0}, {0, 1, 0}};
  EXPECT_THAT(complaint(apart, {{"open", true}}),
              HasSubstr("two contacts: the first of facet 1 on facet 2, from (5e-10, 5e-10, 0) to (1, 1, 0) m, 1e-09 m "
                        "apart; of facets 1, 2; allowed is facets that share their common edges; set "
                        "\"merge_distance\" to 1.1e-09 m or more, to merge corners"));
  EXPECT_TRUE(both_refuse_a_seam(apart));
  EXPECT_EQ(complaint(apart, {{"open", true}, {"merge_distance", 1.1e-9}}), "");

  Corners crack{{0, 0, 0}, {1, 0, 0},  {0, 1, 0},  {0, 0, 0}, {0, 1, 0},  {-1, 0, 0},
                {0, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 0}, {0, -1, 0}, {1, 1e-9, 0}};
  EXPECT_TRUE(both_refuse_a_seam(crack)) << "one corner is shared";
}

TEST(Mesh, RefusesSeamsThatAreNotSharpValleys) {
  // Two sheets that meet at an angle along their edges; the second is shorter.
  const auto bent = [](double angle) {
    const Vec3 on(std::cos(angle * degree), 0, std::sin(angle * degree));
    return joined(quad({-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}),
                  quad({0, 0.1, 0}, Vec3(0, 0.1, 0) + on, Vec3(0, 0.9, 0) + on, {0, 0.9, 0}));
  };
  for (const double angle : {-90, -30, -1, 0, 1, 14}) EXPECT_TRUE(both_refuse_a_seam(bent(angle))) << angle;
  for (const double angle : {16, 45, 90, 120}) {
    EXPECT_EQ(complaint(bent(angle), {{"open", true}}), "") << angle << ", a valley";
    EXPECT_THAT(complaint(bent(angle), {{"open", true}, {"two_sided", true}}), HasSubstr("two contacts")) << angle;
  }
  EXPECT_THAT(complaint(bent(45), {{"open", true}, {"feature_angle", 50 * degree}}), HasSubstr("two contacts"));
  const auto valley = mesh(bent(90), {{"open", true}});
  EXPECT_THAT(contacts_of(*valley, {-0.099, 0.5, 0.09}, 0.1), SizeIs(2));
  EXPECT_THAT(contacts_of(*valley, {-0.099, 0.5, 0.11}, 0.1), SizeIs(1));
}

TEST(Mesh, AcceptsABaffleThatStandsOnAWall) {
  const Corners wall = quad({0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0});
  const Corners baffle = quad({0.3, 0.5, 0}, {0.3, 1.2, 0}, {0.3, 1.2, 1}, {0.3, 0.5, 1});
  EXPECT_TRUE(both_accept(joined(wall, baffle)));
  EXPECT_TRUE(both_accept(turned(joined(wall, baffle), askew, {3, 4, 5})));
  const auto tee = mesh(joined(wall, baffle), {{"open", true}, {"two_sided", true}});
  for (const double x : {0.201, 0.399}) {
    EXPECT_THAT(contacts_of(*tee, {x, 0.9, 0.099}, 0.1), SizeIs(2)) << "each face once";
    EXPECT_THAT(contacts_of(*tee, {x + (x - 0.3), 0.9, 0.099}, 0.1), SizeIs(1));
  }
  EXPECT_TRUE(both_accept(joined(wall, quad({0.5, 0.5, 0}, {1.5, 1.5, 0}, {1.5, 1.5, 1}, {0.5, 0.5, 1}))))
      << "on an edge of two facets";
  const Corners behind = quad({0.3, 0.5, 0}, {0.3, 1.2, 0}, {0.3, 1.2, -1}, {0.3, 0.5, -1});
  EXPECT_THAT(complaint(joined(wall, behind), {{"open", true}}), HasSubstr("two contacts"))
      << "a contact with its edge";
  EXPECT_EQ(complaint(joined(wall, behind), {{"open", true}, {"two_sided", true}}), "");
  EXPECT_TRUE(both_refuse_a_seam(joined(wall, quad({0.3, 0.5, 0}, {0.3, 1.2, 0}, {1.3, 1.2, 0.2}, {1.3, 0.5, 0.2}))))
      << "a shallow ramp";
}

TEST(Mesh, AcceptsRims) {
  Corners hopper;  // 24 narrow sides with zigzag rims
  const auto at = [](int i, double radius, double z) {
    const double angle = 2 * std::numbers::pi * (i % 24) / 24;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z + 0.05 * (i % 2));
  };
  for (int i = 0; i < 24; ++i) add_quad(hopper, at(i, 0.2, 0), at(i + 1, 0.2, 0), at(i + 1, 1, 1), at(i, 1, 1));
  EXPECT_TRUE(both_accept(hopper));

  Corners teeth;  // a floor and a row of teeth whose tips nearly reach it
  add_quad(teeth, {0, -1, 0}, {10, -1, 0}, {10, 0, 0}, {0, 0, 0});
  for (int i = 0; i < 10; ++i) {
    const double x = i;
    teeth.insert(teeth.end(), {{x + 0.5, 1e-7, 0}, {x + 1, 1, 0}, {x, 1, 0}});
  }
  EXPECT_TRUE(both_accept(teeth));

  Corners fan;  // facets of 0.01 degrees, as in round flanges, with nearly collinear rims
  for (int i = 0; i < 5; ++i) {
    const double a = 1e-4 * i * i, b = 1e-4 * (i + 1) * (i + 1);
    fan.insert(fan.end(), {Vec3::Zero(), {std::cos(a), std::sin(a), 0}, {std::cos(b), std::sin(b), 0}});
  }
  EXPECT_TRUE(both_accept(fan));
  Corners strip;  // one straight rim
  for (int i = 0; i < 5; ++i) strip.insert(strip.end(), {Vec3(i, 0, 0), Vec3(i + 1, 0, 0), Vec3(2, 0.01, 0)});
  EXPECT_TRUE(both_accept(strip));
}

TEST(Mesh, RefusesInvertedFacetsUnlessTwoSided) {
  Corners corners = box(low, high);
  std::swap(corners[3 * 6 + 1], corners[3 * 6 + 2]);
  EXPECT_THAT(complaint(corners),
              HasSubstr("found inverted facets, oriented against most of their neighbours: 7; allowed"));
  EXPECT_EQ(complaint(corners, {{"two_sided", true}}), "");
  EXPECT_EQ(mesh(corners, {{"two_sided", true}})->area(), 0);
}

TEST(Mesh, RefusesDegenerateFacetsUnlessSkipped) {
  Corners corners = box(low, high);
  corners.insert(corners.begin() + 3, {Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, 3)});
  corners.insert(corners.end(), {high, high, low});
  EXPECT_THAT(complaint(corners),
              HasSubstr("found degenerate facets, without area: 2, 14; allowed is facets whose corners"));
  EXPECT_EQ(complaint(corners, {{"skip_degenerate", true}}), "");
  EXPECT_THAT(contacts_of(*mesh(corners, {{"skip_degenerate", true}}), {0.5, 1, 3.05}, 0.1), SizeIs(1));
  EXPECT_THAT(complaint({high, high, low}, {{"skip_degenerate", true}}), HasSubstr("found degenerate facets only"));
}

TEST(Mesh, RefusesEdgesOfManyFacetsUnlessTwoSided) {
  Corners fin = without_top();
  add_quad(fin, {0, 0, 3}, {0, 2, 3}, {-1, 2, 3}, {-1, 0, 3});
  add_quad(fin, {0, 0, 3}, {0, 2, 3}, {-1, 2, 4}, {-1, 0, 4});
  EXPECT_THAT(complaint(fin, {{"open", true}}),
              HasSubstr("found edges shared by more than two facets, of facets 1, 11, 13; allowed"));
  EXPECT_EQ(complaint(fin, {{"open", true}, {"two_sided", true}}), "");
}

TEST(Mesh, RefusesAClosedSurfaceThatFacesInwards) {
  const auto reversed = [](Corners corners) {
    for (std::size_t i = 0; i < corners.size(); i += 3) std::swap(corners[i + 1], corners[i + 2]);
    return corners;
  };
  const Corners cube = box(low, high);
  EXPECT_THAT(
      complaint(reversed(cube)),
      HasSubstr("found a closed surface that faces inwards: facets 1, 2, 3, 4, 5 and 7 more; allowed is facets that"));
  EXPECT_THAT(complaint(reversed(cube), {{"inside", true}}), HasSubstr("faces inwards"));
  const auto beside = [&](Corners other) {
    Corners both = cube;
    both.insert(both.end(), other.begin(), other.end());
    return both;
  };
  EXPECT_EQ(complaint(beside(box({2, 0, 0}, {3, 1, 1}))), "");
  EXPECT_THAT(complaint(beside(reversed(box({2, 0, 0}, {3, 1, 1})))),
              HasSubstr("inwards: facets 13, 14, 15, 16, 17 and"));
  EXPECT_EQ(complaint(beside(reversed(box({0.3, 0.3, 0.3}, {0.6, 0.6, 0.6})))), "") << "a cavity";
}

TEST(Mesh, RefusesContradictingNormalsUnlessIgnored) {
  std::string text = test::stl_text(box(low, high));
  text.replace(text.find("normal -1"), 9, "normal 1 ");
  const StlFile file(text);
  const auto with = [&](const Settings& more) -> std::string {
    Settings settings{{"path", file.path()}, {"scale", 1.0}};
    settings.insert(settings.end(), more.begin(), more.end());
    try {
      made<Mesh>(settings);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(with({}),
              HasSubstr("found facets whose order of corners contradicts the normal in the file: 1; allowed"));
  EXPECT_EQ(with({{"ignore_normals", true}}), "");
}

TEST(Mesh, MergesCornersWithinTheTolerance) {
  const Corners corners = jittered(box(low, high));
  EXPECT_THAT(complaint(corners), HasSubstr("found an open surface: 36 edges"));
  EXPECT_THAT(complaint(corners, {{"merge_distance", 1e-8}}), HasSubstr("found an open surface"));
  EXPECT_EQ(complaint(corners, {{"merge_distance", 1e-6}}), "");
}

TEST(Mesh, NamesTheDistanceThatClosesIt) {
  // The distance in the message; 0 without one.
  const auto named = [](const std::string& message) {
    const std::string before = "set \"merge_distance\" to ";
    const auto at = message.find(before);
    return at == std::string::npos ? 0.0 : std::stod(message.substr(at + before.size()));
  };
  for (const double gap : {1e-12, 1e-7, 1e-3, 0.3}) {
    Corners corners = box(low, high);
    for (std::size_t i = 30; i < corners.size(); ++i) corners[i].z() += gap;  // the top
    const std::string message = complaint(corners);
    EXPECT_THAT(message, HasSubstr(" m, which closes it, or set \"open\""));
    EXPECT_GE(named(message), gap);
    EXPECT_LE(named(message), 1.13 * gap);
    EXPECT_EQ(complaint(corners, {{"merge_distance", named(message)}}), "") << gap;
    EXPECT_THAT(complaint(corners, {{"merge_distance", 0.99 * gap}}), HasSubstr("found an open surface")) << gap;
  }
  const Corners all = jittered(box(low, high));
  const double close = named(complaint(all));
  EXPECT_GT(close, 1e-7);
  EXPECT_EQ(complaint(all, {{"merge_distance", close}}), "");
  EXPECT_THAT(complaint(all, {{"merge_distance", 0.8 * close}}), HasSubstr("found an open surface"));
  // A gap as wide as the lid, and a corner on the middle of an edge: nothing to merge.
  Corners apart = box(low, high);
  for (std::size_t i = 30; i < apart.size(); ++i) apart[i].z() += 1;
  EXPECT_EQ(named(complaint(apart)), 0);
  Corners split = without_top();
  const Vec3 a(0, 0, 3), b(1, 0, 3), c(1, 2, 3), d(0, 2, 3), middle(0.5, 0, 3);
  for (const Vec3& corner : {a, middle, d, middle, c, d, middle, b, c}) split.push_back(corner);
  EXPECT_THAT(complaint(split), HasSubstr("no \"merge_distance\" does"));
}

TEST(Mesh, ReportsWhatIsWrongWithItsFile) {
  EXPECT_EQ(complaint({}), "path: found a file without facets; allowed is at least one facet");
  EXPECT_THAT(
      [] {
        made<Mesh>({{"path", std::string("/nowhere.stl")}});
      },
      testing::ThrowsMessage<Error>(HasSubstr("path: found /nowhere.stl, which cannot be read")));
  EXPECT_THAT(
      [] {
        made<Mesh>({{"path", std::string()}});
      },
      testing::ThrowsMessage<Error>("path: found an empty text, allowed: the path of a file; "));
}

}  // namespace
}  // namespace grit
