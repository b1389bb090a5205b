// How fast an error vanishes.
#pragma once

#include <cmath>
#include <vector>

namespace grit::test {

/// Slope of the straight line through the logarithms of errors over sizes, by least squares.
inline double order(const std::vector<double>& sizes, const std::vector<double>& errors) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double u = std::log(sizes[i]), v = std::log(std::abs(errors[i]));
    x += u, y += v, xx += u * u, xy += u * v;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace grit::test
