#include "study/sweep_chart.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "format/number.hpp"
#include "format/symbols.hpp"
#include "output/colours.hpp"
#include "output/svg.hpp"
#include "study/number_with_unit.hpp"

namespace grit {
namespace {

constexpr double plot_width = 720, plot_height = 400, plot_left = 84, plot_right = 690, plot_top = 34,
                 plot_bottom = 342;
/// Beyond this ratio of levels the axis is logarithmic.
constexpr double wide_range = 20;

double or_zero(double value) { return std::isfinite(value) ? value : 0; }

/// The ends of what a chart shows.
struct Span {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void include(double value) { low = std::min(low, value), high = std::max(high, value); }
  bool empty() const { return !(low <= high); }
};

/// A linear axis, a little longer than what it shows.
class LinearAxis {
 public:
  LinearAxis(Span shown, double from, double to) : from_(from), to_(to) {
    double size = shown.high - shown.low;
    if (!(size > 0)) size = std::max(1e-12, std::abs(shown.high));
    low_ = shown.low - 0.06 * size, high_ = shown.high + 0.06 * size;
  }
  double operator()(double value) const { return from_ + (value - low_) / (high_ - low_) * (to_ - from_); }
  double step() const {
    const double rough = (high_ - low_) / 5, power = std::pow(10, std::floor(std::log10(rough)));
    return rough > 5 * power ? 10 * power : rough > 2 * power ? 5 * power : rough > power ? 2 * power : power;
  }
  std::vector<double> marks() const {
    std::vector<double> all;
    for (double i = std::ceil(low_ / step()); i * step() <= high_; ++i) all.push_back(i * step());
    return all;
  }

 private:
  double low_ = 0, high_ = 1, from_, to_;
};

/// The abscissae of a setting's levels: their numbers if all have the same unit, else their indices.
struct LevelAxis {
  explicit LevelAxis(const SettingDescription& setting) {
    bool same = true, positive = true;
    for (std::size_t level = 0; level < setting.levels(); ++level) {
      const auto one = number_with_unit(setting.label(level));
      same = same && one && (level == 0 || one->unit == unit);
      if (!same) break;
      unit = one->unit, positive = positive && one->number > 0, at.push_back(one->number);
    }
    if (same && positive && std::ranges::max(at) > wide_range * std::ranges::min(at))
      for (double& value : at) value = std::log10(value);
    if (same) return;
    unit.clear(), at.clear();
    for (std::size_t level = 0; level < setting.levels(); ++level) at.push_back(static_cast<double>(level));
  }
  std::string unit;
  std::vector<double> at;
};

/// A variant at a level of the setting.
struct AtLevel {
  std::size_t level;
  const VariantResult* variant;
};

/// The variants by the levels of all settings but one: the label of these levels, and the variants in the order of
/// their abscissae. One at a time only variants with the usual levels count.
std::vector<std::pair<std::string, std::vector<AtLevel>>> lines_of(const StudyResult& result,
                                                                   const std::string& setting,
                                                                   const std::vector<double>& at) {
  const auto& settings = result.study.settings;
  const auto k = static_cast<std::size_t>(std::distance(settings.begin(), settings.find(setting)));
  std::map<std::vector<std::size_t>, std::vector<AtLevel>> lines;
  for (const VariantResult& one : result.variants) {
    auto others = one.variant.levels;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    lines[others].push_back({one.variant.levels[k], &one});
  }
  std::vector<std::pair<std::string, std::vector<AtLevel>>> all;
  for (auto& [others, line] : lines) {
    std::string label;
    bool usual = true;
    std::size_t i = 0;
    for (const auto& [name, other] : settings) {
      if (name == setting) continue;
      usual = usual && others[i] == other.usual_level();
      label += (label.empty() ? "" : ", ") + name + "=" + other.label(others[i++]);
    }
    if (result.study.vary == "one-at-a-time" && !usual) continue;
    std::ranges::sort(line, {}, [&](const AtLevel& one) { return at[one.level]; });
    all.emplace_back(result.study.vary == "one-at-a-time" ? "" : label, std::move(line));
  }
  return all;
}

const char* line_colour(std::size_t i) { return series_colours[i % series_colours.size()]; }

void draw_ordinate(Svg& svg, const LinearAxis& y, const std::string& title) {
  for (const double mark : y.marks()) {
    svg.line({plot_left, y(mark)}, {plot_right, y(mark)}, "class=\"grid\"");
    svg.text({plot_left - 8, y(mark) + 4}, tick_label(mark, y.step()), "class=\"e\"");
  }
  svg.line({plot_left, plot_bottom}, {plot_right, plot_bottom}, "class=\"frame\"");
  svg.line({plot_left, plot_top}, {plot_left, plot_bottom}, "class=\"frame\"");
  svg.text({8, plot_top - 14}, title, "class=\"axis\"");
}

void draw_legend(Svg& svg, std::size_t i, const std::string& label) {
  if (label.empty()) return;
  const double down = plot_top + 14 + 16 * static_cast<double>(i);
  svg.line({plot_right - 190, down - 4}, {plot_right - 168, down - 4},
           fmt::format("style=\"stroke:{}\" class=\"curve\"", line_colour(i)));
  svg.text({plot_right - 162, down}, label, "class=\"small\"");
}

}  // namespace

std::string sweep_chart(const StudyResult& result, const std::string& metric, const std::string& setting) {
  const SettingDescription& levels = result.study.settings.at(setting);
  const LevelAxis axis(levels);
  const auto lines = lines_of(result, setting, axis.at);
  const auto& given = result.study.metrics.at(metric).value;
  Span xs, ys;
  std::string unit;
  for (const double value : axis.at) xs.include(value);
  for (const auto& [label, line] : lines)
    for (const AtLevel& one : line) {
      const auto value = one.variant->values.find(metric);
      if (value == one.variant->values.end()) continue;
      unit = value->second.unit;
      const double spread = or_zero(value->second.standard_error());
      ys.include(value->second.mean - spread), ys.include(value->second.mean + spread);
    }
  if (ys.empty()) return "";
  if (given) ys.include(*given);
  const ReadableUnit shown = readable(unit, std::max(std::abs(ys.low), std::abs(ys.high)));
  ys.low *= shown.factor, ys.high *= shown.factor;

  Svg svg(plot_width, plot_height, metric + " against " + setting, "");
  const LinearAxis x(xs, plot_left, plot_right), y(ys, plot_bottom, plot_top);
  draw_ordinate(svg, y, axis_title(metric, shown.unit));
  for (std::size_t level = 0; level < levels.levels(); ++level) {
    svg.line({x(axis.at[level]), plot_top}, {x(axis.at[level]), plot_bottom}, "class=\"grid\"");
    const auto number = number_with_unit(levels.label(level));
    svg.text({x(axis.at[level]), plot_bottom + 18},
             axis.unit.empty() || !number ? levels.label(level) : fmt::format("{:g}", number->number), "class=\"m\"");
  }
  svg.text({(plot_left + plot_right) / 2, plot_bottom + 40}, axis_title(setting, axis.unit), "class=\"axis m\"");
  if (given) {
    const double down = y(shown.factor * *given);
    svg.line({plot_left, down}, {plot_right, down}, "class=\"wish\"");
    svg.text({plot_left + 6, down - 6}, "given value", "class=\"small\"");
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& [label, line] = lines[i];
    std::vector<Point> points;
    const std::string look = fmt::format("style=\"stroke:{}\"", line_colour(i));
    for (const AtLevel& one : line) {
      const auto value = one.variant->values.find(metric);
      if (value == one.variant->values.end()) continue;
      const double across = x(axis.at[one.level]), mean = shown.factor * value->second.mean,
                   spread = shown.factor * or_zero(value->second.standard_error());
      points.push_back({across, y(mean)});
      if (spread > 0) svg.line({across, y(mean - spread)}, {across, y(mean + spread)}, look + " class=\"spread\"");
      svg.circle({across, y(mean)}, 4, fmt::format("style=\"fill:{}\"", line_colour(i)));
    }
    if (points.size() > 1) svg.polyline(points, look + " class=\"curve\"");
    draw_legend(svg, i, label);
  }
  return std::move(svg).finish();
}

std::string sweep_curves(const StudyResult& result, const std::string& metric, const std::string& setting) {
  const SettingDescription& levels = result.study.settings.at(setting);
  const LevelAxis axis(levels);
  const auto& settings = result.study.settings;
  std::vector<std::pair<std::size_t, const MeanCurve*>> curves;
  Span xs, ys;
  for (const VariantResult& one : result.variants) {
    const auto curve = one.curves.find(metric);
    if (curve == one.curves.end()) continue;
    std::size_t i = 0, own = 0;
    bool usual = true;
    for (const auto& [name, other] : settings) {
      if (name == setting) own = one.variant.levels[i];
      else usual = usual && one.variant.levels[i] == other.usual_level();
      ++i;
    }
    if (!usual) continue;
    curves.emplace_back(own, &curve->second);
    for (const double value : curve->second.x) xs.include(value);
    for (const double value : curve->second.mean) ys.include(value);
  }
  if (curves.empty() || xs.empty() || ys.empty()) return "";
  std::ranges::sort(curves, {}, [](const auto& one) { return one.first; });
  const MeanCurve& first = *curves.front().second;
  const ReadableUnit across = readable(first.x_unit, std::max(std::abs(xs.low), std::abs(xs.high))),
                     up = readable(first.unit, std::max(std::abs(ys.low), std::abs(ys.high)));
  for (double* end : {&xs.low, &xs.high}) *end *= across.factor;
  for (double* end : {&ys.low, &ys.high}) *end *= up.factor;

  Svg svg(plot_width, plot_height, metric + " by " + setting, "");
  const LinearAxis x(xs, plot_left, plot_right), y(ys, plot_bottom, plot_top);
  draw_ordinate(svg, y, axis_title(metric, up.unit));
  for (const double mark : x.marks()) svg.text({x(mark), plot_bottom + 18}, tick_label(mark, x.step()), "class=\"m\"");
  const std::string against = result.study.metrics.at(metric).against;
  svg.text({(plot_left + plot_right) / 2, plot_bottom + 40},
           axis_title(against.empty() ? "abscissa" : against, across.unit), "class=\"axis m\"");
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const auto& [level, curve] = curves[i];
    std::vector<Point> points;
    for (std::size_t k = 0; k < curve->x.size(); ++k)
      points.push_back({x(across.factor * curve->x[k]), y(up.factor * curve->mean[k])});
    svg.polyline(points, fmt::format("style=\"stroke:{}\" class=\"curve\"", line_colour(i)));
    draw_legend(svg, i, setting + "=" + levels.label(level));
  }
  return std::move(svg).finish();
}

}  // namespace grit
