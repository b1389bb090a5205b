// A sphere in concave surroundings of many facets.
#include <gmock/gmock.h>

#include <functional>
#include <numbers>

#include "grit/testing/geometry.hpp"
#include "mesh.hpp"
#include "support/stl_file.hpp"

namespace grit::curved_surface_tests {
namespace {

using testing::SizeIs;
using Corners = std::vector<Vec3>;
using Settings = std::vector<std::pair<std::string, Setting>>;

constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-15;  // of distances of about 1

std::shared_ptr<Mesh> mesh(const Corners& corners, const Settings& more = {}) {
  const test::StlFile file(test::stl_text(corners));
  Settings settings{{"path", file.path()}, {"scale", 1.0}, {"open", true}};
  settings.insert(settings.end(), more.begin(), more.end());
  return made<Mesh>(settings);
}

std::vector<double> regular(int n) {
  std::vector<double> angles;
  for (int i = 0; i < n; ++i) angles.push_back(2 * pi * i / n);
  return angles;
}
/// Angles from 0.5 to 1.5 times as far apart.
std::vector<double> irregular(int n) {
  std::vector<double> angles;
  for (int i = 0; i < n; ++i) angles.push_back(2 * pi * (i + 0.5 * std::sin(7.0 * i * i)) / n);
  return angles;
}

struct Ring {
  double radius, z;
};
/// A surface of revolution about z which faces the axis: facets between rings, with corners on them at these angles.
Corners revolved(const std::vector<double>& angles, const std::vector<Ring>& rings) {
  Corners corners;
  const std::size_t n = angles.size();
  const auto at = [&](std::size_t i, const Ring& ring) {
    return Vec3(ring.radius * std::cos(angles[i % n]), ring.radius * std::sin(angles[i % n]), ring.z);
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
      const Ring &low = rings[k], &high = rings[k + 1];
      const Vec3 a = at(i, low), b = at(i + 1, low), c = at(i + 1, high), d = at(i, high);
      if (high.radius > 0) corners.insert(corners.end(), {a, d, c});
      if (low.radius > 0) corners.insert(corners.end(), {a, c, b});
    }
  return corners;
}
/// The same with all facets tangent to the circles of a cone or cylinder: its normals are at these angles.
Corners tangent(const std::vector<double>& normals, const Ring& low, const Ring& high) {
  const std::size_t n = normals.size();
  const auto at = [&](std::size_t i, const Ring& ring) {
    const double from = normals[i % n], to = normals[(i + 1) % n] + (i % n + 1 == n ? 2 * pi : 0);
    const double radius = ring.radius / std::cos((to - from) / 2), angle = (from + to) / 2;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), ring.z);
  };
  Corners corners;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 a = at(i, low), b = at(i + 1, low), c = at(i + 1, high), d = at(i, high);
    if (low.radius > 0) corners.insert(corners.end(), {a, d, c, a, c, b});
    else corners.insert(corners.end(), {Vec3(0, 0, low.z), d, c});
  }
  return corners;
}

/// Force on the sphere over the stiffness of one contact [m].
struct Force {
  Vec3 sum = Vec3::Zero();
  double overlaps = 0, deepest = 0, least = 0;
  std::size_t contacts = 0;
};
Force force(const Geometry& geometry, const Vec3& centre, double radius) {
  Force force;
  std::uint32_t last = 0;
  for (const SurfaceContact& contact : contacts_of(geometry, centre, radius)) {
    EXPECT_NEAR(contact.normal.norm(), 1, 1e-14);
    EXPECT_GT(contact.overlap, 0);
    EXPECT_TRUE(force.contacts == 0 || contact.feature > last);
    last = contact.feature;
    force.sum -= contact.overlap * contact.normal;
    force.overlaps += contact.overlap;
    force.deepest = std::max(force.deepest, contact.overlap);
    force.least = force.contacts++ == 0 ? contact.overlap : std::min(force.least, contact.overlap);
  }
  return force;
}

/// Contacts of the exact surface inside a cone or a cylinder: on the near and the far side, in one plane with the axis.
Force exact(const Vec3& centre, double radius, const Ring& low, const Ring& high) {
  const double off = std::hypot(centre.x(), centre.y()), slope = std::atan2(high.radius - low.radius, high.z - low.z);
  const Vec3 out = off > 0 ? Vec3(centre.x() / off, centre.y() / off, 0) : Vec3::UnitX();
  Force force;
  for (const double side : {1.0, -1.0}) {
    const double room = (low.radius + (centre.z() - low.z) * std::tan(slope) - side * off) * std::cos(slope);
    const double overlap = std::max(0.0, radius - room);
    force.sum += overlap * (std::sin(slope) * Vec3::UnitZ() - side * std::cos(slope) * out);
    force.overlaps += overlap;
    force.deepest = std::max(force.deepest, overlap);
    force.contacts += overlap > 0;
  }
  return force;
}

constexpr double degree = pi / 180;
/// A cone with its tip in the origin.
Ring mouth(double half_angle) { return {1, 1 / std::tan(half_angle)}; }

TEST(CurvedSurface, OppositeSidesOfAPipeBalance) {
  for (const auto& angles : {regular(25), regular(26), regular(64), regular(255), irregular(64)}) {
    const auto pipe = mesh(tangent(angles, {1, -1}, {1, 1}));
    for (const double overlap : {1e-6, 1e-3, 0.05}) {
      const Force on = force(*pipe, {0, 0, 0.1}, 1 + overlap);
      EXPECT_LE(on.sum.norm(), 1e-12 * on.overlaps + rounding) << angles.size() << ", " << overlap;
      EXPECT_EQ(on.contacts, 2u) << "near and far side, as of a cylinder";
      EXPECT_NEAR(on.overlaps, 2 * overlap, 1e-3 * overlap);
    }
  }
}

TEST(CurvedSurface, OppositeSidesOfAConeBalanceAndCarryAsTheConeDoes) {
  for (const double half_angle : {10 * degree, 30 * degree, 45 * degree, 60 * degree})
    for (const auto& angles : {regular(25), regular(26), regular(64), irregular(64)}) {
      SCOPED_TRACE(half_angle / degree);
      const Ring high = mouth(half_angle);
      const auto cone = mesh(tangent(angles, {0, 0}, high));
      const double radius = 0.3 * std::cos(half_angle), overlap = 1e-3 * radius;
      const Vec3 centre(0, 0, (radius - overlap) / std::sin(half_angle));
      const Force on = force(*cone, centre, radius), known = exact(centre, radius, {0, 0}, high);
      EXPECT_LE(std::hypot(on.sum.x(), on.sum.y()), 1e-12 * on.overlaps) << angles.size();
      EXPECT_NEAR(on.sum.z() / known.sum.z(), 1, 1e-9) << angles.size();
      EXPECT_EQ(on.contacts, 2u);
    }
}

TEST(CurvedSurface, AConeWithCornersOnItErrsByTheHeightOfItsFacets) {
  const double half_angle = 45 * degree, radius = 0.2, overlap = 0.002;
  const Vec3 centre(0, 0, (radius - overlap) / std::sin(half_angle));
  const Force known = exact(centre, radius, {0, 0}, mouth(half_angle));
  for (const int n : {32, 64, 128}) {
    const auto cone = mesh(revolved(regular(n), {{0, 0}, mouth(half_angle)}));
    const double from_axis = radius * std::cos(half_angle), height = from_axis * (1 - std::cos(pi / n));
    const double error = force(*cone, centre, radius).sum.z() / known.sum.z() - 1;
    EXPECT_NEAR(error, height * std::cos(half_angle) / overlap, 0.1 * error) << n;
  }
}

// Off the axis the force errs in direction, by half the angle between facets at most.
TEST(CurvedSurface, OffTheAxisTheForceIsThatOfTheExactSurface) {
  const double radius = 0.2, overlap = 0.002;
  for (const double half_angle : {20 * degree, 45 * degree, 60 * degree})
    for (const int n : {32, 33, 64}) {
      const auto cone = mesh(tangent(regular(n), {0, 0}, mouth(half_angle)));
      for (int i = 0; i < 200; ++i) {
        const double off = 0.02 * overlap * i, angle = 2.4 * i;
        const Vec3 centre(off * std::cos(angle), off * std::sin(angle), (radius - overlap) / std::sin(half_angle));
        const Force found = force(*cone, centre, radius), known = exact(centre, radius, {0, 0}, mouth(half_angle));
        EXPECT_LE((found.sum - known.sum).norm(), 1.05 * pi / n * known.deepest) << half_angle << ' ' << n << ' ' << i;
      }
    }
}

TEST(CurvedSurface, FlatterConesTendToTheForceOfAPlane) {
  const double radius = 0.1, overlap = 1e-4;
  double last = 2;
  for (const double half_angle : {60 * degree, 65 * degree, 70 * degree, 75 * degree, 80 * degree}) {
    const auto cone = mesh(tangent(regular(64), {0, 0}, mouth(half_angle)));
    const Force on = force(*cone, {0, 0, (radius - overlap) / std::sin(half_angle)}, radius);
    const double number = on.sum.z() / (overlap * std::sin(half_angle)), sine = std::sin(half_angle);
    EXPECT_NEAR(number, 0.5 / (sine * sine - 0.5), 1e-6) << half_angle / degree;
    EXPECT_LE(number, last + 1e-9);
    last = number;
  }
  EXPECT_NEAR(last, 1, 0.07);
}

/// Largest jump of the force between neighbours of many points of a path, over the deepest overlap: its change beyond
/// what a stiffness of 2.5 contacts makes of the step.
double largest_jump(const Geometry& geometry, double radius, int points, const std::function<Vec3(double)>& path,
                    const std::function<bool(const Force&)>& regarded) {
  double largest = 0;
  Vec3 from = path(0);
  Force last = force(geometry, from, radius);
  for (int i = 1; i <= points; ++i) {
    const Vec3 to = path(static_cast<double>(i) / points);
    const Force now = force(geometry, to, radius);
    const double jump = (now.sum - last.sum).norm() - 2.5 * (to - from).norm();
    if (regarded(last) && regarded(now)) largest = std::max(largest, jump / std::max(now.deepest, last.deepest));
    last = now, from = to;
  }
  return largest;
}
bool in_contact(const Force& force) { return force.contacts > 0; }

TEST(CurvedSurface, ForcesOfBothSidesAreContinuous) {
  const double radius = 0.2, overlap = 0.002, half_angle = 40 * degree;
  const auto held = [](const Force& force) { return force.contacts > 1 && force.least > 0.15 * force.deepest; };
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (const auto& angles : {regular(32), regular(33), irregular(64)}) {
    const auto cone = mesh(tangent(angles, {0, 0}, mouth(half_angle)));
    const auto pipe = mesh(tangent(angles, {radius - overlap, 0}, {radius - overlap, 1}));
    const auto point = [&] { return Vec3(overlap * draw(random), overlap * draw(random), overlap * draw(random)); };
    for (int i = 0; i < 30; ++i) {
      const Vec3 from = point(), to = point(), tip(0, 0, (radius - overlap) / std::sin(half_angle));
      const auto in_cone = [&](double part) { return Vec3(tip + from + part * (to - from)); };
      const auto in_pipe = [&](double part) { return Vec3(Vec3(0, 0, 0.5) + from + part * (to - from)); };
      EXPECT_LE(largest_jump(*cone, radius, 200, in_cone, held), 1e-6) << angles.size();
      EXPECT_LE(largest_jump(*pipe, radius, 200, in_pipe, held), 1e-6) << angles.size();
    }
  }
}

// From one facet to the next the direction jumps by the angle between them, as on any shallow valley.
TEST(CurvedSurface, AcrossFacetsOnlyTheDirectionJumpsByTheAngleBetweenThem) {
  for (const int n : {32, 33}) {
    const auto pipe = mesh(tangent(regular(n), {1, -1}, {1, 1}));
    for (const double radius : {0.5, 0.95, 0.999, 1.0, 1.001}) {
      const double off = std::abs(1 - radius) + 2e-3;
      const auto around = [&](double part) {
        return Vec3(off * std::cos(2 * pi * part), off * std::sin(2 * pi * part), 0.1);
      };
      const auto through = [&](double part) { return Vec3(2 * off * (part - 0.5), 0.3 * off * part, 0.1); };
      EXPECT_LE(largest_jump(*pipe, radius, 3000, around, in_contact), 2 * pi / n) << n << ", " << radius;
      EXPECT_LE(largest_jump(*pipe, radius, 6000, through, in_contact), 2 * pi / n) << n << ", " << radius;
    }
  }
}

TEST(CurvedSurface, ABallComesToRestInAConeAndInAPipe) {
  const double radius = 0.2, weight = 0.002, half_angle = 45 * degree;
  for (const auto& angles : {regular(25), regular(64), irregular(64)}) {
    const auto cone = mesh(revolved(angles, {{0, 0}, mouth(half_angle)}));
    const auto pipe = mesh(revolved(angles, {{radius / 1.01, -1}, {radius / 1.01, 1}}));
    Vec3 in_cone(0.0012, -0.0007, radius / std::sin(half_angle)), in_pipe(0.001, 0.0004, 0.1);
    double imbalance = 0;
    for (int step = 0; step < 4000; ++step) {
      const Vec3 left = force(*cone, in_cone, radius).sum - weight * Vec3::UnitZ(),
                 aside = force(*pipe, in_pipe, radius).sum;
      in_cone += 0.1 * left, in_pipe += 0.1 * aside;
      imbalance = std::max(left.norm(), aside.norm());
    }
    EXPECT_LE(imbalance, 1e-7 * weight) << angles.size();
  }
}

TEST(CurvedSurface, AGentleBowlHasOneContact) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> draw(0, 1);
  for (const int n : {60, 180}) {  // facets of 6 and 2 degrees
    std::vector<Ring> rings;
    for (int k = 0; k <= n / 4; ++k) rings.push_back({std::sin(2 * pi * k / n), -std::cos(2 * pi * k / n)});
    rings.front().radius = 0, rings.back().z = 0;
    const auto bowl = mesh(revolved(regular(n), rings));
    for (const double radius : {0.02, 0.2, 0.5, 0.8})
      for (int i = 0; i < 100; ++i) {
        const double overlap = radius * std::pow(10, -4 + 2.5 * draw(random));
        const double angle = 2 * pi * draw(random), down = 0.1 + 0.8 * draw(random);
        const Vec3 out(std::sqrt(1 - down * down) * std::cos(angle), std::sqrt(1 - down * down) * std::sin(angle),
                       -down);
        const Force on = force(*bowl, (1 - radius + overlap) * out, radius);
        ASSERT_EQ(on.contacts, 1u) << radius << ", " << overlap;
        EXPECT_NEAR(on.sum.norm(), overlap, 1.1 * (1 - std::cos(pi / n)) * 2) << "within the height of facets";
      }
  }
}

/// Walls at 30 degrees that meet in a round bottom of radius 0.1, made of facets of 3 degrees.
Corners groove() {
  Corners corners;
  std::vector<std::pair<double, double>> profile;
  for (int k = -10; k <= 10; ++k) profile.emplace_back(0.1 * std::sin(3 * k * degree), -0.1 * std::cos(3 * k * degree));
  const Vec3 wall(std::cos(30 * degree), 0, std::sin(30 * degree));
  profile.insert(profile.begin(), {profile.front().first - wall.x(), profile.front().second + wall.z()});
  profile.emplace_back(profile.back().first + wall.x(), profile.back().second + wall.z());
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const auto [x, z] = profile[i];
    const auto [to_x, to_z] = profile[i + 1];
    const Vec3 a(x, -1, z), b(to_x, -1, to_z), c(to_x, 1, to_z), d(x, 1, z);
    corners.insert(corners.end(), {a, b, c, a, c, d});
  }
  return corners;
}

TEST(CurvedSurface, ARoundGrooveHoldsALargerBallOnBothWallsAndASmallerOneAtItsBottom) {
  const auto walls = mesh(groove());
  const Vec3 middle(0, 0.1, 0);
  for (const double radius : {0.15, 0.3}) {
    const auto height = [&](double overlap) { return Vec3(0, 0, (radius - 0.1 - overlap) / std::cos(30 * degree)); };
    const auto contacts = contacts_of(*walls, middle + height(1e-3), radius);
    ASSERT_THAT(contacts, SizeIs(2));
    for (const SurfaceContact& contact : contacts) {
      EXPECT_NEAR(contact.overlap, 1e-3, 1e-12);
      EXPECT_NEAR(-contact.normal.z(), std::cos(30 * degree), 1e-12);
    }
    // As it is pressed down, the bottom carries it, too.
    const auto down = [&](double part) { return Vec3(middle + height(0.5 * (radius - 0.1) * part)); };
    EXPECT_LE(largest_jump(*walls, radius, 4000, down, in_contact), 1e-6);
  }
  EXPECT_THAT(contacts_of(*walls, middle + Vec3(0, 0, -0.021), 0.08), SizeIs(1));
}

TEST(CurvedSurface, ASphereOnARoundHoleIsHeldOnOppositeSides) {
  const double radius = 1.5, above = 1.1, distance = std::hypot(above, std::cos(pi / 64));
  const double known = 2 * (radius - distance) * above / distance;
  const auto sheet = mesh(revolved(regular(64), {{1, 0}, {2, 0}})),
             bore = mesh(revolved(regular(64), {{1, -1}, {1, 0}, {2, 0}}));
  for (const Force& on : {force(*sheet, {0, 0, above}, radius), force(*sheet, {0, 0, -above}, radius),
                          force(*bore, {0, 0, above}, radius)}) {
    EXPECT_EQ(on.contacts, 2u);
    EXPECT_LE(std::hypot(on.sum.x(), on.sum.y()), 1e-12 * on.overlaps);
    EXPECT_NEAR(std::abs(on.sum.z()) / known, 1, 0.01);
  }
}

TEST(CurvedSurface, FacetsOfSharpValleysCountOneByOne) {
  const Corners corners = revolved(regular(16), {{0, 0}, mouth(45 * degree)});  // they meet at 15.9 degrees
  const double radius = 0.2;
  const Vec3 centre(0, 0, 0.99 * radius / std::sin(45 * degree));
  const Force each = force(*mesh(corners), centre, radius),
              two = force(*mesh(corners, {{"feature_angle", 20 * degree}}), centre, radius);
  EXPECT_EQ(each.contacts, 16u);
  EXPECT_EQ(two.contacts, 2u);
  for (const Force& force : {each, two}) EXPECT_LE(std::hypot(force.sum.x(), force.sum.y()), 1e-12 * force.overlaps);
  EXPECT_NEAR(each.sum.z(), 8 * two.sum.z(), 0.01 * each.sum.z());
}

}  // namespace
}  // namespace grit::curved_surface_tests
