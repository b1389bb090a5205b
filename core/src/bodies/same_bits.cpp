#include "bodies/same_bits.hpp"

#include <cmath>
#include <numbers>

namespace grit::same_bits {

namespace {
// ln 2 in two parts; k × high is exact for every exponent k of a double.
constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;
}  // namespace

double exp(double x) {
  const double k = std::floor(x * std::numbers::log2e + 0.5);
  const double r = (x - k * ln2_high) - k * ln2_low;  // |r| ≤ ½ ln 2: Taylor's remainder is below 1e-18
  double sum = 1;
  for (int n = 14; n > 0; --n) sum = 1 + r / n * sum;
  return std::ldexp(sum, static_cast<int>(k));
}

double log(double x) {
  int exponent;
  double m = std::frexp(x, &exponent);
  if (m < 0.5 * std::numbers::sqrt2) m *= 2, --exponent;
  const double s = (m - 1) / (m + 1), square = s * s;  // ln m = 2 artanh s, |s| < 0.172
  double sum = 0;
  for (int n = 25; n > 0; n -= 2) sum = sum * square + 1.0 / n;
  return exponent * ln2_high + (exponent * ln2_low + 2 * s * sum);
}

}  // namespace grit::same_bits
