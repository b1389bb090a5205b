#include "bodies/normal.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "bodies/random.hpp"
#include "bodies/same_bits.hpp"

namespace grit::normal_tests {
namespace {

double share_by_library(double z) {
  return static_cast<double>(0.5L * std::erfc(-static_cast<long double>(z) / std::sqrt(2.0L)));
}

TEST(SameBits, ExpAndLogKeepToTheirBounds) {
  for (int i = -70'000; i <= 70'000; ++i) {
    const double x = 0.01 * i;
    const auto exact = std::exp(static_cast<long double>(x));
    ASSERT_NEAR(static_cast<double>(same_bits::exp(x) / exact), 1, 1e-15) << x;
  }
  Random random(1);
  for (int i = 0; i < 100'000; ++i) {
    const double x = std::ldexp(0.5 + random.uniform(), static_cast<int>(random.below(600)) - 300);
    const auto exact = std::log(static_cast<long double>(x));
    ASSERT_LT(std::abs(same_bits::log(x) - exact), std::max(1e-15L * std::abs(exact), 1e-16L)) << x;
  }
  EXPECT_EQ(same_bits::exp(0), 1);
  EXPECT_EQ(same_bits::log(1), 0);
}

TEST(Normal, FractionAgreesWithTheErrorFunction) {
  for (int i = -3000; i <= 800; ++i) {
    const double z = 0.01 * i, exact = share_by_library(z);
    ASSERT_NEAR(normal_fraction(z) / exact, 1, 1e-13) << z;
  }
  EXPECT_EQ(normal_fraction(-50), 0);
  EXPECT_EQ(normal_fraction(50), 1);
}

TEST(Normal, QuantileInvertsTheErrorFunctionToItsBound) {
  // The error of the fraction divided by the slope is an error of z; the rest is that of the approximation.
  double worst = 0;
  for (int i = -3000; i < 400; ++i) {
    const double z = 0.01 * i + 0.005;
    const long double exact = 0.5L * std::erfc(-static_cast<long double>(z) / std::sqrt(2.0L));
    const auto p = static_cast<double>(exact);
    const long double slope = std::exp(-0.5L * z * z) / std::sqrt(2 * 3.14159265358979323846L);
    const auto z_of_p = static_cast<double>(z + (p - exact) / slope);
    // 1 − p is exact for p > ½: no further error there.
    worst = std::max(worst, std::abs(normal_quantile(p) / z_of_p - 1));
  }
  EXPECT_LT(worst, 2e-15);
  EXPECT_EQ(normal_quantile(0.5), 0);
  EXPECT_EQ(normal_quantile(0.25), -normal_quantile(0.75));
}

TEST(Normal, GivesTheSameBitsAsAnIndependentProgram) {
  // The same formulas in Python, without fused multiply–add.
  Random random(1);
  for (const double z : {0x1.10ce225352b8ep-1, 0x1.a3d5daeb32d73p-5, 0x1.7ea4498f9aa47p-3, -0x1.1a7a7edcabd89p-2,
                         0x1.0858cc5658fe3p-1, -0x1.107d04eadf01bp+0, -0x1.77d22ce5851b4p+0, -0x1.35a0de89936e9p-2})
    EXPECT_EQ(random.normal(), z);
  std::uint64_t digest = 0;
  random = Random(1);
  for (int i = 0; i < 100'000; ++i)
    digest = digest * 6364136223846793005u + std::bit_cast<std::uint64_t>(same_bits::exp(random.normal()));
  EXPECT_EQ(digest, 0xda2f10345559f3c9u);
}

}  // namespace
}  // namespace grit::normal_tests
