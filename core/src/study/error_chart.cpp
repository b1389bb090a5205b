#include "study/error_chart.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "output/colours.hpp"
#include "output/svg.hpp"
#include "study/study_sentences.hpp"

namespace grit {
namespace {

/// A logarithmic axis with limits at 1, 2 or 5 times a power of ten.
class LogAxis {
 public:
  LogAxis(double low, double high, double from, double to) : from_(from), to_(to) {
    low_ = std::log10(mark_below(low)), high_ = std::log10(mark_above(high));
    if (!(high_ > low_)) high_ = low_ + 1;
  }
  double operator()(double value) const {
    return from_ + (std::clamp(std::log10(value), low_, high_) - low_) / (high_ - low_) * (to_ - from_);
  }
  std::vector<double> marks() const {
    std::vector<double> all;
    const bool dense = high_ - low_ < 2.4;
    for (double power = std::floor(low_); power <= high_ + 1e-9; ++power)
      for (const double lead : {1.0, 2.0, 5.0}) {
        const double exponent = power + std::log10(lead);
        if ((dense || lead == 1) && exponent >= low_ - 1e-9 && exponent <= high_ + 1e-9)
          all.push_back(lead * std::pow(10, power));
      }
    return all;
  }

 private:
  static double mark_below(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    return value >= 5 * power ? 5 * power : value >= 2 * power ? 2 * power : power;
  }
  static double mark_above(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    return value <= power ? power : value <= 2 * power ? 2 * power : value <= 5 * power ? 5 * power : 10 * power;
  }
  double low_, high_, from_, to_;
};

/// Error of one metric, or of the worst metric, against cost.
class ErrorChart {
 public:
  /// `metric`: empty for the worst of each variant.
  ErrorChart(const StudyResult& result, std::string metric) : result_(result), metric_(std::move(metric)) {}

  std::string svg() const {
    Svg svg(width, height, title(), "");
    double least = result_.study.tolerance, largest = result_.study.tolerance, cheapest = 1e300, dearest = 0;
    for (const VariantResult& one : result_.variants) {
      if (one.core_seconds > 0)
        cheapest = std::min(cheapest, one.core_seconds), dearest = std::max(dearest, one.core_seconds);
      if (!one.complete()) continue;
      const double error = of(one).error;
      if (error > 0)
        least = std::min(least, error), largest = std::max(largest, error + finite(of(one).standard_error));
    }
    if (dearest == 0) return "";
    const double floor =
        finite(reference().scatter) * std::sqrt(2.0 / static_cast<double>(result_.study.seeds.values.size()));
    if (floor > 0) least = std::min(least, 0.7 * floor);
    const LogAxis x(0.9 * cheapest, 1.1 * dearest, left, right), y(std::max(least, 1e-6), largest, bottom, top);

    if (floor > 0) {
      svg.rectangle({left, y(floor)}, right - left, bottom - y(floor), "class=\"floor\"");
      svg.text({left + 6, bottom - 8}, "scatter between samples: " + percent(floor), "class=\"small\"");
    }
    for (const double mark : x.marks()) {
      svg.line({x(mark), top}, {x(mark), bottom}, "class=\"grid\"");
      svg.text({x(mark), bottom + 18}, cost_text(mark), "class=\"m\"");
    }
    for (const double mark : y.marks()) {
      svg.line({left, y(mark)}, {right, y(mark)}, "class=\"grid\"");
      svg.text({left - 8, y(mark) + 4}, fmt::format("{:g} %", 100 * mark), "class=\"e\"");
    }
    svg.line({left, bottom}, {right, bottom}, "class=\"frame\"");
    svg.line({left, top}, {left, bottom}, "class=\"frame\"");
    svg.line({left, y(result_.study.tolerance)}, {right, y(result_.study.tolerance)}, "class=\"wish\"");
    svg.text({right - 6, y(result_.study.tolerance) - 6}, "tolerance " + percent(result_.study.tolerance),
             "class=\"small e\"");
    svg.text({left - 50, top - 14}, title(), "class=\"axis\"");
    svg.text({(left + right) / 2, bottom + 40}, "core-seconds per run", "class=\"axis m\"");
    front(svg, x, y);
    for (std::size_t i = result_.variants.size(); i-- > 0;) point(svg, x, y, i);  // the usual variant, number 1, on top
    return std::move(svg).finish();
  }

 private:
  static constexpr double width = 720, height = 400, left = 62, right = 690, top = 34, bottom = 342;

  static double finite(double value) { return std::isfinite(value) ? value : 0; }
  const Deviation& of(const VariantResult& one) const {
    return metric_.empty() ? one.of_worst() : one.deviations.at(metric_);
  }
  /// Scatter of the finest variant; the largest if there are several metrics.
  Deviation reference() const {
    Deviation largest;
    largest.scatter = 0;
    if (result_.finest().complete())
      for (const auto& [name, one] : result_.finest().deviations)
        if (metric_.empty() || metric_ == name) largest.scatter = std::max(largest.scatter, finite(one.scatter));
    return largest;
  }
  std::string title() const { return deviation_title(result_.study, metric_); }

  void front(Svg& svg, const LogAxis& x, const LogAxis& y) const {
    std::vector<const VariantResult*> all;
    for (const VariantResult& one : result_.variants)
      if (one.complete() && of(one).error > 0) all.push_back(&one);
    std::ranges::sort(all, {}, &VariantResult::core_seconds);
    std::vector<Point> points;
    double least = 1e300;
    for (const VariantResult* one : all) {
      if (!(of(*one).error < least)) continue;
      if (!points.empty()) points.push_back({x(one->core_seconds), points.back().y});
      least = of(*one).error;
      points.push_back({x(one->core_seconds), y(least)});
    }
    // The finest variant is the reference: its error is 0, at the bottom of the chart.
    if (const VariantResult& finest = result_.finest(); !points.empty() && finest.complete() && of(finest).error <= 0 &&
                                                        finest.core_seconds > all.front()->core_seconds) {
      const double across = std::max(x(finest.core_seconds), points.back().x);
      points.push_back({across, points.back().y}), points.push_back({across, bottom});
    }
    if (points.size() > 1) svg.polyline(points, "class=\"front\"");
  }

  void point(Svg& svg, const LogAxis& x, const LogAxis& y, std::size_t i) const {
    const VariantResult& one = result_.variants[i];
    if (one.core_seconds == 0 && one.complete()) return;
    const std::string number = std::to_string(i + 1);
    if (!one.complete()) {
      const auto failed = std::ranges::find(one.samples, "failed", &Sample::status);
      if (failed == one.samples.end()) return;
      const double across = std::max(left + 16, x(std::max(failed->core_seconds, 1e-3)));
      svg.text({across, top + 12 + 13 * (i % 3)}, "✕" + number, "class=\"m failed\"");
      return;
    }
    const double across = x(one.core_seconds), error = of(one).error, spread = finite(of(one).standard_error);
    const std::string look = fmt::format("style=\"fill:{0};stroke:{0}\"", colour_of(result_, one));
    svg.open_group("");
    const bool zero = error <= 0;
    const double down = zero ? bottom : y(error);
    if (!zero && spread > 0)
      svg.line({across, y(std::max(error - spread, 1e-9))}, {across, y(error + spread)}, look + " class=\"spread\"");
    svg.circle({across, down}, 9, look);
    svg.text({across, down + 4}, number, "class=\"m number\"");
    svg.close_group();
  }

  const StudyResult& result_;
  std::string metric_;
};

}  // namespace

std::string error_chart(const StudyResult& result, const std::string& metric) {
  return ErrorChart(result, metric).svg();
}

const char* colour_of(const StudyResult& result, const VariantResult& outcome) {
  std::size_t k = 0, colour = 0, differing = 0;
  for (const auto& [name, setting] : result.study.settings) {
    if (outcome.variant.levels[k] != setting.usual_level()) ++differing, colour = k % (series_colours.size() - 1);
    ++k;
  }
  // Variants with several changed settings, or none, get the last colour.
  return series_colours[differing == 1 ? colour : series_colours.size() - 1];
}

}  // namespace grit
