#include "bodies/sizes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "grit/error.hpp"

namespace grit::sizes_tests {
namespace {

/// The maximum distance between the curve of a sample and the target; each grain has the weight d^power.
double curve_error(std::vector<double> sample, int power, const std::function<double(double)>& wanted) {
  std::sort(sample.begin(), sample.end());
  const auto weight = [power](double d) { return std::pow(d, power); };
  const double all =
      std::accumulate(sample.begin(), sample.end(), 0.0, [&](double s, double d) { return s + weight(d); });
  double below = 0, worst = 0;
  for (const double d : sample) {
    const double next = below + weight(d) / all;
    worst = std::max({worst, std::abs(below - wanted(d)), std::abs(next - wanted(d))});
    below = next;
  }
  return worst;
}

/// Mass fraction of the largest grain: the effect of one grain.
double share_of_largest(const std::vector<double>& sample) {
  double all = 0, largest = 0;
  for (const double d : sample) all += d * d * d, largest = std::max(largest, d * d * d);
  return largest / all;
}

double line(const std::vector<double>& x, const std::vector<double>& y, double at) {
  for (std::size_t i = 1; i < x.size(); ++i)
    if (at <= x[i]) return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
  return 1;
}

TEST(Sizes, UniformIsEvenByNumber) {
  Random random(1);
  const auto sample = draw_diameters(UniformSizes{1e-3, 3e-3}, 1000, random);
  EXPECT_LT(curve_error(sample, 0, [](double d) { return (d - 1e-3) / 2e-3; }), 0.51 / 1000);
}

TEST(Sizes, LinearIsEvenByMass) {
  for (const std::size_t count : {100u, 1000u, 100'000u}) {
    Random random(1);
    const auto sample = draw_diameters(LinearSizes{0.25e-3, 0.75e-3}, count, random);
    ASSERT_EQ(sample.size(), count);
    EXPECT_LT(curve_error(sample, 3, [](double d) { return (d - 0.25e-3) / 0.5e-3; }), share_of_largest(sample));
    EXPECT_LT(share_of_largest(sample), 9.0 / static_cast<double>(count));  // the bound is proportional to 1/N
  }
}

TEST(Sizes, SieveCurveByMassIsMet) {
  // With an empty fraction in the middle, and one to ten in size.
  const SieveSizes sieve{{0.1e-3, 0.2e-3, 0.4e-3, 0.5e-3, 1e-3}, {0, 0.3, 0.3, 0.8, 1}};
  for (const std::size_t count : {1000u, 10'000u, 100'000u}) {
    Random random(1);
    const auto sample = draw_diameters(sieve, count, random);
    EXPECT_LT(curve_error(sample, 3, [&](double d) { return line(sieve.diameters, sieve.passing, d); }),
              share_of_largest(sample));
    EXPECT_LT(share_of_largest(sample), 120.0 / static_cast<double>(count));
    for (const double d : sample) ASSERT_TRUE((d >= 0.1e-3 && d <= 0.2e-3) || (d >= 0.4e-3 && d <= 1e-3)) << d;
  }
}

TEST(Sizes, LogNormalIsTruncated) {
  for (const LogNormalSizes sizes : {LogNormalSizes{0.5e-3, 0.25, 0.25e-3, 1e-3},     // both sides
                                     LogNormalSizes{0.5e-3, 0.25, 0.6e-3, 1e-3},      // above the median
                                     LogNormalSizes{0.5e-3, 0.1, 0.1e-3, 0.25e-3},    // far below: z = −16 … −7
                                     LogNormalSizes{0.5e-3, 0.1, 1.1e-3, 1.5e-3}}) {  // far above: z = 8 … 11
    Random random(1);
    const auto sample = draw_diameters(sizes, 2000, random);
    // Fractions from the nearer tail, as those from the other are inaccurate.
    const double sign = sizes.largest > sizes.median ? -1 : 1;
    const auto share = [&](double d) {
      return 0.5 * std::erfc(-sign * std::log(d / sizes.median) / sizes.log_standard_deviation / std::sqrt(2.0));
    };
    const double first = share(sizes.smallest), last = share(sizes.largest);
    EXPECT_LT(curve_error(sample, 0, [&](double d) { return (share(d) - first) / (last - first); }), 0.51 / 2000);
    EXPECT_GE(*std::min_element(sample.begin(), sample.end()), sizes.smallest);
    EXPECT_LE(*std::max_element(sample.begin(), sample.end()), sizes.largest);
  }
}

TEST(Sizes, ListIsCycledInItsOrder) {
  Random random(1);
  EXPECT_THAT(draw_diameters(ListSizes{{3, 1, 2}}, 5, random), testing::ElementsAre(3, 1, 2, 3, 1));
}

TEST(Sizes, OrderIsRandomAndOfTheSeed) {
  Random one(1), same(1), other(2);
  const LinearSizes sizes{1e-3, 2e-3};
  const auto sample = draw_diameters(sizes, 1000, one);
  EXPECT_EQ(sample, draw_diameters(sizes, 1000, same));
  EXPECT_NE(sample, draw_diameters(sizes, 1000, other));
  // Neighbours in the order are uncorrelated.
  const double mean = std::accumulate(sample.begin(), sample.end(), 0.0) / 1000;
  double together = 0, alone = 0;
  for (std::size_t i = 1; i < sample.size(); ++i) {
    together += (sample[i] - mean) * (sample[i - 1] - mean);
    alone += (sample[i] - mean) * (sample[i] - mean);
  }
  EXPECT_LT(std::abs(together / alone), 4 / std::sqrt(1000.0));
}

TEST(Sizes, ReportErrorsInASieveCurve) {
  Random random(1);
  const auto message = [&](const SieveSizes& sizes) -> std::string {
    try {
      draw_diameters(sizes, 10, random);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  for (const SieveSizes& wrong :
       {SieveSizes{{1, 2}, {0, 0.9}}, SieveSizes{{2, 1}, {0, 1}}, SieveSizes{{1, 2, 3}, {0, 1}},
        SieveSizes{{0, 2}, {0, 1}}, SieveSizes{{1, 2, 3}, {0, 1.5, 1}}, SieveSizes{}})
    EXPECT_THAT(message(wrong), testing::HasSubstr("`passing` must not decrease from 0 to 1"));
  EXPECT_EQ(message(SieveSizes{{1, 2}, {0, 1}}), "");
  EXPECT_THROW(draw_diameters(ListSizes{}, 1, random), Error);
}

}  // namespace
}  // namespace grit::sizes_tests
