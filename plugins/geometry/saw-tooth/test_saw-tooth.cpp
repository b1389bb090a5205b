#include <gmock/gmock.h>

#include <numbers>

#include "grit/testing/geometry.hpp"
#include "saw-tooth.hpp"

namespace grit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Settings = std::vector<std::pair<std::string, Setting>>;

constexpr double degree = std::numbers::pi / 180;

/// A sheet on z = 0 from the origin, with a plain reference solution.
struct Grooves {
  double length_a = 2, length_b = 1;
  double depth = 0.1, inclination = 45 * degree, second_inclination = inclination, floor = 0, land = 0, offset = 0;

  double falling() const { return depth / std::tan(inclination); }
  double rising() const { return depth / std::tan(second_inclination); }
  double spacing() const { return falling() + floor + rising() + land; }

  std::shared_ptr<SawTooth> made(const Vec3& corner = Vec3::Zero(), const Mat3& turn = Mat3::Identity()) const {
    return grit::made<SawTooth>({{"corner", corner},
                                 {"edge_a", Vec3(turn * Vec3(length_a, 0, 0))},
                                 {"edge_b", Vec3(turn * Vec3(0, length_b, 0))},
                                 {"depth", depth},
                                 {"inclination", inclination},
                                 {"second_inclination", second_inclination},
                                 {"floor", floor},
                                 {"spacing", spacing()},
                                 {"offset", offset}});
  }

  /// z of the surface at x, extended past the ends.
  double height(double x) const {
    const double groove = x - offset - spacing() * std::floor((x - offset) / spacing());
    const double bottom = std::max(-depth, -groove * std::tan(inclination));
    return std::min(0.0, std::max(bottom, (groove - falling() - floor - rising()) * std::tan(second_inclination)));
  }
  bool in_front(const Vec3& centre) const { return centre.z() >= height(centre.x()); }

  struct Strip {
    double x0, z0, x1, z1;
  };
  /// Every flat strip of the sheet, from end to end.
  std::vector<Strip> strips() const {
    std::vector<Strip> strips;
    const int before = static_cast<int>(std::ceil(std::abs(offset) / spacing())) + 1,
              after = before + static_cast<int>(length_a / spacing()) + 2;
    for (int k = -before; k < after; ++k) {
      const double x = offset + k * spacing(), left = x + falling(), right = left + floor, end = right + rising();
      for (const Strip& strip : {Strip{x, 0, left, -depth}, Strip{left, -depth, right, -depth},
                                 Strip{right, -depth, end, 0}, Strip{end, 0, x + spacing(), 0}}) {
        const double from = std::max(strip.x0, 0.0), to = std::min(strip.x1, length_a);
        if (to - from < 1e-12) continue;
        const double slope = (strip.z1 - strip.z0) / (strip.x1 - strip.x0);
        strips.push_back({from, strip.z0 + slope * (from - strip.x0), to, strip.z0 + slope * (to - strip.x0)});
      }
    }
    return strips;
  }

  /// All contact points of a sphere in front of the surface: the closest point of each strip, except in valleys, and at
  /// tips only, and once, if the tip is the closest point of both of its strips.
  std::vector<Vec3> touched(const Vec3& centre, double radius) const {
    const auto strips = this->strips();
    struct Point {
      double x, z;
      bool start, end;
    };
    std::vector<Point> closest;
    for (const Strip& s : strips) {
      const double dx = s.x1 - s.x0, dz = s.z1 - s.z0;
      const double fraction = ((centre.x() - s.x0) * dx + (centre.z() - s.z0) * dz) / (dx * dx + dz * dz);
      if (fraction <= 0) closest.push_back({s.x0, s.z0, true, false});
      else if (fraction >= 1) closest.push_back({s.x1, s.z1, false, true});
      else closest.push_back({s.x0 + fraction * dx, s.z0 + fraction * dz, false, false});
    }
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < strips.size(); ++i) {
      const Point& p = closest[i];
      const double y = std::clamp(centre.y(), 0.0, length_b);
      const Vec3 point(p.x, y, p.z);
      if ((point - centre).norm() >= radius) continue;
      if (p.start && i > 0) continue;  // a tip counts with the strip before it
      if (p.end && i + 1 < strips.size()) {
        if (p.z < -0.999999 * depth || !closest[i + 1].start) continue;
      }
      const Strip& s = strips[i];
      const double above = (centre.z() - s.z0) * (s.x1 - s.x0) - (centre.x() - s.x0) * (s.z1 - s.z0);
      const bool at_tip = p.end && i + 1 < strips.size(),
                 beyond = i == 0 ? centre.x() < 0 : i + 1 == strips.size() && centre.x() > length_a;
      if (above < 0 && !at_tip && !beyond) continue;  // seen from behind
      points.push_back(point);
    }
    return points;
  }
};

const Grooves sharp{};
const Grooves fine{.length_a = 0.5, .length_b = 0.4, .depth = 0.01};
const Grooves oblique{.length_a = 0.9,
                      .length_b = 0.5,
                      .depth = 0.06,
                      .inclination = 30 * degree,
                      .second_inclination = 70 * degree,
                      .floor = 0.05,
                      .land = 0.07,
                      .offset = -0.033};
const Grooves flat_bottomed{.depth = 0.2, .floor = 0.15, .land = 0.05, .offset = 0.1};
const Grooves shallow{.depth = 0.02, .inclination = 10 * degree};
const Grooves steep{.depth = 0.3, .second_inclination = 89 * degree, .offset = 5.25};

GeometryCase turned() {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 corner(0.1, 0.2, -0.3);
  return {.name = "turned",
          .geometry = oblique.made(corner, turn),
          .where = {corner - Vec3::Constant(0.4), corner + Vec3::Constant(0.9)},
          .radius = 0.2,
          .in_front = [=](const Vec3& centre) { return oblique.in_front(turn.transpose() * (centre - corner)); }};
}

INSTANTIATE_TEST_SUITE_P(
    SawTooth, GeometryContract,
    testing::Values(
        GeometryCase{.name = "grain_like_groove",
                     .geometry = sharp.made(),
                     .where = {{-0.2, -0.2, -0.2}, {2.2, 1.2, 0.2}},
                     .radius = 0.1,
                     .flanks = {{{0.95, 0.5, 0.08}, {1.05, 0.5, 0.08}},     // over a tip: they are at 0, 0.2, 0.4, …
                                {{1.02, 0.2, 0.09}, {1.02, 0.9, 0.09}},     // along a tip
                                {{0.668, 0.3, 0.059}, {0.63, 0.3, 0.09}}},  // up a flank to its tip
                     .across = {{{-0.3, 0.5, 0.05}, {2.3, 0.6, 0.07}},      // over all tips and both ends
                                {{0.5, 0.5, 0.2}, {0.5, 0.5, 0.03}},        // down into a valley
                                {{0.45, 0.5, 0.07}, {0.55, 0.45, 0.07}},    // through a valley, on both flanks
                                {{1, 0.5, 0.05}, {1, -0.2, 0.05}},          // over an end of the grooves
                                {{-0.2, -0.2, 0.02}, {1, 1, 0.09}}},        // over a corner
                     .in_front = [](const Vec3& c) { return sharp.in_front(c); }},
        GeometryCase{.name = "grain_above_groove",
                     .geometry = fine.made(),
                     .where = {{-0.3, -0.3, -0.1}, {0.8, 0.7, 0.3}},
                     .radius = 0.25,
                     .across = {{{-0.3, 0.2, 0.24}, {0.8, 0.2, 0.24}}, {{0.2, 0.2, 0.3}, {0.21, 0.2, 0.2}}},
                     .in_front = [](const Vec3& c) { return fine.in_front(c); }},
        GeometryCase{.name = "grain_below_groove",
                     .geometry = flat_bottomed.made(),
                     .where = {{-0.1, -0.1, -0.25}, {2.1, 1.1, 0.1}},
                     .radius = 0.04,
                     .flanks = {{{0.05, 0.5, 0.039}, {0.25, 0.5, -0.12}},    // from a land down a flank
                                {{0.35, 0.5, -0.161}, {0.4, 0.4, -0.162}}},  // along a floor
                     .across = {{{0.05, 0.5, 0.039}, {0.36, 0.5, -0.164}},   // from a land to a floor
                                {{-0.1, 0.5, 0.03}, {0.1, 0.5, 0.03}},
                                {{0.35, 0.5, -0.164}, {0.35, -0.1, -0.164}}},
                     .in_front = [](const Vec3& c) { return flat_bottomed.in_front(c); }},
        GeometryCase{.name = "steep",
                     .geometry = steep.made(),
                     .where = {{-0.2, -0.2, -0.3}, {2.2, 1.2, 0.2}},
                     .radius = 0.12,
                     .across = {{{-0.3, 0.5, 0.1}, {2.3, 0.5, 0.1}}},
                     .in_front = [](const Vec3& c) { return steep.in_front(c); }},
        GeometryCase{.name = "shallow",
                     .geometry = shallow.made(),
                     .where = {{-0.2, -0.2, -0.02}, {2.2, 1.2, 0.2}},
                     .radius = 0.1,
                     .across = {{{-0.2, 0.5, 0.084}, {2.2, 0.5, 0.084}}},  // up to 3 % overlap in the valleys
                     .in_front = [](const Vec3& c) { return shallow.in_front(c); }},
        turned()),
    case_name);

// Grooves of 0.1 m at 45 degrees are 0.2 m apart; fmod of 2^70 m is exact.
TEST(SawTooth, HugeOffsetCountsModuloSpacing) {
  Grooves part, far;
  far.offset = 0x1p70, part.offset = std::fmod(far.offset, far.spacing());
  const auto a_sheet = part.made(), b_sheet = far.made();
  for (int i = 0; i < 40; ++i) {
    const Vec3 centre(0.013 + 0.05 * i, 0.5, 0.01);
    const auto a = contacts_of(*a_sheet, centre, 0.12), b = contacts_of(*b_sheet, centre, 0.12);
    ASSERT_EQ(a.size(), b.size()) << i;
    ASSERT_FALSE(a.empty()) << i;
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].overlap, b[k].overlap) << i;
  }
}

TEST(SawTooth, EqualsContactsOfSingleStrips) {
  std::mt19937_64 random(7);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (const Grooves& grooves : {sharp, fine, oblique, flat_bottomed, steep}) {
    const auto sheet = grooves.made();
    int touching = 0, at_several = 0;
    for (int i = 0; i < 20000; ++i) {
      const double radius = grooves.depth * std::exp(draw(-2, 3));
      const double margin = 0.9 * radius;
      const Vec3 centre(draw(-margin, grooves.length_a + margin), draw(-margin, grooves.length_b + margin),
                        draw(-grooves.depth, radius));
      if (!grooves.in_front(centre)) continue;
      std::vector<Vec3> expected = grooves.touched(centre, radius);
      const auto contacts = contacts_of(*sheet, centre, radius);
      ASSERT_EQ(contacts.size(), expected.size()) << centre.transpose() << ", radius " << radius;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const Vec3 to_wall = expected[k] - centre;
        EXPECT_NEAR(contacts[k].overlap, radius - to_wall.norm(), 1e-12 * radius);
        EXPECT_LE((contacts[k].normal - to_wall.normalized()).norm(), 1e-15 * grooves.length_a / to_wall.norm());
      }
      touching += !contacts.empty();
      at_several += contacts.size() > 1;
    }
    EXPECT_GT(touching, 4000);
    EXPECT_GT(at_several, 400);
  }
}

std::vector<std::uint32_t> features(const Geometry& geometry, const Vec3& centre, double radius) {
  std::vector<std::uint32_t> result;
  for (const SurfaceContact& contact : contacts_of(geometry, centre, radius)) result.push_back(contact.feature);
  return result;
}

// The grooves of `sharp` begin at 0, 0.2, 0.4, … m: tooth 2 k has its tip there, the valley after it is 0.1 m on.
TEST(SawTooth, FlankPushesAlongItsNormal) {
  const double root = std::sqrt(0.5);
  const auto sheet = sharp.made();
  const auto right = contacts_of(*sheet, {0.63 + root * 0.02, 0.5, -0.03 + root * 0.02}, 0.025);
  ASSERT_EQ(right.size(), 1u);
  EXPECT_LE((right[0].normal - Vec3(-root, 0, -root)).norm(), 1e-15);
  EXPECT_NEAR(right[0].overlap, 0.005, 1e-12 * 0.025);
  const auto left = contacts_of(*sheet, {0.57 - root * 0.02, 0.5, -0.03 + root * 0.02}, 0.025);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_LE((left[0].normal - Vec3(root, 0, -root)).norm(), 1e-15);
  EXPECT_EQ(left[0].feature, right[0].feature) << "both flanks of a tooth";
}

TEST(SawTooth, FlankPushesAlongItsNormalAtAnyDistance) {
  const Vec3 normal(std::sin(30 * degree), 0, std::cos(30 * degree)),
      centre = Vec3(0.05, 0.5, -0.05 * std::tan(30 * degree)) + 1e-12 * normal;
  const SurfaceContact contact = contacts_of(*Grooves{.inclination = 30 * degree}.made(), centre, 0.025).at(0);
  EXPECT_LE((contact.normal + normal).norm(), 1e-15);
  EXPECT_NEAR(contact.overlap, 0.025 - 1e-12, 1e-12 * 0.025);
}

TEST(SawTooth, TipIsOneContact) {
  const auto sheet = sharp.made();
  const auto above = contacts_of(*sheet, {0.6, 0.5, 0.04}, 0.05);
  ASSERT_EQ(above.size(), 1u);
  EXPECT_LE((above[0].normal - Vec3(0, 0, -1)).norm(), 1e-13);
  EXPECT_NEAR(above[0].overlap, 0.01, 1e-12 * 0.05);
  const auto beside = contacts_of(*sheet, {0.603, 0.5, 0.004}, 0.01);
  ASSERT_EQ(beside.size(), 1u);
  EXPECT_LE((beside[0].normal - Vec3(-0.6, 0, -0.8)).norm(), 1e-13);
  EXPECT_NEAR(beside[0].overlap, 0.005, 1e-12 * 0.01);
}

TEST(SawTooth, ValleyIsTwoFlanks) {
  const auto contacts = contacts_of(*sharp.made(), {0.7, 0.5, -0.1 + 0.04}, 0.03);
  ASSERT_EQ(contacts.size(), 2u);
  const double root = std::sqrt(0.5);
  for (const SurfaceContact& contact : contacts) EXPECT_NEAR(contact.overlap, 0.03 - root * 0.04, 1e-12 * 0.03);
  EXPECT_LE((contacts[0].normal - Vec3(-root, 0, -root)).norm(), 1e-15);
  EXPECT_LE((contacts[1].normal - Vec3(root, 0, -root)).norm(), 1e-15);
  EXPECT_EQ(contacts[1].feature, contacts[0].feature + 2);
}

TEST(SawTooth, FlatBottomTouchesFloorAndFlanks) {
  const Grooves grooves{.depth = 0.1, .floor = 0.1};  // groove 0 … 0.3, its floor 0.1 … 0.2
  EXPECT_THAT(features(*grooves.made(), {0.15, 0.5, -0.06}, 0.03), IsEmpty());
  EXPECT_THAT(features(*grooves.made(), {0.15, 0.5, -0.06}, 0.041), ElementsAre(1));
  EXPECT_THAT(features(*grooves.made(), {0.12, 0.5, -0.06}, 0.045), ElementsAre(0, 1));
  EXPECT_THAT(features(*grooves.made(), {0.15, 0.5, -0.03}, 0.09), ElementsAre(0, 1, 2));
  EXPECT_EQ(contacts_of(*grooves.made(), {0.15, 0.5, -0.06}, 0.041).at(0).normal, Vec3(0, 0, -1));
}

TEST(SawTooth, LargeGrainTouchesSeveralTipsOnceEach) {
  const double radius = 1, height = 0.999;
  const auto contacts = contacts_of(*fine.made(), {0.25, 0.2, height}, radius);  // tips at 0.02 k
  const double half_width = std::sqrt(radius * radius - height * height);
  const auto first = static_cast<std::size_t>(std::ceil((0.25 - half_width) / 0.02));
  ASSERT_EQ(contacts.size(), static_cast<std::size_t>((0.25 + half_width) / 0.02) - first + 1);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const double x = 0.02 * static_cast<double>(first + i) - 0.25;
    EXPECT_NEAR(contacts[i].overlap, radius - std::hypot(x, height), 1e-12 * radius);
    EXPECT_LE((contacts[i].normal - Vec3(x, 0, -height).normalized()).norm(), 1e-14);
    EXPECT_EQ(contacts[i].feature, 2 * (first + i));
    EXPECT_EQ(contacts[i].body, 0u);
  }
}

TEST(SawTooth, LandIsAsSmoothAsAPlane) {
  const Grooves grooves{.depth = 0.01, .land = 0.3, .offset = 0.35};
  const auto sheet = grooves.made();  // a groove 0.35 … 0.37, then a land up to 0.67
  for (int i = 0; i <= 1000; ++i) {
    const Vec3 centre(0.37 + 0.3 * i / 1000, 0.5, 0.009);
    const auto contacts = contacts_of(*sheet, centre, 0.01);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].overlap, 0.001, 1e-16);
    EXPECT_LE((contacts[0].normal - Vec3(0, 0, -1)).norm(), 1e-13);
    EXPECT_EQ(contacts[0].feature, 4u);
  }
}

TEST(SawTooth, VeryFineGroovesActAsAFlatWall) {
  const Grooves grooves{.depth = 1e-6};
  const auto sheet = grooves.made();
  for (int i = 0; i <= 100; ++i) {
    double deepest = 0;
    for (const SurfaceContact& contact : contacts_of(*sheet, {1 + 1e-6 * i, 0.5, 0.099}, 0.1)) {
      deepest = std::max(deepest, contact.overlap);
    }
    EXPECT_NEAR(deepest, 0.001, 1e-6 * 1e-6 / 0.1) << "half a groove from a tip";
  }
}

TEST(SawTooth, PushesBackACentreUpToOneRadiusBehind) {
  const auto sheet = sharp.made();
  const double root = std::sqrt(0.5);
  const auto only = [&](const Vec3& centre, double radius) {
    const auto contacts = contacts_of(*sheet, centre, radius);
    EXPECT_EQ(contacts.size(), 1u);
    return contacts.at(0);
  };
  const SurfaceContact flank = only({0.65, 0.5, -0.07}, 0.05);
  EXPECT_LE((flank.normal - Vec3(-root, 0, -root)).norm(), 1e-15);
  EXPECT_NEAR(flank.overlap, 0.05 + root * 0.02, 1e-12 * 0.05);
  EXPECT_NEAR(only({0.65, 0.5, -0.05 - 0.0499 / root}, 0.05).overlap, 0.0999, 1e-12);
  EXPECT_THAT(features(*sheet, {0.65, 0.5, -0.05 - 0.0501 / root}, 0.05), IsEmpty());
  EXPECT_GT(only({0.69, 0.5, -0.13}, 0.05).overlap, 0.05) << "under a valley";
  const SurfaceContact floor = contacts_of(*flat_bottomed.made(), {0.37, 0.5, -0.23}, 0.05).at(0);
  EXPECT_EQ(floor.normal, Vec3(0, 0, -1));
  EXPECT_NEAR(floor.overlap, 0.08, 1e-15);
}

TEST(SawTooth, NothingSlipsThroughBehind) {
  std::mt19937_64 random(11);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (const Grooves& grooves : {sharp, fine, oblique, flat_bottomed, steep}) {
    const auto sheet = grooves.made();
    const double radius = 0.2;
    int behind = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 centre(draw(0, grooves.length_a), draw(0, grooves.length_b), -draw(0, 0.2));
      if (grooves.in_front(centre)) continue;
      ++behind;
      const auto contacts = contacts_of(*sheet, centre, radius);
      const auto pushes_out = [&](const SurfaceContact& contact) {
        return contact.overlap >= radius && contact.normal.z() < 0;
      };
      EXPECT_EQ(std::count_if(contacts.begin(), contacts.end(), pushes_out), 1) << centre.transpose();
    }
    EXPECT_GT(behind, 500);
  }
}

TEST(SawTooth, NumbersRiseAlongTheSheetWhereverAGrooveBegins) {
  for (const double offset : {0.0, 0.05, 0.1, -0.1, 0.2, 7.0, -123.4}) {
    const auto sheet = Grooves{.offset = offset}.made();
    std::vector<std::uint32_t> seen;
    for (int i = 0; i <= 4000; ++i)
      for (const std::uint32_t feature : features(*sheet, {i * 0.0005, 0.5, 0.01}, 0.0101))
        if (seen.empty() || seen.back() != feature) seen.push_back(feature);
    ASSERT_GE(seen.size(), 10u) << offset;
    for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_EQ(seen[k], seen[0] + 2 * k) << offset;
    EXPECT_LE(seen[0], 2u);
  }
}

TEST(SawTooth, EndsInAValleyAsAnEdge) {
  const auto sheet = Grooves{.length_a = 0.6, .floor = 0.1, .offset = -0.1}.made();  // starts with a floor, at −0.1 m
  const auto edge = contacts_of(*sheet, {-0.03, 0.5, -0.06}, 0.055);
  ASSERT_EQ(edge.size(), 1u);
  EXPECT_LE((edge[0].normal - Vec3(0.6, 0, -0.8)).norm(), 1e-14);
  EXPECT_NEAR(edge[0].overlap, 0.005, 1e-15);
  const auto sharp_end = contacts_of(*Grooves{.offset = -0.1}.made(), {-0.03, 0.5, -0.14}, 0.055);
  ASSERT_EQ(sharp_end.size(), 1u);
  EXPECT_LE((sharp_end[0].normal - Vec3(0.6, 0, 0.8)).norm(), 1e-14);
  for (int valleys = 1; valleys < 50; ++valleys) {  // for either rounding of the last valley's position
    const double end = 0.2 * valleys - 0.1;
    EXPECT_EQ(contacts_of(*Grooves{.length_a = end}.made(), {end + 0.03, 0.5, -0.14}, 0.055).size(), 1u) << end;
  }
  const auto corner = contacts_of(*sheet, {-0.02, -0.03, -0.04}, 0.08);
  ASSERT_EQ(corner.size(), 1u);
  EXPECT_LE((corner[0].normal - Vec3(2, 3, -6) / 7).norm(), 1e-14);
}

TEST(SawTooth, MillionthGrooveIsAsExactAsTheFirst) {
  const auto sheet = Grooves{.length_a = 200000}.made();
  const auto contacts = contacts_of(*sheet, {199999.8, 0.5, 0.04}, 0.05);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].feature, 2 * 999999u);
  EXPECT_NEAR(contacts[0].overlap, 0.01, 1e-12);
}

TEST(SawTooth, GivesAreaNormalAndBounds) {
  const auto wall = made<SawTooth>(
      {{"corner", Vec3(1, 1, 1)}, {"edge_a", Vec3(0, 2, 0)}, {"edge_b", Vec3(0, 0, 3)}, {"depth", 0.25}});
  EXPECT_DOUBLE_EQ(wall->area(), 6);
  EXPECT_EQ(wall->normal(), Vec3::UnitX());
  EXPECT_EQ(wall->bounds().low, Vec3(0.75, 1, 1));
  EXPECT_EQ(wall->bounds().high, Vec3(1, 3, 4)) << "the tips are in the plane of the sheet";
}

TEST(SawTooth, TrianglesCoverTheFacesAndFaceTheBodies) {
  for (const Grooves& grooves : {sharp, fine, oblique, flat_bottomed, steep}) {
    double expected = 0, area = 0, projected = 0;
    for (const auto& strip : grooves.strips())
      expected += grooves.length_b * std::hypot(strip.x1 - strip.x0, strip.z1 - strip.z0);
    const auto t = grooves.made()->triangles();
    for (std::size_t i = 0; i < t.size(); i += 3) {
      const Vec3 half = 0.5 * (t[i + 1] - t[i]).cross(t[i + 2] - t[i]);
      area += half.norm();
      projected += half.z();
      EXPECT_GT(half.z(), 0);
    }
    EXPECT_NEAR(area, expected, 1e-12);
    EXPECT_NEAR(projected, grooves.length_a * grooves.length_b, 1e-12);
  }
}

Settings sheet_and(Settings more) {
  Settings settings{{"corner", Vec3(0, 0, 0)}, {"edge_a", Vec3(0.01, 0, 0)}, {"edge_b", Vec3(0, 0.01, 0)}};
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

TEST(SawTooth, SpacingIsTheWidthOfAGrooveByDefault) {
  const auto by_default = made<SawTooth>(sheet_and({{"depth", 0.5e-3}})),
             given = made<SawTooth>(sheet_and({{"depth", 0.5e-3}, {"spacing", 1e-3}}));
  EXPECT_EQ(by_default->triangles().size(), 10u * 2 * 6) << "ten grooves, two flanks each, no slivers of land";
  EXPECT_EQ(given->triangles().size(), 10u * 2 * 6);
}

TEST(SawTooth, RefusesInvalidGrooves) {
  const auto complaint = [](const Settings& settings) -> std::string {
    try {
      made<SawTooth>(settings);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(sheet_and({{"depth", 0.5e-3}, {"spacing", 0.9e-3}})),
            "spacing: found 0.0009 m, allowed: at least the width of a groove, flanks and floor: 0.001 m; ");
  EXPECT_EQ(complaint(sheet_and({{"depth", 0.5e-3}, {"floor", 1e-4}, {"spacing", 1e-3}})),
            "spacing: found 0.001 m, allowed: at least the width of a groove, flanks and floor: 0.0011 m; ");
  EXPECT_EQ(complaint(sheet_and({{"depth", 0.5e-3}, {"second_inclination", 30 * degree}, {"spacing", 1e-3}})),
            "spacing: found 0.001 m, allowed: at least the width of a groove, flanks and floor: "
            "0.00136603 m; ");
  EXPECT_EQ(complaint(sheet_and({{"depth", 1e-10}})),
            "depth: found 5e+07 grooves on the sheet, allowed: at most 1e+06; ");
  EXPECT_EQ(complaint(sheet_and({{"depth", 1e-10}, {"spacing", 1e-9}})),
            "spacing: found 1e+07 grooves on the sheet, allowed: at most 1e+06; ");
  EXPECT_EQ(complaint(sheet_and({{"depth", 0.5e-3}, {"edge_b", Vec3(0, 0, 0)}})),
            "edge_b: found a vector of length 0, allowed: a vector of non-zero length; ");
  EXPECT_EQ(complaint(sheet_and({{"depth", 0.5e-3}, {"spacing", 1e-3}})), "");
}

TEST(SawTooth, BoundsItsParameters) {
  SawTooth sheet;
  Parameters parameters;
  sheet.declare(parameters);
  const auto allows = [&](const std::string& name, double value) {
    for (const Parameter& parameter : parameters.entries())
      if (parameter.name() == name) return parameter.allows(value);
    throw Error("no parameter " + name);
  };
  for (const char* name : {"depth", "inclination", "second_inclination", "spacing"}) {
    EXPECT_FALSE(allows(name, 0)) << name;
    EXPECT_TRUE(allows(name, 1e-3)) << name;
  }
  for (const char* name : {"inclination", "second_inclination"}) {
    EXPECT_FALSE(allows(name, 90 * degree)) << name;
    EXPECT_TRUE(allows(name, 89 * degree)) << name;
  }
  EXPECT_TRUE(allows("floor", 0));
  EXPECT_FALSE(allows("floor", -1e-9));
  EXPECT_TRUE(allows("offset", -1));
}

}  // namespace
}  // namespace grit
