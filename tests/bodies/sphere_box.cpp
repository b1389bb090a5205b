#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "bodies/random.hpp"
#include "grit/world.hpp"

namespace grit::sphere_box_tests {
namespace {

using std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double ball = 4 * pi / 3;
constexpr double bound = 1e-12;  // of the sphere's volume

Vec3 anywhere(Random& random, double reach) {
  const auto one = [&] { return reach * (2 * random.uniform() - 1); };
  const double x = one(), y = one(), z = one();
  return {x, y, z};
}

/// Area of the disc x² + y² < r² with x > a and y > b, whatever the signs.
long double quadrant_area(long double r, long double a, long double b) {
  if (a >= r || b >= r) return 0;
  const auto segment = [r](long double d) { return r * r * std::acos(d / r) - d * std::sqrt(r * r - d * d); };
  const auto half = [&](long double d) { return d <= -r ? std::numbers::pi_v<long double> * r * r : segment(d); };
  if (a < 0) return half(b) - quadrant_area(r, -a, b);
  if (b < 0) return half(a) - quadrant_area(r, a, -b);
  if (a * a + b * b >= r * r) return 0;
  const long double arc = std::acos(b / r) - std::asin(a / r);
  return 0.5L * (r * r * arc - b * (std::sqrt(r * r - b * b) - a) - a * (std::sqrt(r * r - a * a) - b));
}
long double rectangle_area(long double r, const Vec3& low, const Vec3& high) {
  return quadrant_area(r, low[0], low[1]) - quadrant_area(r, high[0], low[1]) - quadrant_area(r, low[0], high[1]) +
         quadrant_area(r, high[0], high[1]);
}
/// The same volume by another method: areas of discs inside the box, integrated over z = sin t by the tanh–sinh rule
/// between all heights at which a side or corner starts to cut.
double by_slices(const Vec3& low, const Vec3& high) {
  const long double from = std::max(low[2], -1.0), to = std::min(high[2], 1.0);
  if (from >= to) return 0;
  std::vector<long double> kinks{from, to};
  const auto kink = [&](double square) {
    if (square >= 1) return;
    const long double z = std::sqrt(1 - static_cast<long double>(square));
    for (const long double at : {-z, z})
      if (at > from && at < to) kinks.push_back(at);
  };
  for (const double x : {low[0], high[0], 0.0})
    for (const double y : {low[1], high[1], 0.0})
      if (std::isfinite(x) && std::isfinite(y)) kink(x * x + y * y);
  std::sort(kinks.begin(), kinks.end());
  long double sum = 0;
  for (std::size_t i = 1; i < kinks.size(); ++i) {
    const long double a = kinks[i - 1], b = kinks[i];
    constexpr long double step = 1.0L / 16;
    for (int n = -64; n <= 64; ++n) {
      const long double s = std::numbers::pi_v<long double> / 2 * std::sinh(n * step);
      const long double z = 0.5L * (a + b) + 0.5L * (b - a) * std::tanh(s);
      const long double weight = std::numbers::pi_v<long double> / 2 * std::cosh(n * step) / std::pow(std::cosh(s), 2);
      const long double square = (1 - z) * (1 + z);
      if (square > 0) sum += 0.5L * (b - a) * step * weight * rectangle_area(std::sqrt(square), low, high);
    }
  }
  return static_cast<double>(sum);
}

TEST(SphereBox, InsideOutsideAndAround) {
  const Vec3 centre(1, 2, 3);
  const auto box = [&](double low, double high) {
    return sphere_box_volume(centre, 0.5, centre + Vec3::Constant(low), centre + Vec3::Constant(high));
  };
  EXPECT_DOUBLE_EQ(box(-0.5, 0.5), ball / 8);
  EXPECT_DOUBLE_EQ(box(-infinity, infinity), ball / 8);
  EXPECT_EQ(box(0.3, 1), 0);  // outside the corner, although inside each face
  EXPECT_EQ(box(0.5, 1), 0);
  EXPECT_NEAR(box(-0.2, 0.2), 0.064, 1e-15);
  EXPECT_NEAR(box(-0.1, 0.25), 0.35 * 0.35 * 0.35, 1e-15);
  EXPECT_EQ(box(0.2, -0.2), 0);
  EXPECT_EQ(box(0.2, 0.2), 0);
}

TEST(SphereBox, CutByOnePlaneIsACap) {
  for (double d = -1; d <= 1; d += 1.0 / 64)
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 low = Vec3::Constant(-infinity), high = Vec3::Constant(infinity);
      low[axis] = d;
      const double cap = pi * (1 - d) * (1 - d) * (2 + d) / 3;
      EXPECT_NEAR(sphere_box_volume(Vec3::Zero(), 1, low, high), cap, bound);
      low[axis] = -infinity, high[axis] = d;
      EXPECT_NEAR(sphere_box_volume(Vec3::Zero(), 1, low, high), ball - cap, bound);
    }
}

TEST(SphereBox, CutByTwoOrThreePlanesThroughTheCentre) {
  const Vec3 all = Vec3::Constant(infinity);
  EXPECT_NEAR(sphere_box_volume(Vec3::Zero(), 1, Vec3(0, 0, -infinity), all), ball / 4, bound);
  EXPECT_NEAR(sphere_box_volume(Vec3::Zero(), 1, Vec3::Zero(), all), ball / 8, bound);
  // One plane through the centre, two elsewhere: half of the volume between the two.
  EXPECT_NEAR(2 * sphere_box_volume(Vec3::Zero(), 1, Vec3(0.3, 0, 0.4), all),
              sphere_box_volume(Vec3::Zero(), 1, Vec3(0.3, -infinity, 0.4), all), bound);
}

TEST(SphereBox, EdgeAndCornerThatTouchTheSphereCutNothingOff) {
  const double edge = std::sqrt(1.0 / 2), corner = std::sqrt(1.0 / 3);
  const Vec3 all = Vec3::Constant(infinity);
  EXPECT_NEAR(sphere_box_volume(Vec3::Zero(), 1, Vec3(edge, edge, -infinity), all), 0, bound);
  EXPECT_NEAR(sphere_box_volume(Vec3::Zero(), 1, Vec3::Constant(corner), all), 0, bound);
  // Columns with edges on the sphere: all caps outside their sides, none twice.
  const double cap = pi * (1 - edge) * (1 - edge) * (2 + edge) / 3;
  EXPECT_NEAR(sphere_box_volume(Vec3::Zero(), 1, Vec3(-edge, -edge, -infinity), Vec3(edge, edge, infinity)),
              ball - 4 * cap, bound);
}

TEST(SphereBox, AgreesWithSlices) {
  Random random(1);
  int partly = 0;
  for (int i = 0; i < 3000; ++i) {
    Vec3 low = anywhere(random, 1.2), high = low;
    for (int k = 0; k < 3; ++k) high[k] += 1.5 * random.uniform() * (random.below(4) == 0 ? 0.1 : 1);
    const double volume = sphere_box_volume(Vec3::Zero(), 1, low, high);
    ASSERT_NEAR(volume, by_slices(low, high), bound * ball) << low.transpose() << " … " << high.transpose();
    partly += volume > 0 && volume < (high - low).prod() * (1 - 1e-9);
  }
  EXPECT_GT(partly, 1000);
}

TEST(SphereBox, AgreesWithSlicesWhereARootNearlyVanishes) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    // Corners and edges slightly inside or outside the sphere.
    const double hair = std::pow(10, -16 + 12 * random.uniform()) * (random.below(2) == 0 ? 1 : -1);
    Vec3 low = anywhere(random, 1).cwiseAbs();
    if (random.below(2) == 0) low[static_cast<Eigen::Index>(random.below(3))] = 0;
    low *= (1 + hair) / low.norm();
    for (int k = 0; k < 3; ++k)
      if (random.below(3) == 0) low[k] = -low[k];
    const Vec3 high = Vec3::Constant(1.1);
    ASSERT_NEAR(sphere_box_volume(Vec3::Zero(), 1, low, high), by_slices(low, high), bound * ball) << low.transpose();
  }
}

TEST(SphereBox, DoesNotDependOnPlaceMirrorOrOrderOfAxes) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 low = anywhere(random, 1.2), high = low + anywhere(random, 1).cwiseAbs(), shift(0.5, -0.25, 4);
    const double radius = 0.25 + random.uniform();
    const double volume = sphere_box_volume(Vec3::Zero(), radius, low, high), all = ball * std::pow(radius, 3);
    ASSERT_NEAR(sphere_box_volume(shift, radius, low + shift, high + shift), volume, 2 * bound * all);
    ASSERT_NEAR(sphere_box_volume(Vec3::Zero(), radius, -high, -low), volume, bound * all);
    const auto turned = [](const Vec3& v) { return Vec3(v[1], v[2], v[0]); };
    ASSERT_NEAR(sphere_box_volume(Vec3::Zero(), radius, turned(low), turned(high)), volume, bound * all);
    ASSERT_NEAR(sphere_box_volume(Vec3::Zero(), 1, low / radius, high / radius), volume / std::pow(radius, 3),
                bound * ball);
  }
}

TEST(SphereBox, BoxesThatFillSpaceFillTheSphere) {
  Random random(4);
  for (int i = 0; i < 30; ++i) {
    const Vec3 centre = anywhere(random, 1);
    const double radius = 0.1 + 2 * random.uniform(), side = 0.3 + 0.4 * random.uniform();
    double sum = 0;
    for (int x = -14; x < 14; ++x)
      for (int y = -14; y < 14; ++y)
        for (int z = -14; z < 14; ++z)
          sum += sphere_box_volume(centre, radius, side * Vec3(x, y, z), side * Vec3(x + 1, y + 1, z + 1));
    const double all = ball * std::pow(radius, 3);
    EXPECT_NEAR(sum / all, 1, bound) << centre.transpose() << ' ' << radius;
  }
}

}  // namespace
}  // namespace grit::sphere_box_tests
