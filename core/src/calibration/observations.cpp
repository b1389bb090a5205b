#include "calibration/observations.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "grit/error.hpp"
#include "output/reference_curve.hpp"

namespace grit {
namespace {

/// Abscissae at which a curve is compared.
constexpr std::size_t curve_points = 20;
/// Part of the wanted curve's range that that of a run has to cover; beyond its end its last value counts.
constexpr double least_reach = 0.9;

}  // namespace

std::vector<Observation> observations_of(const CalibrationDescription& calibration) {
  std::vector<Observation> all;
  std::size_t index = 0;
  for (const auto& [name, target] : calibration.targets) {
    if (target.metric.value)
      all.push_back({.target = index, .wanted = *target.metric.value, .tolerance = target.tolerance});
    if (target.metric.curve) {
      const ReferencePoints points = read_reference(*target.metric.curve);
      const Metric wanted{points.x, points.y, "", ""};
      const double from = points.x.front(), to = points.x.back();
      for (std::size_t i = 0; i < curve_points; ++i) {
        const double x =
            std::clamp(from + (to - from) * static_cast<double>(i) / static_cast<double>(curve_points - 1), from, to);
        all.push_back({.target = index,
                       .at = x,
                       .wanted = at(wanted, x),
                       .tolerance = target.tolerance,
                       .weight = 1.0 / static_cast<double>(curve_points)});
      }
    }
    ++index;
  }
  return all;
}

std::vector<double> found_in(const CalibrationDescription& calibration, const std::vector<Observation>& observations,
                             const std::map<std::string, Metric>& metrics) {
  std::vector<double> all;
  std::size_t index = 0;
  for (const auto& [name, target] : calibration.targets) {
    const Metric& own = metrics.at(name);
    const auto mine = std::ranges::equal_range(observations, index++, {}, &Observation::target);
    if (!target.metric.is_curve()) {
      all.push_back(own.y.front());
      continue;
    }
    const double from = mine.front().at, to = mine.back().at;
    if (std::min(to, own.x.back()) - std::max(from, own.x.front()) < least_reach * (to - from))
      throw NumericsError(
          fmt::format("{} has abscissae from {:g} to {:g}, the curve of the target {} from {:g} to {:g}; check the "
                      "units, and if a stage ends by a condition, choose another",
                      target.metric.of, own.x.front(), own.x.back(), name, from, to));
    for (const Observation& one : mine) all.push_back(at(own, std::clamp(one.at, own.x.front(), own.x.back())));
  }
  return all;
}

}  // namespace grit
