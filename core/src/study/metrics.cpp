#include "study/metrics.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "grit/error.hpp"
#include "input/document.hpp"
#include "output/read_results.hpp"
#include "study/number_with_unit.hpp"

namespace grit {
namespace {

/// The points with finite abscissa and ordinate.
Metric finite(const std::vector<double>& x, const std::vector<double>& y, const std::string& unit,
              const std::string& x_unit) {
  Metric all{{}, {}, unit, x_unit};
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) all.x.push_back(x[i]), all.y.push_back(y[i]);
  return all;
}

/// The points at which the abscissa exceeds all values before; omits backward noise.
Metric rising(const Metric& all) {
  Metric curve{{}, {}, all.unit, all.x_unit};
  for (std::size_t i = 0; i < all.x.size(); ++i)
    if (curve.x.empty() || all.x[i] > curve.x.back()) curve.x.push_back(all.x[i]), curve.y.push_back(all.y[i]);
  return curve;
}

/// The values of the last sample.
std::vector<double> last_row(const SampledChannel& channel) {
  const std::size_t row = channel.samples > 0 ? channel.values.size() / channel.samples : 0;
  return {channel.values.end() - static_cast<std::ptrdiff_t>(row), channel.values.end()};
}

/// The channel with the sampling times of a channel.
std::string time_of(const std::string& channel) { return channel.substr(0, channel.find('/')) + "/time"; }

/// The abscissa of a metric: another channel, or time, or the index in a profile.
SampledChannel abscissa_of(const MetricDescription& metric, const SampledChannel& of,
                           const std::filesystem::path& folder, const std::string& where) {
  const std::string time = time_of(metric.of), name = metric.abscissa();
  if (name.empty()) {
    SampledChannel index{.unit = "1", .doc = "index", .samples = 1, .values = std::vector<double>(last_row(of).size())};
    std::iota(index.values.begin(), index.values.end(), 0.0);
    return index;
  }
  SampledChannel against = read_channel(folder, name);
  if (against.samples != of.samples ||
      (time_of(name) != time && read_channel(folder, time_of(name)).values != read_channel(folder, time).values))
    throw FileError(where + " and " + name +
                    " are not sampled at the same times; give both probes the same interval and stages");
  if (against.values.size() != of.values.size())
    throw FileError(where + " and " + name + " differ in the number of values per sample");
  return against;
}

/// Mean of a curve between two abscissae, by the trapezoidal rule.
double mean(const Metric& curve, double from, double to) {
  if (curve.x.size() == 1) return curve.y.front();
  std::vector<double> x{from}, y{at(curve, from)};
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (curve.x[i] > from && curve.x[i] <= to) x.push_back(curve.x[i]), y.push_back(curve.y[i]);
  double area = 0;
  for (std::size_t i = 1; i < x.size(); ++i) area += 0.5 * (y[i] + y[i - 1]) * (x[i] - x[i - 1]);
  return area / (to - from);
}

/// One value of a curve.
Metric value_of(const MetricDescription& metric, const Metric& all) {
  const auto one = [](double value, const std::string& unit) { return Metric{{}, {value}, unit, ""}; };
  const auto& what = metric.what.value();
  const auto largest = std::ranges::max_element(all.y);
  if (std::holds_alternative<MaximumMetric>(what)) return one(*largest, all.unit);
  if (std::holds_alternative<PositionOfMaximumMetric>(what))
    return one(all.x[static_cast<std::size_t>(largest - all.y.begin())], all.x_unit);
  if (std::holds_alternative<MinimumMetric>(what)) return one(std::ranges::min(all.y), all.unit);
  const Metric curve = rising(all);
  if (const auto* m = std::get_if<MeanMetric>(&what)) {
    const double to = curve.x.back();
    return one(mean(curve, std::max(curve.x.front(), to - m->fraction * (to - curve.x.front())), to), all.unit);
  }
  if (const auto* v = std::get_if<ValueMetric>(&what)) {
    const auto wanted = number_in(all.x_unit, v->at);
    if (!wanted)
      throw NumericsError(fmt::format("{} has its value at {}; allowed is {}", metric.of, describe_value(v->at),
                                      numbers_in(all.x_unit)));
    const double value = at(curve, *wanted);
    if (std::isnan(value))
      throw NumericsError(fmt::format("{} has abscissae from {:g} to {:g}, but its value is required at {:g}",
                                      metric.of, curve.x.front(), curve.x.back(), *wanted));
    return one(value, all.unit);
  }
  return one(all.y.back(), all.unit);
}

}  // namespace

double at(const Metric& curve, double x) {
  const auto above = std::ranges::lower_bound(curve.x, x);
  if (above == curve.x.end() || (above == curve.x.begin() && *above != x))
    return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(above - curve.x.begin());
  if (curve.x[i] == x) return curve.y[i];
  const double fraction = (x - curve.x[i - 1]) / (curve.x[i] - curve.x[i - 1]);
  return curve.y[i - 1] + fraction * (curve.y[i] - curve.y[i - 1]);
}

Metric take_metric(const MetricDescription& metric, const std::filesystem::path& folder) {
  const SampledChannel of = read_channel(folder, metric.of);
  const std::string where = (folder / "series.h5").string() + ": " + metric.of;
  if (of.samples == 0) throw NumericsError(metric.of + " has no samples");
  const bool profile = std::holds_alternative<ProfileMetric>(metric.what.value());
  if (!profile && of.values.size() != of.samples)
    throw FileError(where + " has several values per sample, which only a profile accepts");
  const SampledChannel against = abscissa_of(metric, of, folder, where);
  const Metric all =
      finite(profile ? last_row(against) : against.values, profile ? last_row(of) : of.values, of.unit, against.unit);
  if (all.x.empty()) throw NumericsError(metric.of + " has no finite value");
  return metric.is_curve() ? rising(all) : value_of(metric, all);
}

}  // namespace grit
