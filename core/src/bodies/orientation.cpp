#include "bodies/orientation.hpp"

#include <cmath>
#include <numbers>

namespace grit {

Eigen::Quaterniond any_orientation(Random& random) {
  const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform(),
               b = 2 * std::numbers::pi * random.uniform();
  const double p = std::sqrt(1 - u), q = std::sqrt(u);
  return {p * std::sin(a), p * std::cos(a), q * std::sin(b), q * std::cos(b)};
}

}  // namespace grit
