#include "output/strays.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "output/scale.hpp"

namespace grit {
namespace {

double mean_diameter(const Frame& frame) {
  const double radii = std::accumulate(frame.radius.begin(), frame.radius.end(), 0.0);
  return frame.bodies() > 0 ? 2 * radii / static_cast<double>(frame.bodies()) : 0;
}

}  // namespace

double median(std::vector<double> numbers) {
  std::erase_if(numbers, [](double number) { return !drawable(number); });
  if (numbers.empty()) return 0;
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

Fences::Fences(const Frame& frame, const Far& far) : Fences(frame.position, mean_diameter(frame), far) {}

Fences::Fences(const std::vector<double>& positions, double diameter, const Far& far) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> finite;
    for (std::size_t i = axis; i < positions.size(); i += 3)
      if (drawable(positions[i])) finite.push_back(positions[i]);
    double lower = 0, upper = 0;
    if (!finite.empty()) {
      const auto last = static_cast<double>(finite.size() - 1);
      const auto first = finite.begin() + std::lround(0.25 * last), third = finite.begin() + std::lround(0.75 * last);
      std::nth_element(finite.begin(), first, finite.end());
      lower = *first;
      std::nth_element(first, third, finite.end());  // moves *first
      upper = *third;
    }
    const double beyond = far.widths * (upper - lower) + far.diameters * diameter;
    low_[axis] = lower - beyond, high_[axis] = upper + beyond;
  }
}

bool Fences::hold(const std::vector<double>& positions, std::size_t body) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = positions[3 * body + axis];
    if (!(at >= low_[axis] && at <= high_[axis])) return false;
  }
  return true;
}

}  // namespace grit
