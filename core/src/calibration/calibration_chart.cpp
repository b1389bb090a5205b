#include "calibration/calibration_chart.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "format/number.hpp"
#include "output/colours.hpp"
#include "output/scale.hpp"
#include "output/svg.hpp"

namespace grit {
namespace {

constexpr double frame_left = 84, frame_right = 690, frame_top = 34;
/// Deviations beyond this are drawn at the edge.
constexpr double most_deviation = 10;

const std::string of_first = fmt::format("stroke:{}", series_colours[6]),
                  of_best = fmt::format("stroke:{}", series_colours[0]);

/// An axis of logarithms.
AxisTicks powers_of_ten(double low, double high) {
  constexpr double most_marks = 8;
  AxisTicks axis{std::floor(low), std::max(std::ceil(high), std::floor(low) + 1), 1, {}};
  axis.step = std::ceil((axis.high - axis.low) / most_marks);
  for (double mark = axis.low; mark <= axis.high; mark += axis.step) axis.marks.push_back(mark);
  return axis;
}

/// A frame with axes; it maps values to points.
class Plot {
 public:
  Plot(const std::string& title, AxisTicks across, AxisTicks up, double height = 400)
      : svg(720, height, title, ""), bottom_(height - 58), across_(std::move(across)), up_(std::move(up)) {}

  void draw_axes(const std::string& across, const std::string& up, bool powers) {
    for (const double mark : up_.marks) {
      svg.line(at(across_.low, mark), at(across_.high, mark), "class=\"grid\"");
      const Point left = at(across_.low, mark);
      svg.text({left.x - 8, left.y + 4}, powers ? fmt::format("{:g}", std::pow(10, mark)) : tick_label(mark, up_.step),
               "class=\"e\"");
    }
    draw_abscissa(across);
    svg.text({8, frame_top - 14}, up, "class=\"axis\"");
  }
  void draw_abscissa(const std::string& title) {
    for (const double mark : across_.marks)
      svg.text({at(mark, up_.low).x, bottom_ + 18}, tick_label(mark, across_.step), "class=\"m\"");
    svg.line({frame_left, bottom_}, {frame_right, bottom_}, "class=\"frame\"");
    svg.line({frame_left, frame_top}, {frame_left, bottom_}, "class=\"frame\"");
    svg.text({(frame_left + frame_right) / 2, bottom_ + 40}, title, "class=\"axis m\"");
  }
  Point at(double x, double y) const {
    return {frame_left + (x - across_.low) / (across_.high - across_.low) * (frame_right - frame_left),
            bottom_ + (y - up_.low) / (up_.high - up_.low) * (frame_top - bottom_)};
  }
  void legend(double down, const std::string& style, const std::string& text) {
    svg.line({frame_right - 190, frame_top + down}, {frame_right - 168, frame_top + down},
             "class=\"curve\" style=\"" + style + '"');
    svg.text({frame_right - 162, frame_top + down + 4}, text, "class=\"small\"");
  }

  Svg svg;

 private:
  double bottom_;
  AxisTicks across_, up_;
};

}  // namespace

std::string misfit_chart(const Trials& trials, std::size_t optimum) {
  double low = 0, high = 0;  // of the logarithm
  const auto height_of = [&](const Trial& trial) { return std::log10(std::max(1e-4, trials.misfit(trial))); };
  for (const Trial& trial : trials.all())
    if (!trial.failed()) low = std::min(low, height_of(trial)), high = std::max(high, height_of(trial));
  const auto count = static_cast<double>(trials.all().size());
  Plot plot("misfit of each trial", axis_ticks(0, count, AxisEnds::whole_steps), powers_of_ten(low, high));
  plot.draw_axes("trial", "misfit, sum over the targets", true);
  const double met = std::log10(static_cast<double>(trials.targets()));
  plot.svg.line(plot.at(0, met), plot.at(count, met), "class=\"wish\"");
  plot.svg.text({plot.at(0, met).x + 6, plot.at(0, met).y - 6}, "1 per target", "class=\"small\"");
  std::vector<Point> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < trials.all().size(); ++i) {
    const Trial& trial = trials.all()[i];
    const double x = static_cast<double>(i + 1);
    if (trial.failed()) {
      plot.svg.text({plot.at(x, high).x, plot.at(x, high).y + 4}, "×", "class=\"m failed\"");
      continue;
    }
    least = std::min(least, height_of(trial));
    if (!best.empty()) best.push_back({plot.at(x, least).x, best.back().y});
    best.push_back(plot.at(x, least));
    const bool searched = trial.purpose == TrialPurpose::search;
    plot.svg.circle(plot.at(x, height_of(trial)), i == optimum ? 6 : 4,
                    fmt::format("style=\"fill:{}\"", series_colours[searched ? 0 : 1]));
  }
  if (best.size() > 1) plot.svg.polyline(best, "class=\"front\"");
  return std::move(plot.svg).finish();
}

std::string target_chart(const Trials& trials, std::size_t optimum, std::size_t target, const std::string& name,
                         const MetricDescription& metric) {
  const auto mine = std::ranges::equal_range(trials.observations(), target, {}, &Observation::target);
  const Trial& best = trials.all()[optimum];
  const ReadableUnit shown =
      readable(std::ranges::max(mine, {}, [](const Observation& one) { return std::abs(one.value); }));
  const auto first = std::ranges::find_if(trials.all(), [](const Trial& trial) { return !trial.failed(); });
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto include = [&](double value) { low = std::min(low, value), high = std::max(high, value); };
  auto row = mine.begin() - trials.observations().begin();
  for (const Observation& one : mine) {
    include(one.value - one.tolerance), include(one.value + one.tolerance);
    include(best.mean[row]), include(first->mean[row]);
    ++row;
  }
  Plot plot(name, axis_ticks(mine.front().at, mine.back().at, AxisEnds::kept),
            axis_ticks(shown.factor * low, shown.factor * high, AxisEnds::whole_steps));
  plot.draw_axes(metric.against.empty() ? "abscissa" : metric.against, axis_title(name, shown.unit), false);
  const auto at = [&](const Observation& one, double value) { return plot.at(one.at, shown.factor * value); };
  std::vector<Point> target_points, above, below, found, began;
  row -= static_cast<std::ptrdiff_t>(mine.size());
  for (const Observation& one : mine) {
    target_points.push_back(at(one, one.value));
    above.push_back(at(one, one.value + one.tolerance)), below.push_back(at(one, one.value - one.tolerance));
    found.push_back(at(one, best.mean[row])), began.push_back(at(one, first->mean[row]));
    ++row;
  }
  plot.svg.polyline(above, "class=\"wish\""), plot.svg.polyline(below, "class=\"wish\"");
  for (const Point& point : target_points) plot.svg.circle(point, 3, "class=\"target\"");
  plot.svg.polyline(began, "class=\"curve\" style=\"" + of_first + '"');
  plot.svg.polyline(found, "class=\"curve\" style=\"" + of_best + '"');
  plot.legend(10, of_first, "first trial"), plot.legend(26, of_best, "best trial");
  return std::move(plot.svg).finish();
}

std::string deviation_chart(const Trials& trials, std::size_t optimum, const std::vector<std::string>& targets) {
  const auto first = std::ranges::find_if(trials.all(), [](const Trial& trial) { return !trial.failed(); });
  const double rows = static_cast<double>(targets.size());
  const auto shown = [](double deviation) { return std::clamp(deviation, -most_deviation, most_deviation); };
  /// Of a curve its root mean square.
  const auto deviation = [&](const Trial& trial, std::size_t target) {
    const auto mine = std::ranges::equal_range(trials.observations(), target, {}, &Observation::target);
    const auto row = mine.begin() - trials.observations().begin();
    return mine.size() == 1 ? trials.deviations(trial)[row]
                            : std::sqrt(trials.misfits(trial)[static_cast<Eigen::Index>(target)]);
  };
  double most = 1.5;
  for (std::size_t i = 0; i < targets.size(); ++i)
    most =
        std::max({most, std::abs(shown(deviation(*first, i))), std::abs(shown(deviation(trials.all()[optimum], i)))});
  Plot plot("deviations of the targets", axis_ticks(-most, most, AxisEnds::whole_steps), {0, rows, 1, {}},
            92 + 44 * rows);
  const Point corner = plot.at(-1, rows), other = plot.at(1, 0);
  plot.svg.rectangle(corner, other.x - corner.x, other.y - corner.y, "class=\"floor\"");
  plot.draw_abscissa("(found − target) / √(tolerance² + scatter²/samples)");
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const double up = rows - static_cast<double>(i) - 0.5;
    plot.svg.text({plot.at(0, up).x + 6, plot.at(0, up).y - 10}, targets[i], "class=\"small\"");
    const Point from = plot.at(shown(deviation(*first, i)), up),
                to = plot.at(shown(deviation(trials.all()[optimum], i)), up);
    plot.svg.line(from, to, "class=\"grid\"");
    plot.svg.circle(from, 4, fmt::format("style=\"fill:{}\"", series_colours[6]));
    plot.svg.circle(to, 6, fmt::format("style=\"fill:{}\"", series_colours[0]));
  }
  plot.svg.line(plot.at(0, 0), plot.at(0, rows), "class=\"frame\"");
  return std::move(plot.svg).finish();
}

}  // namespace grit
