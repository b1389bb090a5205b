#include <gmock/gmock.h>

#include <numbers>

#include "grit/testing/geometry.hpp"
#include "sinusoidal.hpp"

namespace grit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Settings = std::vector<std::pair<std::string, Setting>>;

constexpr double pi = std::numbers::pi;

/// A sheet on z = 0 from the origin, with a plain reference solution.
struct Waves {
  double length_a = 2, length_b = 1;
  double depth = 0.1, wavelength = 0.4, offset = 0;

  std::shared_ptr<Sinusoidal> made(const Vec3& corner = Vec3::Zero(), const Mat3& turn = Mat3::Identity()) const {
    return grit::made<Sinusoidal>({{"corner", corner},
                                   {"edge_a", Vec3(turn * Vec3(length_a, 0, 0))},
                                   {"edge_b", Vec3(turn * Vec3(0, length_b, 0))},
                                   {"depth", depth},
                                   {"wavelength", wavelength},
                                   {"offset", offset}});
  }

  double trough_radius() const { return wavelength * wavelength / (2 * pi * pi * depth); }
  long double phase(long double x) const { return 2 * std::numbers::pi_v<long double> * (x - offset) / wavelength; }
  long double height(long double x) const { return -0.5L * depth * (1 - std::cos(phase(x))); }
  long double slope(long double x) const {
    return -std::numbers::pi_v<long double> * depth / wavelength * std::sin(phase(x));
  }
  /// A point at distance `off` from the surface at x, along its normal.
  Vec3 off_surface(double x, double y, double off) const {
    const double slope = static_cast<double>(this->slope(x)), root = std::hypot(1, slope);
    return {x - off * slope / root, y, static_cast<double>(height(x)) + off / root};
  }
  /// Distance of a point in the section from the surface, by search.
  double distance(double x, double z) const {
    const auto to = [&](double u) { return std::hypot(u - x, static_cast<double>(height(u)) - z); };
    const double step = std::min(wavelength, length_a) / 100;
    double best = length_a;
    for (double u = 0; u < length_a; u += step)
      if (to(u) < to(best)) best = u;
    double low = std::max(best - step, 0.0), high = std::min(best + step, length_a);
    for (int i = 0; i < 80; ++i) {
      const double third = (high - low) / 3;
      (to(low + third) < to(high - third) ? high : low) += (to(low + third) < to(high - third) ? -third : third);
    }
    return to(low);
  }
  bool in_front(const Vec3& centre) const { return centre.z() >= height(std::clamp(centre.x(), 0.0, length_a)); }

  /// All contact points of a sphere in front of the surface: local minima of distance, by bisection of its derivative,
  /// visible from above and not across a crest. None if rounding decides.
  std::optional<std::vector<Vec3>> touched(const Vec3& centre, double radius) const {
    const long double x = centre.x(), z = centre.z(), y = std::clamp(centre.y(), 0.0, length_b);
    const auto rate = [&](long double u) { return u - x + (height(u) - z) * slope(u); };
    const long double from = std::max(0.0L, x - radius), to = std::min<long double>(length_a, x + radius);
    const auto valley = [&](long double u) { return std::floor((u - offset) / wavelength); };
    std::vector<Vec3> points;
    bool clear = true;
    const auto check = [&](long double u) {
      if (z <= height(u) && u > 0 && u < length_a) return;
      if (z < 0 && valley(u) != valley(std::clamp<long double>(x, 0, length_a))) return;
      const Vec3 point = Eigen::Vector3<long double>(u, y, height(u)).cast<double>();
      if (std::abs((point - centre).norm() - radius) < 1e-12 * radius) clear = false;
      if ((point - centre).norm() < radius) points.push_back(point);
    };
    if (x - radius < 0 && rate(0) > 0) check(0);
    const int steps = 20 + static_cast<int>(200 * (to - from) / wavelength);
    long double left = from, before = rate(left), before_that = before;
    for (int i = 1; i <= steps; ++i) {
      const long double right = from + i * (to - from) / steps, now = rate(right);
      const bool bends = (before - before_that) * (now - before) < 0;
      if (bends && std::abs(before) < 1e-3 * (std::abs(now - before) + 1e-3 * wavelength)) clear = false;
      if (before <= 0 && now > 0) {
        long double low = left, high = right;
        for (int k = 0; k < 80; ++k) (rate(0.5L * (low + high)) > 0 ? high : low) = 0.5L * (low + high);
        check(low);
      }
      left = right, before_that = before, before = now;
    }
    if (x + radius > length_a && rate(length_a) < 0) check(length_a);
    return clear ? std::optional(points) : std::nullopt;
  }
};

// d / l: 0.25, 0.05, 0.427 (the steepest in the laboratory), 3; the last ends in troughs.
const Waves usual{};
const Waves gentle{.depth = 0.02};
const Waves steep{.depth = 0.1708, .offset = 0.07};
const Waves fine{.length_a = 0.5, .length_b = 0.4, .depth = 0.005, .wavelength = 0.02};
const Waves deep{.length_a = 1, .depth = 0.6, .wavelength = 0.2, .offset = -3.33};
const Waves cut{.length_a = 0.75, .length_b = 0.5, .depth = 0.15, .wavelength = 0.3, .offset = 0.1};
const Waves cut_gentle{.length_a = 0.77, .depth = 0.01, .wavelength = 0.3, .offset = 0.1};

double facet_error(const Waves& waves) { return 6.1e-4 * waves.depth; }

GeometryCase turned() {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 corner(0.1, 0.2, -0.3);
  return {.name = "turned",
          .geometry = cut.made(corner, turn),
          .where = {corner - Vec3::Constant(0.4), corner + Vec3::Constant(0.9)},
          .radius = 0.2,
          .facet_error = facet_error(cut),
          .in_front = [=](const Vec3& centre) { return cut.in_front(turn.transpose() * (centre - corner)); }};
}

INSTANTIATE_TEST_SUITE_P(
    Sinusoidal, GeometryContract,
    testing::Values(
        GeometryCase{.name = "grain_that_fits",  // into troughs of radius 0.081
                     .geometry = usual.made(),
                     .where = {{-0.2, -0.2, -0.2}, {2.2, 1.2, 0.2}},
                     .radius = 0.08,
                     .flanks = {{{0.97, 0.5, -0.035}, {1.04, 0.5, -0.03}},  // through a trough: they are at 0.2, 0.6, …
                                {{0.75, 0.5, 0.07}, {0.85, 0.5, 0.07}},     // over a crest
                                {{0.93, 0.5, 0}, {0.93, 0.1, 0}},           // along a flank
                                {{0.8, 0.5, 0.05}, {0.98, 0.5, -0.04}}},    // from a crest into a trough
                     .across = {{{-0.3, 0.5, 0.05}, {2.3, 0.6, 0.07}},      // over all crests and both ends
                                {{1, 0.5, 0.1}, {1, 0.5, -0.08}},           // down into a trough
                                {{0.9, 0.5, -0.02}, {1.1, 0.45, -0.04}},    // through a trough
                                {{1, 0.5, -0.05}, {1, -0.2, -0.05}},        // over an end of the waves
                                {{-0.2, -0.2, 0.02}, {1, 1, 0.07}}},        // over a corner
                     .facet_error = facet_error(usual),
                     .hollow_radius = usual.trough_radius(),
                     .in_front = [](const Vec3& c) { return usual.in_front(c); }},
        GeometryCase{.name = "grain_above_troughs",  // of radius 0.0475
                     .geometry = steep.made(),
                     .where = {{-0.2, -0.2, -0.2}, {2.2, 1.2, 0.3}},
                     .radius = 0.12,
                     .flanks = {{{0.82, 0.5, 0.11}, {0.92, 0.5, 0.11}}},  // over a crest: they are at 0.07, 0.47, …
                     .across = {{{-0.3, 0.5, 0.1}, {2.3, 0.6, 0.1}},
                                {{0.67, 0.5, 0.05}, {0.67, 0.5, -0.04}},    // down upon two flanks
                                {{0.65, 0.5, -0.03}, {0.69, 0.5, -0.03}}},  // from one to the other
                     .facet_error = facet_error(steep),
                     .in_front = [](const Vec3& c) { return steep.in_front(c); }},
        GeometryCase{.name = "grain_above_waves",
                     .geometry = fine.made(),
                     .where = {{-0.3, -0.3, -0.1}, {0.8, 0.7, 0.3}},
                     .radius = 0.25,
                     .across = {{{-0.3, 0.2, 0.249}, {0.8, 0.2, 0.249}}, {{0.2, 0.2, 0.3}, {0.21, 0.2, 0.24}}},
                     .facet_error = facet_error(fine),
                     .in_front = [](const Vec3& c) { return fine.in_front(c); }},
        GeometryCase{.name = "deep",
                     .geometry = deep.made(),
                     .where = {{-0.1, -0.1, -0.7}, {1.1, 1.1, 0.1}},
                     .radius = 0.05,
                     .across = {{{-0.1, 0.5, 0.04}, {1.1, 0.5, 0.04}}},
                     .facet_error = facet_error(deep),
                     .in_front = [](const Vec3& c) { return deep.in_front(c); }},
        turned()),
    case_name);

TEST(Sinusoidal, HasAContactAtEachLocalMinimumOfDistance) {
  std::mt19937_64 random(7);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int at_several = 0;
  for (const Waves& waves : {usual, gentle, steep, fine, deep, cut, cut_gentle}) {
    const auto sheet = waves.made();
    int touching = 0;
    for (int i = 0; i < 2000; ++i) {
      const double radius = waves.wavelength * std::exp(draw(-5.5, 2)), margin = 0.9 * radius;
      const double x = draw(-margin, waves.length_a + margin), on = std::clamp(x, 0.0, waves.length_a),
                   from = static_cast<double>(waves.height(on));
      const Vec3 centre(x, draw(-margin, waves.length_b + margin), from + radius * draw(0, 1.5));
      const auto expected = waves.touched(centre, radius);
      if (!expected) continue;
      const auto contacts = contacts_of(*sheet, centre, radius);
      ASSERT_EQ(contacts.size(), expected->size()) << centre.transpose() << ", radius " << radius;
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        const Vec3 to_wall = (*expected)[k] - centre;
        EXPECT_NEAR(contacts[k].overlap, radius - to_wall.norm(), 1e-12 * radius);
        EXPECT_LE((contacts[k].normal - to_wall.normalized()).norm(), 1e-9 + 1e-14 * waves.length_a / to_wall.norm());
      }
      touching += !contacts.empty();
      at_several += contacts.size() > 1;
    }
    EXPECT_GT(touching, 1000);
  }
  EXPECT_GT(at_several, 400);
}

std::vector<std::uint32_t> features(const Geometry& geometry, const Vec3& centre, double radius) {
  std::vector<std::uint32_t> result;
  for (const SurfaceContact& contact : contacts_of(geometry, centre, radius)) result.push_back(contact.feature);
  return result;
}

// The crests of `usual` are at 0, 0.4, 0.8, …, its troughs at 0.2, 0.6, 1, …
TEST(Sinusoidal, CrestsAndTroughsPushUpright) {
  for (const double x : {0.4, 1.2, 0.6, 1.4}) {
    const double height = x == 0.4 || x == 1.2 ? 0 : -0.1;
    const auto contacts = contacts_of(*usual.made(), {x, 0.5, height + 0.07}, 0.08);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_LE((contacts[0].normal - Vec3(0, 0, -1)).norm(), 1e-13);
    EXPECT_NEAR(contacts[0].overlap, 0.01, 1e-12 * 0.08);
  }
}

TEST(Sinusoidal, FlankPushesAlongItsNormalAtAnyDistance) {
  const Vec3 at = steep.off_surface(0.31, 0.5, 0), normal = (steep.off_surface(0.31, 0.5, 1) - at).normalized();
  for (const double off : {1e-3, 1e-9, 0.0, -1e-9, -1e-3}) {
    const auto contacts = contacts_of(*steep.made(), at + off * normal, 0.03);
    ASSERT_EQ(contacts.size(), 1u) << off;
    EXPECT_LE((contacts[0].normal + normal).norm(), 1e-13) << off;
    EXPECT_NEAR(contacts[0].overlap, 0.03 - off, 1e-12 * 0.03) << off;
  }
}

// Where the normals of both flanks meet above a trough.
TEST(Sinusoidal, ValleyNarrowerThanTheSphereIsTwoContacts) {
  for (const double x : {0.1, 0.13, 0.17}) {
    const double slope = static_cast<double>(usual.slope(x)), height = static_cast<double>(usual.height(x));
    const Vec3 centre(0.2, 0.5, height + (0.2 - x) / -slope);
    const double radius = std::hypot(centre.x() - x, centre.z() - height) + 1e-3;
    ASSERT_GT(radius, usual.trough_radius());
    const auto contacts = contacts_of(*usual.made(), centre, radius);
    ASSERT_EQ(contacts.size(), 2u);
    for (const double side : {-1.0, 1.0}) {
      const SurfaceContact& contact = contacts[side > 0];
      EXPECT_NEAR(contact.overlap, 1e-3, 1e-12 * radius);
      EXPECT_LE((contact.normal - Vec3(-side * slope, 0, -1).normalized()).norm(), 1e-13);
    }
    EXPECT_EQ(contacts[1].feature, contacts[0].feature + 1);
  }
}

TEST(Sinusoidal, SphereThatFitsHasOneContact) {
  std::mt19937_64 random(5);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (const Waves& waves : {usual, gentle, steep, fine, deep}) {
    const auto sheet = waves.made();
    const double radius = (1 - 1e-9) * waves.trough_radius();
    int touching = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 centre(draw(0, waves.length_a), draw(0, waves.length_b), draw(-waves.depth, radius));
      if (!waves.in_front(centre)) continue;
      const auto found = features(*sheet, centre, radius);
      ASSERT_LE(found.size(), 1u) << centre.transpose();
      EXPECT_THAT(found, testing::Each(0u));
      touching += !found.empty();
    }
    EXPECT_GT(touching, 600);
  }
}

/// Largest change of a contact's overlap in excess of the sphere's displacement, while it slides through a trough of
/// `waves` pressed by `overlap` into the deeper flank.
double largest_jump(const Waves& waves, double radius, double overlap) {
  const auto sheet = waves.made();
  constexpr int steps = 20000;
  const double crest = waves.offset + waves.wavelength, trough = crest + 0.5 * waves.wavelength;
  double largest = 0;
  std::vector<SurfaceContact> before;
  Vec3 from;
  for (int i = 0; i <= steps; ++i) {
    const Vec3 centre = waves.off_surface(crest + i * (trough - crest) / steps, 0.5, radius - overlap);
    if (centre.x() > trough) break;  // the rest is symmetric
    const auto now = contacts_of(*sheet, centre, radius);
    const auto compare = [&](const SurfaceContact& contact, const std::vector<SurfaceContact>& others) {
      double other_overlap = 0;
      for (const SurfaceContact& other : others)
        if (other.feature == contact.feature) other_overlap = other.overlap;
      largest = std::max(largest, std::abs(contact.overlap - other_overlap) - (centre - from).norm());
    };
    if (i > 0) {
      for (const SurfaceContact& contact : now) compare(contact, before);
      for (const SurfaceContact& contact : before) compare(contact, now);
    }
    before = now, from = centre;
  }
  return largest;
}

// Overlap up to which contacts of a sphere that does not fit start and end continuously; limits from the evolute of the
// section, by bisection.
TEST(Sinusoidal, ContactsStartContinuouslyWithinTheLimit) {
  struct Limit {
    double depth_to_length, radius_to_trough, overlap_to_radius;
  };
  for (const Limit& limit : {Limit{0.147, 1.5, 0.055}, Limit{0.240, 1.1, 0.0076}, Limit{0.240, 1.5, 0.096},
                             Limit{0.240, 2, 0.204}, Limit{0.427, 1.5, 0.133}, Limit{0.427, 3, 0.532}}) {
    const Waves waves{.depth = 0.4 * limit.depth_to_length};
    const double radius = limit.radius_to_trough * waves.trough_radius(), overlap = limit.overlap_to_radius * radius;
    EXPECT_LE(largest_jump(waves, radius, 0.95 * overlap), 1e-4 * radius);
    const double beyond = largest_jump(waves, radius, 1.1 * overlap);
    EXPECT_GT(beyond, 5e-4 * radius);
    EXPECT_LE(beyond, radius - waves.trough_radius());
  }
}

TEST(Sinusoidal, LargeGrainHasOneContactPerCrestWithinReach) {
  const double radius = 1, height = 0.9995;
  const auto contacts = contacts_of(*fine.made(), {0.25, 0.2, height}, radius);  // crests at 0.02 k
  const double half_width = std::sqrt(radius * radius - height * height);
  const auto first = static_cast<std::size_t>(std::ceil((0.25 - half_width) / 0.02)),
             last = static_cast<std::size_t>(std::floor((0.25 + half_width) / 0.02));
  ASSERT_EQ(contacts.size(), last - first + 1);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const double x = 0.02 * static_cast<double>(first + i) - 0.25;
    EXPECT_NEAR(contacts[i].overlap, radius - std::hypot(x, height), 2e-6) << "the crest is lower beside its top";
    EXPECT_EQ(contacts[i].feature, first + 1 + i);
  }
}

TEST(Sinusoidal, FlatIsTheRectangleToTheLastBit) {
  std::mt19937_64 random(3);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const Waves flat{.depth = 0, .wavelength = 0.013, .offset = 0.1};
  const auto sheet = flat.made();
  int faces = 0, edges = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 centre(draw(-0.2, 2.2), draw(-0.2, 1.2), draw(-0.2, 0.2));
    const Vec3 off(centre.x() - std::clamp(centre.x(), 0.0, 2.0), centre.y() - std::clamp(centre.y(), 0.0, 1.0),
                   centre.z());
    const bool face = off.x() == 0 && off.y() == 0;
    const auto contacts = contacts_of(*sheet, centre, 0.2);
    ASSERT_EQ(contacts.size(), off.squaredNorm() < 0.2 * 0.2 ? 1u : 0u) << centre.transpose();
    if (contacts.empty()) continue;
    EXPECT_EQ(contacts[0].overlap, 0.2 - (face ? off.z() : off.norm()));
    EXPECT_EQ(contacts[0].normal, face ? Vec3(0, 0, -1) : Vec3(-off.normalized()));
    EXPECT_EQ(contacts[0].feature, 0u);
    ++(face ? faces : edges);
  }
  EXPECT_GT(faces, 5000);
  EXPECT_GT(edges, 1000);
  EXPECT_EQ(sheet->triangles().size(), 6u);
}

TEST(Sinusoidal, NothingSlipsThroughBehind) {
  std::mt19937_64 random(11);
  const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (const Waves& waves : {usual, gentle, steep, fine, cut, cut_gentle}) {
    const auto sheet = waves.made();
    const double radius = 0.15;
    int behind = 0, too_far = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vec3 centre(draw(0, waves.length_a), draw(0, waves.length_b), -draw(0, 0.25));
      if (waves.in_front(centre)) continue;
      const double distance = waves.distance(centre.x(), centre.z());
      const auto contacts = contacts_of(*sheet, centre, radius);
      if (std::abs(distance - radius) < 1e-12) continue;
      ASSERT_EQ(contacts.size(), distance < radius ? 1u : 0u) << centre.transpose();
      if (contacts.empty()) {
        ++too_far;
        continue;
      }
      EXPECT_NEAR(contacts[0].overlap, radius + distance, 1e-12) << centre.transpose();
      EXPECT_LT(contacts[0].normal.z(), 0);
      ++behind;
    }
    EXPECT_GT(behind, 250);
    EXPECT_GT(too_far, 10);
  }
}

// Crests have the radius of curvature of troughs: below that depth both flanks are equally close.
TEST(Sinusoidal, PushesOutOfTheFlankOnItsSideOfACrest) {
  constexpr double crest = 0.8, aside = 1e-9, radius = 0.2;
  const auto contact = [&](double x, double below) {
    const auto contacts = contacts_of(*usual.made(), {x, 0.5, -below}, radius);
    EXPECT_EQ(contacts.size(), 1u);
    return contacts.empty() ? SurfaceContact{} : contacts[0];
  };
  const double shallow = 0.95 * usual.trough_radius(), deeper = 1.2 * usual.trough_radius();
  for (const double x : {crest - aside, crest, crest + aside}) {
    EXPECT_NEAR(contact(x, shallow).overlap, radius + shallow, 1e-9);
    EXPECT_NEAR(contact(x, shallow).normal.x(), 0, 1e-6);
  }
  const SurfaceContact before = contact(crest - aside, deeper), at = contact(crest, deeper),
                       after = contact(crest + aside, deeper);
  EXPECT_LT(at.overlap, radius + deeper - 1e-4);
  EXPECT_NEAR(before.overlap, at.overlap, 2 * aside);
  EXPECT_NEAR(after.overlap, at.overlap, 2 * aside);
  EXPECT_GT(before.normal.x(), 0.1);
  EXPECT_LT(after.normal.x(), -0.1);
  EXPECT_NEAR(at.normal.x(), after.normal.x(), 1e-6);
}

TEST(Sinusoidal, SideHasNoThickness) {
  const Vec3 at = steep.off_surface(0.31, 0, 0), normal = (steep.off_surface(0.31, 0, 1) - at).normalized();
  for (const double off : {0.03, -0.03}) {  // over the edge, and under it
    const auto contacts = contacts_of(*steep.made(), at + Vec3(0, -0.04, 0) + off * normal, 0.06);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].overlap, 0.01, 1e-12 * 0.06);
    EXPECT_LE((contacts[0].normal - (Vec3(0, 0.8, 0) - off / 0.05 * normal)).norm(), 1e-12);
  }
}

TEST(Sinusoidal, EndsAreEdges) {
  const auto crest = contacts_of(*usual.made(), {-0.03, 0.5, -0.04}, 0.055);
  ASSERT_EQ(crest.size(), 1u);
  EXPECT_LE((crest[0].normal - Vec3(0.6, 0, 0.8)).norm(), 1e-14);
  EXPECT_NEAR(crest[0].overlap, 0.005, 1e-15);
  const auto trough = contacts_of(*Waves{.offset = 0.2}.made(), {2.03, 0.5, -0.14}, 0.055);
  ASSERT_EQ(trough.size(), 1u);
  EXPECT_LE((trough[0].normal - Vec3(-0.6, 0, 0.8)).norm(), 1e-14);
  EXPECT_NEAR(trough[0].overlap, 0.005, 1e-15);
  const auto corner = contacts_of(*usual.made(), {-0.02, -0.03, 0.06}, 0.08);
  ASSERT_EQ(corner.size(), 1u);
  EXPECT_LE((corner[0].normal - Vec3(2, 3, -6) / 7).norm(), 1e-14);
}

// The sheet starts in a trough at x = 0, half of a valley, with crests at 0.2, 0.6, …
TEST(Sinusoidal, EndInATroughAndTheFlankBesideItAreTwo) {
  const Waves waves{.depth = 0.16, .offset = 0.2};
  const auto sheet = waves.made();
  const Vec3 at = waves.off_surface(0.1, 0.5, 0),
             centre = waves.off_surface(0.1, 0.5, 0.1 / std::sin(std::atan(0.4 * pi)));
  EXPECT_NEAR(centre.x(), 0, 1e-15) << "above the end";
  const double to_flank = (centre - at).norm(), to_end = centre.z() + 0.16, radius = std::max(to_flank, to_end) + 0.01;
  const auto both = contacts_of(*sheet, centre + Vec3(-0.001, 0, 0), radius);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].feature, 0u);
  EXPECT_EQ(both[1].feature, 1u);
  EXPECT_NEAR(both[0].overlap, radius - std::hypot(to_end, 0.001), 1e-12);
  EXPECT_NEAR(both[1].overlap, radius - to_flank, 1e-3);
}

TEST(Sinusoidal, NumbersRiseAlongTheSheetWhereverACrestIs) {
  const double radius = 1.2 * usual.trough_radius();
  for (const double offset : {0.0, 0.05, 0.1, -0.1, 0.2, 7.0, -123.4}) {
    const auto sheet = Waves{.offset = offset}.made();
    std::vector<std::uint32_t> seen;
    for (int i = 0; i <= 4000; ++i)
      for (const std::uint32_t feature : features(*sheet, {i * 0.0005, 0.5, 0.999 * radius}, radius))
        if (seen.empty() || seen.back() != feature) seen.push_back(feature);
    ASSERT_GE(seen.size(), 5u) << offset;
    for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_EQ(seen[k], seen[0] + k) << offset;
    EXPECT_LE(seen[0], 2u);
  }
}

TEST(Sinusoidal, HugeOffsetCountsModuloWavelength) {
  const double huge = 0x1p1000;
  const auto near = Waves{.offset = std::remainder(huge, usual.wavelength)}.made(), far = Waves{.offset = huge}.made();
  for (int i = 0; i < 40; ++i) {
    const Vec3 centre(0.013 + 0.05 * i, 0.5, 0.02);
    const auto a = contacts_of(*near, centre, 0.15), b = contacts_of(*far, centre, 0.15);
    ASSERT_EQ(a.size(), b.size()) << i;
    ASSERT_FALSE(a.empty()) << i;
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].overlap, b[k].overlap) << i;
  }
}

TEST(Sinusoidal, MillionthWaveIsAsExactAsTheFirst) {
  const auto sheet = Waves{.length_a = 400000}.made();
  const auto contacts = contacts_of(*sheet, {399999.6, 0.5, 0.07}, 0.09);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].feature, 999999u + 1);
  EXPECT_NEAR(contacts[0].overlap, 0.02, 1e-12);
}

TEST(Sinusoidal, GivesAreaNormalAndBounds) {
  const auto wall = made<Sinusoidal>({{"corner", Vec3(1, 1, 1)},
                                      {"edge_a", Vec3(0, 2, 0)},
                                      {"edge_b", Vec3(0, 0, 3)},
                                      {"depth", 0.25},
                                      {"wavelength", 0.5}});
  EXPECT_DOUBLE_EQ(wall->area(), 6);
  EXPECT_EQ(wall->normal(), Vec3::UnitX());
  EXPECT_EQ(wall->bounds().low, Vec3(0.75, 1, 1));
  EXPECT_EQ(wall->bounds().high, Vec3(1, 3, 4)) << "the crests are in the plane of the sheet";
}

TEST(Sinusoidal, TrianglesLieOnTheSurfaceAndFaceTheBodies) {
  for (const Waves& waves : {usual, gentle, steep, fine, cut}) {
    double projected = 0;
    const auto t = waves.made()->triangles();
    for (const Vec3& corner : t) EXPECT_NEAR(corner.z(), static_cast<double>(waves.height(corner.x())), 1e-14);
    for (std::size_t i = 0; i < t.size(); i += 3) {
      const Vec3 half = 0.5 * (t[i + 1] - t[i]).cross(t[i + 2] - t[i]);
      projected += half.z();
      EXPECT_GT(half.z(), 0);
    }
    EXPECT_NEAR(projected, waves.length_a * waves.length_b, 1e-12);
  }
}

Settings sheet_and(Settings more) {
  Settings settings{{"corner", Vec3(0, 0, 0)}, {"edge_a", Vec3(0.01, 0, 0)}, {"edge_b", Vec3(0, 0.01, 0)}};
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

TEST(Sinusoidal, RefusesInvalidSheets) {
  const auto complaint = [](const Settings& settings) -> std::string {
    try {
      made<Sinusoidal>(settings);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint(sheet_and({{"depth", 1e-4}, {"wavelength", 1e-9}})),
            "wavelength: found 1e+07 waves on the sheet, allowed: at most 1e+06; ");
  EXPECT_EQ(complaint(sheet_and({{"depth", 1e-4}, {"wavelength", 1e-3}, {"edge_b", Vec3(0, 0, 0)}})),
            "edge_b: found a vector of length 0, allowed: a vector of non-zero length; ");
  EXPECT_EQ(complaint(sheet_and({{"depth", 1e-4}, {"wavelength", 1e-3}})), "");
}

TEST(Sinusoidal, BoundsItsParameters) {
  Sinusoidal sheet;
  Parameters parameters;
  sheet.declare(parameters);
  const auto allows = [&](const std::string& name, double value) {
    for (const Parameter& parameter : parameters.entries())
      if (parameter.name() == name) return parameter.allows(value);
    throw Error("no parameter " + name);
  };
  EXPECT_TRUE(allows("depth", 0));
  EXPECT_FALSE(allows("depth", -1e-9));
  EXPECT_TRUE(allows("wavelength", 1e-9));
  EXPECT_FALSE(allows("wavelength", 0));
  EXPECT_TRUE(allows("offset", -1));
}

}  // namespace
}  // namespace grit
