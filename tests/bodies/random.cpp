#include "bodies/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "bodies/normal.hpp"

namespace grit::random_tests {
namespace {

/// Σ (found − expected)² / expected; its mean is the number of classes less one, its deviation √(2 mean).
double chi_square(const std::vector<int>& found) {
  const double expected = std::accumulate(found.begin(), found.end(), 0.0) / static_cast<double>(found.size());
  double sum = 0;
  for (const int n : found) sum += (n - expected) * (n - expected) / expected;
  return sum;
}
void expect_even(const std::vector<int>& found) {
  const double freedom = static_cast<double>(found.size()) - 1;
  EXPECT_NEAR(chi_square(found), freedom, 4 * std::sqrt(2 * freedom));
}

TEST(Random, GivesThePublishedNumbers) {  // as the reference code prints them
  Random random(std::array<std::uint64_t, 4>{1, 2, 3, 4});
  for (const std::uint64_t number :
       {11520ull, 0ull, 1509978240ull, 1215971899390074240ull, 1216172134540287360ull, 607988272756665600ull,
        16172922978634559625ull, 8476171486693032832ull, 10595114339597558777ull, 2904607092377533576ull})
    EXPECT_EQ(random.bits(), number);
}

TEST(Random, SeedsByThePublishedSplitMix) {
  std::uint64_t state = 1234567;
  for (const std::uint64_t number : {6457827717110365317ull, 3203168211198807973ull, 9817491932198370423ull,
                                     4593380528125082431ull, 16408922859458223821ull})
    EXPECT_EQ(split_mix(state), number);

  Random seeded(42);  // as other implementations give it
  for (const std::uint64_t number :
       {1546998764402558742ull, 6990951692964543102ull, 12544586762248559009ull, 17057574109182124193ull})
    EXPECT_EQ(seeded.bits(), number);
}

TEST(Random, UniformNumbersFillTheUnitIntervalEvenly) {
  Random random(1);
  constexpr int count = 1'000'000;
  std::vector<int> found(100);
  double sum = 0, squares = 0, products = 0, previous = 0.5;
  for (int i = 0; i < count; ++i) {
    const double u = random.uniform();
    ASSERT_TRUE(u >= 0 && u < 1);
    ++found[static_cast<std::size_t>(u * 100)];
    sum += u, squares += u * u, products += (u - 0.5) * (previous - 0.5), previous = u;
  }
  expect_even(found);
  EXPECT_NEAR(sum / count, 1.0 / 2, 4 * std::sqrt(1.0 / 12 / count));
  EXPECT_NEAR(squares / count, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / count));
  EXPECT_NEAR(products / count, 0, 4 * 1.0 / 12 / std::sqrt(count));
}

TEST(Random, IntegersBelowALimitAreEquallyLikely) {
  Random random(2);
  std::vector<int> found(7);
  for (int i = 0; i < 700'000; ++i) ++found.at(random.below(7));
  expect_even(found);
}

TEST(Random, LargeLimitsAreNotBiased) {
  // A plain product or remainder of a 64-bit number would give a third of these twice as often.
  Random random(3);
  constexpr std::uint64_t limit = 3ull << 62;
  std::vector<int> found(12);
  for (int i = 0; i < 600'000; ++i) {
    const std::uint64_t n = random.below(limit);
    ASSERT_LT(n, limit);
    ++found[(n % 3) * 4 + n / (limit / 4)];
  }
  expect_even(found);
  EXPECT_EQ(random.below(1), 0u);
}

TEST(Random, NormalNumbersHaveNormalMomentsAndFractions) {
  Random random(4);
  constexpr int count = 1'000'000;
  std::vector<int> found(50);
  double moments[5] = {};
  for (int i = 0; i < count; ++i) {
    const double z = random.normal();
    double power = 1;
    for (double& moment : moments) moment += power / count, power *= z;
    ++found[std::min<std::size_t>(static_cast<std::size_t>(50 * 0.5 * std::erfc(-z / std::sqrt(2.0))), 49)];
  }
  expect_even(found);
  EXPECT_NEAR(moments[1], 0, 4 * std::sqrt(1.0 / count));
  EXPECT_NEAR(moments[2], 1, 4 * std::sqrt(2.0 / count));
  EXPECT_NEAR(moments[3], 0, 4 * std::sqrt(15.0 / count));
  EXPECT_NEAR(moments[4], 3, 4 * std::sqrt(96.0 / count));
}

TEST(Random, ShufflesIntoAllOrdersEquallyOften) {
  Random random(5);
  std::vector<int> found(24);
  for (int i = 0; i < 240'000; ++i) {
    std::array<int, 4> items{0, 1, 2, 3};
    random.shuffle(items);
    std::size_t order = 0;
    for (std::size_t a = 0; a < 4; ++a)
      order = order * (4 - a) + static_cast<std::size_t>(std::count_if(items.begin() + a, items.end(),
                                                                       [&](int other) { return other < items[a]; }));
    ++found.at(order);
  }
  expect_even(found);
}

TEST(Random, GivesTheSameNumbersForTheSameSeedOnly) {
  Random one(7), same(7), other(8);
  EXPECT_EQ(one.bits(), same.bits());
  EXPECT_NE(one.bits(), other.bits());
}

}  // namespace
}  // namespace grit::random_tests
