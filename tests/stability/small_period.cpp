// Periodic cells down to the length at which a grain would meet another one twice, or itself: correct above that
// length, refused below.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/error.hpp"
#include "support/mapped.hpp"
#include "support/packing.hpp"

namespace grit::test::small_period_tests {
namespace {

constexpr double radius = 1e-3;
/// Twice the reach of two equal grains at rest, with the minimum skin of 0.03 of a diameter.
constexpr double shortest = 4 * (radius + 0.03 * 2 * radius);

Description repeating(const std::vector<Grain>& grains, const Vec3& period) {
  Description d = description("linear-frictional", {{"contact_modulus", 1e7}}, grains);
  d["domain"] = {{"low", {0, 0, 0}}, {"high", vector(period)}, {"periodic", {true, true, true}}};
  d["guards"] = {{"overlap", 1}, {"travel", 0.5}, {"energy", 10}};
  return d;
}

/// Contacts of the first grains with all others, by testing every image, own images included.
std::size_t contacts(const World& world) {
  const auto x = world.positions();
  const Vec3 period = world.cell().high - world.cell().low;
  std::size_t found = 0;
  for (std::size_t a = 0; a < x.size(); ++a)
    for (std::size_t b = 0; b < x.size(); ++b)
      for (int image = 0; image < 125; ++image) {
        const Vec3 shift(image % 5 - 2, image / 5 % 5 - 2, image / 25 - 2);
        if (a == b && shift.isZero()) continue;
        const Vec3 branch = xyz(x[b]) + shift.cwiseProduct(period) - xyz(x[a]);
        found += branch.norm() < x[a].w + x[b].w ? 1 : 0;
      }
  return found / 2;
}

/// Largest difference between contacts found and actual contacts, over a number of steps of moving grains.
std::size_t missed(double period, int steps) {
  constexpr double spacing = 2.05 * radius;
  // Two layers of four along each axis except the short one.
  auto grains = jumble({4, 4, 2}, spacing, 1, 5);
  for (Grain& g : grains) g.position.z() *= period / (2 * spacing), g.radius = radius;
  Trial t(repeating(grains, {4 * spacing, 4 * spacing, period}));
  std::size_t worst = 0, most = 0;
  for (int i = 0; i < steps; ++i, t.step()) {
    const auto there = static_cast<std::ptrdiff_t>(contacts(t.world()));
    const auto found = static_cast<std::ptrdiff_t>(t.kernel().state().pairs.touching_count());
    worst = std::max(worst, static_cast<std::size_t>(std::abs(there - found)));
    most = std::max(most, static_cast<std::size_t>(there));
  }
  if (steps > 1) {
    EXPECT_GT(most, 10u);
  }
  return worst;
}

template <class Begin>
bool stops(Begin begin) {
  try {
    begin();
  } catch (const NumericsError&) {
    return true;
  }
  return false;
}
bool refused(double period) {
  return stops([&] { missed(period, 1); });
}

/// The longest refused period, by bisection; `refused` returns whether a period is refused.
template <class Refused>
double longest(Refused refused) {
  double low = 2 * radius, high = 8 * radius;
  while (high > 1.0005 * low) {
    const double middle = std::sqrt(low * high);
    (refused(middle) ? low : high) = middle;
  }
  return low;
}

TEST(SmallPeriod, IsRefusedWhereAGrainWouldMeetAnotherTwiceAndRightAbove) {
  const double low = longest([](double period) { return refused(period); });
  EXPECT_NEAR(low / shortest, 1, 1e-3);
  figure("shortest period over the largest radius and skin", 4 * low / shortest);
  for (const double share : {0.5, 0.8, 0.9, 0.99, 0.999, 1.001, 1.01, 1.1, 1.5, 2.0}) {
    const double period = share * low;
    EXPECT_EQ(refused(period), share < 1) << period / radius;
    if (share > 1) {
      EXPECT_EQ(missed(period, 200), 0u) << period / radius;
    }
  }
}

TEST(SmallPeriod, GoesByTheLargestGrainAmongSmallerOnes) {
  for (const double ratio : {1.0, 2.0, 5.0, 10.0, 30.0, 100.0}) {
    const double small = radius / ratio;
    const auto begins = [&](double period) {
      Trial t(
          repeating({{Vec3::Constant(radius), radius}, {{4 * radius, radius, radius}, small}}, {0.01, 0.01, period}));
    };
    const double low = longest([&](double period) { return stops([&] { begins(period); }); });
    const double predicted = 4 * (radius + 0.03 * (radius + small));
    EXPECT_NEAR(low / predicted, 1, 1e-3) << ratio;
    const std::string map = "shortest period that is taken, over the largest diameter|largest over smallest diameter";
    map_point(map, "refused below, taken above", ratio, low / (2 * radius));
    map_point(map, "predicted", ratio, predicted / (2 * radius));
    map_point(map, "predicted bound below which it touches itself", ratio, 1);
  }
}

TEST(SmallPeriod, SaysWhereWhatIsAllowedAndWhatToDo) {
  const std::vector<Grain> one{{Vec3::Constant(radius), radius}};
  EXPECT_NO_THROW(Trial(repeating(one, {0.01, 0.01, 1.001 * shortest})));
  try {
    Trial t(repeating(one, {0.01, 0.01, 0.999 * shortest}));
    FAIL();
  } catch (const NumericsError& error) {
    EXPECT_STREQ(
        error.what(),
        "step 0, time 0 s: /domain has a period of 0.004236 m along z, below the minimum of 0.00424 m, twice "
        "the reach of the largest body; make the domain longer along this axis, use walls instead, or compress "
        "it less");
  }
}

TEST(SmallPeriod, CellThatShrinksStopsBeforeItIsTooShort) {
  Description d = repeating({{Vec3::Constant(radius), radius}}, {0.01, 0.01, 5 * radius});
  d["domain"]["strain_rate"] = {0, 0, -1000};
  d["time_step"]["value"] = 1e-7;
  Trial t(d);
  try {
    t.step(100000);
    FAIL();
  } catch (const NumericsError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("m along z, below the minimum of "));
    const double period = t.world().cell().high.z() - t.world().cell().low.z();
    EXPECT_LT(period, shortest);
    // Checked at every neighbour search, before two grains have approached by both skins.
    EXPECT_GT(period, 4 * radius) << "before a grain is in contact with another twice";
  }
}

}  // namespace
}  // namespace grit::test::small_period_tests
