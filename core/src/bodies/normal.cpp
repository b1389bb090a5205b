#include "bodies/normal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bodies/same_bits.hpp"

namespace grit {

namespace {

using Polynomial = std::array<double, 8>;  // coefficients in ascending order

double ratio(const Polynomial& above, const Polynomial& below, double x) {
  double a = 0, b = 0;
  for (std::size_t i = above.size(); i-- > 0;) a = a * x + above[i], b = b * x + below[i];
  return a / b;
}

constexpr Polynomial centre_above{3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3,
                                  1.3731693765509461125e4, 4.5921953931549871457e4, 6.7265770927008700853e4,
                                  3.3430575583588128105e4, 2.5090809287301226727e3};
constexpr Polynomial centre_below{1,
                                  4.2313330701600911252e1,
                                  6.8718700749205790830e2,
                                  5.3941960214247511077e3,
                                  2.1213794301586595867e4,
                                  3.9307895800092710610e4,
                                  2.8729085735721942674e4,
                                  5.2264952788528545610e3};
constexpr Polynomial side_above{1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                                3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                                2.27238449892691845833e-2, 7.74545014278341407640e-4};
constexpr Polynomial side_below{1,
                                2.05319162663775882187e0,
                                1.67638483018380384940e0,
                                6.89767334985100004550e-1,
                                1.48103976427480074590e-1,
                                1.51986665636164571966e-2,
                                5.47593808499534494600e-4,
                                1.05075007164441684324e-9};
constexpr Polynomial tail_above{6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                                2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                2.71155556874348757815e-5, 2.01033439929228813265e-7};
constexpr Polynomial tail_below{1,
                                5.99832206555887937690e-1,
                                1.36929880922735805310e-1,
                                1.48753612908506148525e-2,
                                7.86869131145613259100e-4,
                                1.84631831751005468180e-5,
                                1.42151175831644588870e-7,
                                2.04426310338993978564e-15};

double density(double z) { return same_bits::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2; }

}  // namespace

double normal_fraction(double z) {
  constexpr double far = 2;
  if (z > far) return 1 - normal_fraction(-z);
  if (z < -37) return 0;
  if (z < -far) {  // Laplace's continued fraction
    double fraction = -z;
    for (int n = 100; n > 0; --n) fraction = -z + n / fraction;
    return density(z) / fraction;
  }
  // G. Marsaglia, J. Statistical Software 11 (2004) 4, doi:10.18637/jss.v011.i04
  double term = z, sum = z;
  for (int n = 3; std::abs(term) > 1e-17 * std::abs(sum); n += 2) sum += term *= z * z / n;
  return 0.5 + sum * density(z);
}

double normal_quantile(double p) {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) return q * ratio(centre_above, centre_below, 0.180625 - q * q);
  const double r = std::sqrt(-same_bits::log(std::min(p, 1 - p)));
  const double z = r <= 5 ? ratio(side_above, side_below, r - 1.6) : ratio(tail_above, tail_below, r - 5);
  return q < 0 ? -z : z;
}

}  // namespace grit
