#include "output/scale.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace grit {

bool drawable(double value) { return std::abs(value) < 1e30; }

double nice_step(double span, int pieces) {
  const double rough = span / pieces;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double lead = rough / power;
  return power * (lead < std::sqrt(2.0) ? 1 : lead < std::sqrt(10.0) ? 2 : lead < std::sqrt(50.0) ? 5 : 10);
}

std::vector<double> ticks(double low, double high, int pieces) {
  // A narrower range is below the precision of its ends.
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high))) || !std::isfinite(high - low)) return {low};
  const double step = nice_step(high - low, pieces);
  std::vector<double> marks;
  for (auto i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) marks.push_back(i * step);
  return marks;
}

AxisTicks axis_ticks(double low, double high, AxisEnds ends, const std::function<bool(const AxisTicks&)>& fits) {
  constexpr int fewest = 4, most = 8;
  if (!std::isfinite(high - low)) low = 0, high = 1;
  constexpr double nothing = 1e-300;  // below this, steps lose precision
  if (const double size = std::max(std::abs(low), std::abs(high)); !(high - low > std::max(1e-12 * size, nothing))) {
    const double margin = size > nothing ? 0.5 * size : 1;
    low -= margin, high += margin;
  }
  std::optional<AxisTicks> best;
  for (double step = nice_step(high - low, 4 * most);; step = nice_step(2 * step, 1)) {
    const double first = ends == AxisEnds::kept ? std::ceil(low / step - 1e-9) : std::floor(low / step + 1e-9),
                 last = ends == AxisEnds::kept ? std::floor(high / step + 1e-9) : std::ceil(high / step - 1e-9);
    const double count = last - first + 1;
    if (count > most) continue;
    if (count < fewest) break;
    AxisTicks axis{low, high, step, {}};
    if (ends == AxisEnds::whole_steps) axis.low = first * step, axis.high = last * step;
    for (int i = 0; i < count; ++i) axis.marks.push_back((first + i) * step);
    best = std::move(axis);
    if (fits(*best)) break;
  }
  return best ? *best : axis_ticks(low, high, AxisEnds::whole_steps, fits);
}

}  // namespace grit
