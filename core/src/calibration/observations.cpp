#include "calibration/observations.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "output/reference_curve.hpp"
#include "study/number_with_unit.hpp"

namespace grit {
namespace {

/// Abscissae at which a curve is compared.
constexpr std::size_t target_points = 20;
/// Part of the target curve's range that that of a run has to cover; beyond its end its last value counts.
constexpr double least_target_reach = 0.9;

/// Reports what a target's key has, and what is allowed.
using Report = std::function<void(const char* key, const std::string& found, const std::string& allowed)>;

/// A number in a unit; an empty one is not known. Reports anything else.
std::optional<double> number_of(const Description& value, const std::string& unit, const char* key,
                                const Report& report) {
  const auto number = number_in(unit, value);
  if (!number) report(key, describe_value(value), numbers_in(unit));
  return number;
}

/// Whether misfits can be computed with a target of this magnitude.
bool can_compare(double magnitude, double tolerance, const char* key, const Report& report) {
  if (!(magnitude <= most_magnitude)) {
    report(key, fmt::format("{:g}", magnitude), fmt::format("a magnitude of at most {:g}", most_magnitude));
    return false;
  }
  const double least = std::max(least_tolerance, least_relative_tolerance * magnitude);
  if (tolerance >= least && tolerance <= most_magnitude) return true;
  report("tolerance", fmt::format("{:g}", tolerance),
         tolerance > 0
             ? fmt::format("a number from {:g} to {:g} with a target of {:g}", least, most_magnitude, magnitude)
             : std::string("a number above 0"));
  return false;
}

/// Appends those of a target whose curve has been read.
void add_curve(std::size_t index, const ReferencePoints& points, double tolerance, const std::string& unit,
               std::vector<Observation>& all) {
  const Metric curve{points.x, points.y, "", ""};
  const double from = points.x.front(), to = points.x.back();
  for (std::size_t i = 0; i < target_points; ++i) {
    const double x =
        std::clamp(from + (to - from) * static_cast<double>(i) / static_cast<double>(target_points - 1), from, to);
    all.push_back({.target = index,
                   .at = x,
                   .value = at(curve, x),
                   .tolerance = tolerance,
                   .weight = 1.0 / static_cast<double>(target_points),
                   .unit = unit});
  }
}

}  // namespace

std::vector<Observation> observations_of(const CalibrationDescription& calibration, const Document& written,
                                         const std::map<std::string, std::string>& units) {
  std::vector<Observation> all;
  std::vector<Problem> problems;
  std::size_t index = 0;
  for (const auto& [name, target] : calibration.targets) {
    const std::string pointer = "/targets/" + pointer_token(name) + '/';
    const Report report = [&](const char* key, const std::string& found, const std::string& allowed) {
      problems.push_back(written.problem(pointer + key, fault_text(found, allowed)));
    };
    const auto known = units.find(target.metric.channel());
    const std::string unit = known == units.end() ? "" : known->second;
    const auto tolerance = number_of(target.tolerance, unit, "tolerance", report);
    if (target.metric.curve) try {
        const ReferencePoints points = read_reference(*target.metric.curve);
        const double largest = std::abs(*std::ranges::max_element(points.y, {}, [](double y) { return std::abs(y); }));
        if (tolerance && can_compare(largest, *tolerance, "curve/file", report))
          add_curve(index, points, *tolerance, unit, all);
      } catch (const FileError& error) {
        problems.push_back(
            written.problem(pointer + "curve/file", missing_file_text(error, target.metric.curve->file)));
      }
    else if (const auto value = number_of(target.value, unit, "value", report);
             value && tolerance && can_compare(std::abs(*value), *tolerance, "value", report))
      all.push_back({.target = index, .value = *value, .tolerance = *tolerance, .unit = unit});
    ++index;
  }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
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
    if (std::min(to, own.x.back()) - std::max(from, own.x.front()) < least_target_reach * (to - from))
      throw NumericsError(
          fmt::format("{} has abscissae from {:g} to {:g}, the curve of the target {} from {:g} to {:g}; check the "
                      "units, and if a stage ends by a condition, choose another",
                      target.metric.of, own.x.front(), own.x.back(), name, from, to));
    for (const Observation& one : mine) all.push_back(at(own, std::clamp(one.at, own.x.front(), own.x.back())));
  }
  return all;
}

}  // namespace grit
