// Size, volume and inertia of unions of spheres, against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies/clump_body.hpp"
#include "bodies/clump_shape.hpp"
#include "bodies/random.hpp"
#include "grit/error.hpp"
#include "support/verified.hpp"

namespace grit::test::shape_tests {
namespace {

using std::numbers::pi;

/// Two unit spheres with centres `apart`: volume, and moments of inertia about the common axis and across, for a mass
/// of 1.
struct Pair {
  explicit Pair(double apart) {
    // Each half is a sphere cut at x = −h from its centre: integrals of the areas of discs along x.
    const double h = apart / 2;
    const auto power = [h](int n) { return (1 - std::pow(-h, n + 1)) / (n + 1); };  // ∫ xⁿ over −h … 1
    volume = 2 * pi * (power(0) - power(2));
    along = 2 * pi / 2 * (power(0) - 2 * power(2) + power(4)) / volume;
    const double square =
        2 * pi * (power(2) - power(4) + 2 * h * (power(1) - power(3)) + h * h * (power(0) - power(2)));
    across = along / 2 + square / volume;
  }
  double volume, along, across;
};

TEST(ClumpShape, OfOneSphereIsTheSphere) {
  const Ball one{3, -2, 1, 0.7};
  const ClumpShape shape = make_clump_shape({&one, 1});
  EXPECT_EQ(shape.spheres.front().w, 1);
  EXPECT_NEAR(xyz(shape.spheres.front()).norm(), 0, 1e-12);
  verify("volume of a sphere as a clump", shape.volume, 4 * pi / 3, 1e-5);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(shape.inertia[k], 0.4, 1e-5);
  EXPECT_NEAR(shape.volume_fractions.front(), 1, 1e-5);
}

TEST(ClumpShape, OfTwoSpheresHasTheVolumeAndInertiaOfTheirUnion) {
  for (const double apart : {0.5, 1.0, 1.5}) {
    const std::vector<Ball> balls{{0, 0, 0, 1}, {apart, 0, 0, 1}};
    const ClumpShape shape = make_clump_shape(balls);
    const Pair known(apart);
    const double size = 1 + apart / 2;  // of the enclosing sphere
    const std::string of = " of two unit spheres, " + std::to_string(apart).substr(0, 3) + " apart";
    EXPECT_NEAR(shape.spheres[0].w * size, 1, 1e-12);
    verify("volume" + of, shape.volume * std::pow(size, 3), known.volume, 1e-5);
    verify("moment of inertia along the axis" + of, shape.inertia[0] * size * size, known.along, 1e-5);
    verify("moment of inertia across the axis" + of, shape.inertia[2] * size * size, known.across, 1e-5);
    EXPECT_NEAR(shape.inertia[1], shape.inertia[2], 1e-5);
    EXPECT_NEAR(shape.volume_fractions[0], known.volume / (8 * pi / 3), 1e-5);
    EXPECT_NEAR(shape.middle.norm(), 0, 1e-5);
  }
  // Known values of benchmarks with clumps.
  EXPECT_NEAR(Pair(0.5).volume, 5.72686, 5e-6);
  EXPECT_NEAR(Pair(1.0).volume, 7.06858, 5e-6);
  EXPECT_NEAR(Pair(1.5).volume, 8.01761, 5e-6);
}

TEST(ClumpShape, IsIndependentOfRotationTranslationAndScale) {
  const std::vector<Ball> balls{{0, 0, 0, 1}, {1.1, 0.2, 0, 0.8}, {-0.3, 0.9, 0.1, 0.6}};
  const Eigen::Quaterniond turn(0.4, -0.3, 0.7, 0.2);
  std::vector<Ball> turned;
  for (const Ball& one : balls) {
    const Vec3 place = turn.normalized() * (2.5 * xyz(one)) + Vec3(4, 5, -6);
    turned.push_back({place.x(), place.y(), place.z(), 2.5 * one.w});
  }
  const ClumpShape a = make_clump_shape(balls), b = make_clump_shape(turned);
  EXPECT_NEAR(a.volume, b.volume, 1e-5 * a.volume);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a.inertia[k], b.inertia[k], 2e-5 * a.inertia[k]);
  // The arrangement of spheres about the centre of mass does not depend on the frame.
  for (std::size_t k = 1; k < balls.size(); ++k) {
    const Vec3 given = xyz(balls[k]) - xyz(balls[0]), seen = a.axes * (xyz(a.spheres[k]) - xyz(a.spheres[0]));
    EXPECT_NEAR((seen - given * a.spheres[0].w).norm(), 0, 1e-12);
  }
}

TEST(ClumpShape, CountsNothingTwice) {
  std::vector<Ball> balls{{0, 0, 0, 1}, {0.8, 0, 0, 1}};
  const ClumpShape pair = make_clump_shape(balls);
  balls.push_back({0.4, 0, 0, 0.9});  // protrudes from each, but not from both
  const ClumpShape filled = make_clump_shape(balls);
  EXPECT_NEAR(filled.volume, pair.volume, 1e-12);
  double shares = 0;
  for (std::size_t k = 0; k < balls.size(); ++k)
    shares += filled.volume_fractions[k] * 4 * pi / 3 * std::pow(filled.spheres[k].w, 3);
  EXPECT_NEAR(shares, filled.volume, 1e-12);
}

TEST(ClumpShape, EnclosesItsSpheresAsTightlyAsCanBe) {
  Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Ball> balls;
    for (int k = 0; k < 6; ++k)
      balls.push_back({random.uniform(), random.uniform(), random.uniform(), 0.4 + 0.3 * random.uniform()});
    const Ball large = smallest_enclosing(balls);
    double furthest = 0;
    for (const Ball& one : balls) furthest = std::max(furthest, (xyz(one) - xyz(large)).norm() + one.w);
    EXPECT_NEAR(furthest, large.w, 1e-11);
    // No ball nearby is smaller: the maximum distance is a convex function of the centre.
    for (int nearby = 0; nearby < 200; ++nearby) {
      const Vec3 centre =
          xyz(large) + 1e-3 * Vec3(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
      double reach = 0;
      for (const Ball& one : balls) reach = std::max(reach, (xyz(one) - centre).norm() + one.w);
      EXPECT_GT(reach, large.w - 1e-12);
    }
  }
}

/// The clump of the reference: volume of the enclosing sphere over that of the clump 2.07, of the convex hull 1.16;
/// longest over shortest diameter 1.50; spheres of 0.5 to 0.6 of the diameter.
TEST(ClumpShape, AsymmetricIsThatOfTheReference) {
  ClumpBody body;
  Parameters parameters;
  body.declare(parameters);
  const auto& shape_of = std::get<ObjectTarget>(parameters.entries().front().target());
  Parameters of_shape;
  shape_of.declare(of_shape);
  of_shape.choice()->choose("asymmetric");
  body.prepare();
  const ClumpShape& shape = *body.clump();
  ASSERT_EQ(shape.spheres.size(), 4u);
  for (const Row& one : shape.spheres) {
    EXPECT_GE(one.w, 0.5);
    EXPECT_LE(one.w, 0.6);
  }
  verify("enclosing sphere over the asymmetric clump", 4 * pi / 3 / shape.volume, 2.07, 0.015);

  // Directions on a spiral, uniform over the sphere.
  std::vector<Vec3> directions;
  const int count = 16000;
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2 * k + 1.0) / count, r = std::sqrt(1 - z * z), angle = pi * (3 - std::sqrt(5)) * k;
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  const auto reach = [&](const Vec3& u) {
    double most = 0;
    for (const Row& one : shape.spheres) most = std::max(most, u.dot(xyz(one)) + one.w);
    return most;
  };
  double longest = 0, shortest = 4;
  std::vector<double> reaches;
  for (const Vec3& u : directions) {
    const double width = reach(u) + reach(-u);
    longest = std::max(longest, width), shortest = std::min(shortest, width);
    reaches.push_back(reach(u));
  }
  verify("longest over shortest diameter of the asymmetric clump", longest / shortest, 1.50, 0.015);
  // A point is in the hull if it is on the inner side of all tangent planes. With this number of planes the volume is
  // 0.2 % too large: 1.151, 1.147 and 1.1455 with 4000, 16 000 and 40 000.
  // Most points need no plane: those in a sphere are inside, those beyond the plane across their own direction are not.
  const auto in_hull = [&](const Vec3& x) {
    const auto in_sphere = [&](const Row& one) { return (x - xyz(one)).norm() <= one.w; };
    if (std::ranges::any_of(shape.spheres, in_sphere)) return true;
    if (x.norm() > reach(x.normalized())) return false;
    for (std::size_t d = 0; d < directions.size(); ++d)
      if (x.dot(directions[d]) > reaches[d]) return false;
    return true;
  };
  int inside = 0;
  const int along = 50;  // points of a grid
  for (int k = 0; k < along * along * along; ++k) {
    const Vec3 place(k % along, k / along % along, k / (along * along));
    inside += in_hull(2.4 * ((place + Vec3::Constant(0.5)) / along - Vec3::Constant(0.5)));
  }
  verify("convex hull over the asymmetric clump", std::pow(2.4 / along, 3) * inside / shape.volume, 1.16, 0.015);
}

/// Two spheres, of radius 1 at the origin and of radius r at the distance d along x, that intersect at x = cut.
struct Unequal {
  Unequal(double r, double d) {
    const double cut = (d * d + 1 - r * r) / (2 * d);
    // The part of a ball, whose centre is at x = `at`, beyond a plane at −h from there; axis: normal of the plane.
    const auto add = [&](double radius, double h, double at, double side) {
      const auto power = [&](int n) { return (std::pow(radius, n + 1) - std::pow(-h, n + 1)) / (n + 1); };  // ∫ xⁿ
      const auto area = [&](int n) { return pi * (radius * radius * power(n) - power(n + 2)); };  // ∫ xⁿ A
      volume += area(0);
      first += at * area(0) + side * area(1);
      second += at * at * area(0) + 2 * at * side * area(1) + area(2);
      const double r4 = std::pow(radius, 4);
      along += pi / 2 * (r4 * power(0) - 2 * radius * radius * power(2) + power(4));
    };
    add(1, cut, 0, -1), add(r, d - cut, d, 1);
    centre = first / volume;
    along /= volume;
    across = along / 2 + second / volume - centre * centre;
  }
  double volume = 0, first = 0, second = 0, along = 0, centre = 0, across = 0;
};

TEST(ClumpShape, EstimatesItsError) {
  Random random(7);
  for (int trial = 0; trial < 60; ++trial) {
    const double r = 0.2 + 0.8 * random.uniform(), d = 1 - r + 2 * r * (0.02 + 0.96 * random.uniform());
    const Vec3 along = Vec3(random.normal(), random.normal(), random.normal()).normalized(), place = d * along;
    std::vector<Ball> balls{{0, 0, 0, 1}, {place.x(), place.y(), place.z(), r}};
    if (trial % 2 == 1) std::swap(balls[0], balls[1]);
    const Unequal known(r, d);
    for (const int rays : {300, 501}) {
      const ClumpShape shape = make_clump_shape(balls, rays);
      const double size = (1 + d + r) / 2;
      const auto& large = shape.spheres[as_index(trial % 2)];
      const double mass = shape.volume * std::pow(size, 3) / known.volume - 1;
      const double centre = (shape.axes * xyz(large)).dot(along) + known.centre / size;
      const Vec3 inertia = shape.inertia * size * size;
      EXPECT_LT(std::abs(mass), shape.errors.mass) << trial;
      EXPECT_LT(std::abs(centre), shape.errors.centre) << trial;
      EXPECT_LT(std::abs(inertia[0] / known.along - 1), shape.errors.inertia) << trial;
      EXPECT_LT(std::abs(inertia[1] / known.across - 1), shape.errors.inertia) << trial;
      EXPECT_LT(std::abs(inertia[2] / known.across - 1), shape.errors.inertia) << trial;
    }
  }
}

/// A long rod, whose moment of inertia about its axis is a thousandth of that across.
TEST(ClumpShape, OfALongRodHasItsInertiaAboutItsAxis) {
  const int count = 24;
  const double apart = 1.5;
  const Vec3 along = Vec3(1, 1, 0.3).normalized();
  std::vector<Ball> balls;
  for (int k = 0; k < count; ++k) {
    const Vec3 place = k * apart * along;
    balls.push_back({place.x(), place.y(), place.z(), 1});
  }
  // The two ends form a pair; each of the others is a sphere cut on both sides.
  const Pair caps(apart);
  const double h = apart / 2, volume = caps.volume + (count - 2) * 2 * pi * (h - std::pow(h, 3) / 3);
  const double about = caps.along * caps.volume + (count - 2) * pi * (h - 2 * std::pow(h, 3) / 3 + std::pow(h, 5) / 5);
  const double size = 1 + (count - 1) * apart / 2;
  const ClumpShape shape = make_clump_shape(balls);
  verify("volume of a rod of 24 spheres", shape.volume * std::pow(size, 3), volume, 1e-5);
  verify("moment of inertia of a rod of 24 spheres about its axis", shape.inertia[0] * size * size, about / volume,
         1e-4);
  EXPECT_LT(std::abs(shape.volume * std::pow(size, 3) / volume - 1), shape.errors.mass);
  EXPECT_LT(std::abs(shape.inertia[0] * size * size * volume / about - 1), shape.errors.inertia);
  EXPECT_LT(shape.errors.inertia, 1e-3);
}

TEST(ClumpShape, IsRejectedIfItsErrorIsTooLarge) {
  const std::vector<Ball> balls{{0, 0, 0, 1}, {1, 0, 0, 1}};
  try {
    make_clump_shape(balls, 12);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::AllOf(testing::HasSubstr("the error of mass, centre or inertia"),
                                         testing::HasSubstr("allowed is 0.1 %")));
  }
}

TEST(ClumpShape, MayHaveASphereThatHardlyProtrudes) {
  for (const double r : {1e-3, 1e-6, 1e-8}) {
    const std::vector<Ball> balls{{0, 0, 0, 1}, {1, 0, 0, r}, {0.9, 0.3, 0, 0.2}};
    const Ball large = smallest_enclosing(balls);
    for (const Ball& one : balls) EXPECT_LE((xyz(one) - xyz(large)).norm() + one.w, large.w * (1 + 1e-12));
    EXPECT_LE(large.w, 1.08);
    EXPECT_THAT(clump_defects(balls), testing::IsEmpty()) << r;
  }
  const std::vector<Ball> pair{{0, 0, 0, 1}, {1, 0, 0, 1e-6}};
  EXPECT_NEAR(smallest_enclosing(pair).w, 1 + 0.5e-6, 1e-9);
}

TEST(ClumpShape, IsRejectedIfItIsNotOneBody) {
  const auto found = [](const std::vector<Ball>& balls) {
    std::string all;
    for (const ClumpDefect& one : clump_defects(balls)) all += (all.empty() ? "" : "\n") + one.found;
    return all;
  };
  EXPECT_EQ(found({}), "0 spheres");
  EXPECT_EQ(found(std::vector<Ball>(65, Ball{0, 0, 0, 1})), "65 spheres");
  EXPECT_EQ(found({{0, 0, 0, 1}, {2.1, 0, 0, 1}}), "sphere 2, which is not connected with sphere 1");
  EXPECT_EQ(found({{0, 0, 0, 1}, {1, 0, 0, 1}, {4, 0, 0, 1}, {5, 0, 0, 1}}),
            "sphere 3, which is not connected with sphere 1\nsphere 4, which is not connected with sphere 1");
  EXPECT_EQ(found({{9, 0, 0, 1}, {0, 0, 0, 1}, {1, 0, 0, 1}, {0.1, 0, 0, 0.2}, {8, 0, 0, 0.1}}),
            "sphere 1, which is not connected with sphere 2\nsphere 4, which is inside sphere 2\n"
            "sphere 5, which is not connected with sphere 2");
  EXPECT_EQ(found({{0.1, 0, 0, 0.2}, {0, 0, 0, 1}}), "sphere 1, which is inside sphere 2");
  EXPECT_EQ(found({{0, 0, 0, 1}, {0, 0, 0, 1}}), "sphere 2, which is inside sphere 1")
      << "one of two equal ones is enough";
  EXPECT_EQ(found({{0, 0, 0, 1}, {1, 0, 0, 1}}), "");
  EXPECT_THROW(make_clump_shape(std::vector<Ball>{{0, 0, 0, 1}, {2.1, 0, 0, 1}}), Error);
}

}  // namespace
}  // namespace grit::test::shape_tests
