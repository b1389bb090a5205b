#include "study/chart_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "output/scale.hpp"
#include "output/svg.hpp"

namespace grit {
namespace {

// Okabe and Ito's colours: told apart by all readers, on white and on black.
constexpr std::array<const char*, 7> palette{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#8a8a86"};

/// "2.1 %"; "?" where it cannot be told.
std::string percent(double share) {
  if (!std::isfinite(share)) return "?";
  const double value = 100 * share;
  return fmt::format("{:.{}f} %", value, value >= 9.95 ? 0 : value >= 0.1 ? 1 : 2);
}

std::string times(double ratio) { return fmt::format("{:.{}f}", ratio, ratio >= 10 ? 0 : ratio >= 3 ? 1 : 2); }

std::string cost_text(double seconds) {
  return seconds < 600     ? fmt::format("{:.{}f} s", seconds, seconds < 10 ? 1 : 0)
         : seconds < 36000 ? fmt::format("{:.0f} min", seconds / 60)
                           : fmt::format("{:.1f} h", seconds / 3600);
}

/// Which setting a variant varies alone; the last colour for several or none.
std::size_t colour_of(const Chart& chart, const VariantResult& result) {
  std::size_t k = 0, colour = palette.size() - 1, differing = 0;
  for (const auto& [name, setting] : chart.study.settings) {
    if (result.variant.levels[k] != setting.usual_level()) ++differing, colour = k % (palette.size() - 1);
    ++k;
  }
  return differing == 1 ? colour : palette.size() - 1;
}

/// A logarithmic axis from power to power, or to 2 and 5 where that is shorter.
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
        const double place = power + std::log10(lead);
        if ((dense || lead == 1) && place >= low_ - 1e-9 && place <= high_ + 1e-9)
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

/// Error of one figure, or of the worst, against cost.
class ErrorChart {
 public:
  /// `figure`: empty for the worst of each variant.
  ErrorChart(const Chart& chart, const std::string& figure) : chart_(chart), figure_(figure) {}

  std::string svg() const {
    Svg svg(width, height, title(), "");
    double least = chart_.study.tolerance, largest = chart_.study.tolerance, cheapest = 1e300, dearest = 0;
    for (const VariantResult& one : chart_.variants) {
      if (one.core_seconds > 0)
        cheapest = std::min(cheapest, one.core_seconds), dearest = std::max(dearest, one.core_seconds);
      if (!one.complete()) continue;
      const double error = of(one).error;
      if (error > 0)
        least = std::min(least, error), largest = std::max(largest, error + finite(of(one).standard_error));
    }
    if (dearest == 0) return "";
    const double floor =
        finite(reference().scatter) * std::sqrt(2.0 / static_cast<double>(chart_.study.seeds.values.size()));
    if (floor > 0) least = std::min(least, 0.7 * floor);
    const LogAxis x(0.9 * cheapest, 1.1 * dearest, left, right), y(std::max(least, 1e-6), largest, bottom, top);

    if (floor > 0) {
      svg.rectangle({left, y(floor)}, right - left, bottom - y(floor), "class=\"floor\"");
      svg.text({right - 6, bottom - 8}, "differences between samples: " + percent(floor), "class=\"e small\"");
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
    svg.line({left, y(chart_.study.tolerance)}, {right, y(chart_.study.tolerance)}, "class=\"wish\"");
    svg.text({left + 6, y(chart_.study.tolerance) - 6}, "tolerance " + percent(chart_.study.tolerance),
             "class=\"small\"");
    svg.text({left - 50, top - 14}, title(), "class=\"axis\"");
    svg.text({(left + right) / 2, bottom + 40}, "core-seconds of one run", "class=\"axis m\"");
    front(svg, x, y);
    for (std::size_t i = 0; i < chart_.variants.size(); ++i) point(svg, x, y, i);
    return std::move(svg).finish();
  }

 private:
  static constexpr double width = 720, height = 400, left = 62, right = 706, top = 34, bottom = 342;

  static double finite(double value) { return std::isfinite(value) ? value : 0; }
  const Deviation& of(const VariantResult& one) const {
    return figure_.empty() ? one.of_worst() : one.deviations.at(figure_);
  }
  /// Of the finest: its scatter; of several figures the largest.
  Deviation reference() const {
    Deviation largest;
    largest.scatter = 0;
    if (chart_.finest().complete())
      for (const auto& [name, one] : chart_.finest().deviations)
        if (figure_.empty() || figure_ == name) largest.scatter = std::max(largest.scatter, finite(one.scatter));
    return largest;
  }
  std::string title() const { return figure_.empty() ? "largest error of all figures" : "error of " + figure_; }

  void front(Svg& svg, const LogAxis& x, const LogAxis& y) const {
    std::vector<const VariantResult*> all;
    for (const VariantResult& one : chart_.variants)
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
    if (points.size() > 1) svg.polyline(points, "class=\"front\"");
  }

  void point(Svg& svg, const LogAxis& x, const LogAxis& y, std::size_t i) const {
    const VariantResult& one = chart_.variants[i];
    if (one.core_seconds == 0 && one.complete()) return;
    const std::string number = std::to_string(i + 1);
    if (!one.complete()) {
      const auto failed = std::ranges::find(one.samples, "failed", &Sample::status);
      if (failed == one.samples.end()) return;
      svg.text({x(std::max(failed->core_seconds, 1e-3)), top + 12 + 13 * (i % 3)}, "✕" + number, "class=\"m failed\"");
      return;
    }
    const double across = x(one.core_seconds), error = of(one).error, spread = finite(of(one).standard_error);
    const std::string look = fmt::format("style=\"fill:{0};stroke:{0}\"", palette[colour_of(chart_, one)]);
    svg.open_group("");
    const bool zero = error <= 0;
    const double down = zero ? bottom : y(error);
    if (!zero && spread > 0)
      svg.line({across, y(std::max(error - spread, 1e-9))}, {across, y(error + spread)}, look + " class=\"spread\"");
    svg.circle({across, down}, 9, look);
    svg.text({across, down + 4}, number, "class=\"m number\"");
    svg.close_group();
  }

  const Chart& chart_;
  const std::string& figure_;
};

std::string variants_table(const Chart& chart) {
  std::string html =
      "<div class=\"wide\"><table><thead><tr><th>#</th><th class=\"name\">settings that differ from the "
      "usual</th><th>core-seconds</th>"
      "<th>cheaper than the finest</th><th>steps</th><th>M particle-steps/s</th>";
  for (const auto& [name, figure] : chart.study.figures) html += "<th>error of " + escaped(name) + "</th>";
  html += "</tr></thead><tbody>\n";
  std::vector<std::size_t> order(chart.variants.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return chart.variants[i].core_seconds; });
  for (const std::size_t i : order) {
    const VariantResult& one = chart.variants[i];
    html += fmt::format(
        "<tr{}><td><span class=\"dot\" style=\"background:{}\">{}</span></td><td class=\"name\">{}{}</td>",
        chart.cheapest == i ? " class=\"best\"" : "", palette[colour_of(chart, one)], i + 1, escaped(one.variant.name),
        one.on_front ? " <b title=\"none is both cheaper and nearer\">◂</b>" : "");
    html += fmt::format("<td>{:.1f}</td><td>{}</td><td>{:.0f}</td><td>{:.2f}</td>", one.core_seconds,
                        one.core_seconds > 0 ? times(chart.finest().core_seconds / one.core_seconds) + " times" : "?",
                        one.steps, 1e-6 * one.particle_steps_per_second);
    for (const auto& [name, figure] : chart.study.figures) {
      const auto found = one.deviations.find(name);
      if (found == one.deviations.end()) {
        html += "<td>failed or not run</td>";
      } else if (&one == &chart.finest() && found->second.error == 0) {
        html += "<td>reference</td>";
      } else {
        html += fmt::format("<td{}>{} <small>± {}</small></td>",
                            found->second.error > chart.study.tolerance ? " class=\"over\"" : "",
                            percent(found->second.error), percent(found->second.standard_error));
      }
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

/// Cost of each level of a setting and what it changes, as bars.
std::string effects_part(const Chart& chart) {
  if (chart.effects.empty()) return "";
  std::string html =
      "<h2>Each setting alone</h2>\n<p>A level beside the finest of the same setting, all others as usual.</p>\n"
      "<div class=\"wide\"><table><thead><tr><th class=\"name\">setting</th><th class=\"name\">level</th><th>cost over "
      "the finest</th>";
  for (const auto& [name, figure] : chart.study.figures) html += "<th>changes " + escaped(name) + " by</th>";
  html += "</tr></thead><tbody>\n";
  double largest = chart.study.tolerance;
  for (const Effect& effect : chart.effects)
    for (const auto& [name, one] : effect.deviations) largest = std::max(largest, one.error);
  for (const Effect& effect : chart.effects) {
    const auto& setting = chart.study.settings.at(effect.setting);
    html += fmt::format(
        "<tr><td class=\"name\">{}{}</td><td class=\"name\">{} <small>(finest {})</small></td><td>{}</td>",
        escaped(effect.setting), setting.about.empty() ? "" : "<br><small>" + escaped(setting.about) + "</small>",
        escaped(effect.level), escaped(setting.label(setting.finest_level())), times(effect.cost));
    for (const auto& [name, figure] : chart.study.figures) {
      const auto found = effect.deviations.find(name);
      if (found == effect.deviations.end()) {
        html += "<td>?</td>";
        continue;
      }
      const Deviation& one = found->second;
      html += fmt::format("<td class=\"bar{}\" style=\"--share:{:.1f}%\">{} <small>± {}</small></td>",
                          one.error > chart.study.tolerance ? " over" : "", 100 * one.error / largest,
                          percent(one.error), percent(one.standard_error));
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string failures_part(const Chart& chart) {
  std::string html;
  for (std::size_t i = 0; i < chart.variants.size(); ++i)
    for (const Sample& sample : chart.variants[i].samples)
      if (sample.status != "done")
        html += fmt::format("<li><b>{} {}</b>, seed {:.0f}: {}</li>\n", i + 1, escaped(chart.variants[i].variant.name),
                            sample.seed, sample.status == "failed" ? escaped(sample.message) : "not run to its end");
  return html.empty() ? "" : "<h2>Where it fails</h2>\n<ul>\n" + html + "</ul>\n";
}

constexpr const char* sheet = R"(
:root{--ink:#1b1b1a;--soft:#666;--paper:#fff;--line:#e4e4e0;--frame:#8a8a86;--band:#f1f0ea;--bar:#cfe3f1;--over:#b3261e}
@media(prefers-color-scheme:dark){:root{--ink:#ececea;--soft:#a5a5a0;--paper:#17181a;--line:#33353a;--frame:#77787c;--band:#232428;--bar:#1f4460;--over:#ff8a80}}
*{box-sizing:border-box}
body{margin:0 auto;padding:24px 20px 60px;max-width:1180px;background:var(--paper);color:var(--ink);
font:15px/1.5 "Helvetica Neue",Helvetica,Arial,"Liberation Sans","DejaVu Sans",sans-serif}
h1{font-size:24px;margin:0 0 4px}h2{font-size:18px;margin:36px 0 8px}p{margin:6px 0}small{color:var(--soft)}
.verdict{font-size:17px;border-left:4px solid #0072b2;padding:2px 14px;margin:18px 0}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,480px),1fr));gap:18px}
svg{width:100%;height:auto;display:block}.first svg{max-width:900px}
text{font-family:inherit;font-size:12px;fill:var(--ink)}
.axis{font-size:13px;font-weight:600}.small{font-size:11px;fill:var(--soft)}.m{text-anchor:middle}.e{text-anchor:end}
.grid{stroke:var(--line)}.frame{stroke:var(--frame)}.floor{fill:var(--band)}
.wish{stroke:var(--over);stroke-dasharray:5 4}.front{fill:none;stroke:var(--frame);stroke-width:2}
.number{font-size:11px;font-weight:600;fill:#fff}.spread{stroke-width:1.5}.failed{fill:var(--over);font-weight:600}
.wide{overflow-x:auto}table{border-collapse:collapse;font-size:13.5px;width:100%}
th,td{padding:5px 9px;text-align:right;border-bottom:1px solid var(--line);vertical-align:top}
th{font-weight:600;vertical-align:bottom}.name{text-align:left}tr.best{background:var(--band)}.over{color:var(--over)}
.dot{display:inline-block;min-width:22px;padding:0 4px;border-radius:11px;color:#fff;text-align:center;font-weight:600}
.bar{background:linear-gradient(to left,var(--bar) var(--share),transparent 0)}
)";

}  // namespace

std::string verdict(const Chart& chart) {
  if (chart.reference.empty()) return "The finest settings have no result, so that there is nothing to compare with.";
  if (!chart.cheapest) return "No variant keeps all figures within " + percent(chart.study.tolerance) + ".";
  const VariantResult& best = chart.variants[*chart.cheapest];
  if (&best == &chart.finest())
    return "Nothing cheaper than the finest settings keeps all figures within " + percent(chart.study.tolerance) + ".";
  const Deviation& worst = best.of_worst();
  std::string text = "Cheapest within " + percent(chart.study.tolerance) + ": " + best.variant.name + ", " +
                     cost_text(best.core_seconds) + " of one core";
  if (chart.finest().core_seconds > 0)
    text += ", " + times(chart.finest().core_seconds / best.core_seconds) + " times cheaper than the finest";
  text += "; its largest error is " + percent(worst.error) + " ± " + percent(worst.standard_error) + " (" + best.worst +
          ").";
  if (!(worst.error + 2 * worst.standard_error <= chart.study.tolerance))
    text += " Samples scatter so much that this is not certain; more seeds would tell.";
  return text;
}

std::string chart_page(const Chart& chart) {
  const std::string title = chart.study.title.empty() ? "speed against accuracy" : chart.study.title;
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(title) + "</title>\n<style>" + sheet + "</style></head>\n<body>\n<h1>" + escaped(title) + "</h1>\n";
  html += fmt::format(
      "<p>{}, {} samples of each variant; errors ± their standard error, from the scatter between samples.</p>\n",
      escaped(std::filesystem::proximate(chart.study.scene).string()), chart.study.seeds.values.size());
  html += "<p class=\"verdict\">" + escaped(verdict(chart)) + "</p>\n";
  if (!chart.reference.empty()) {
    html += "<div class=\"first\">" + ErrorChart(chart, "").svg() + "</div>\n";
    html +=
        "<p><small>Down is nearer, left is cheaper; none is both that lies above the stepped line. In the shaded part "
        "differences are those between samples. The finest stands on the axis.</small></p>\n";
  }
  html += "<h2>Variants</h2>\n" + variants_table(chart) + effects_part(chart) + failures_part(chart);
  if (chart.reference.size() > 1) {
    html += "<h2>Each figure</h2>\n<div class=\"charts\">\n";
    for (const auto& [name, reference] : chart.reference) html += "<div>" + ErrorChart(chart, name).svg() + "</div>\n";
    html += "</div>\n";
  }
  return html + "</body></html>\n";
}

}  // namespace grit
