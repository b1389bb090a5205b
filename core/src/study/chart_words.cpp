#include "study/chart_words.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "study/chart.hpp"

namespace grit {

std::string percent(double share) {
  if (!std::isfinite(share)) return "?";
  const double value = 100 * share;
  return fmt::format("{:.{}f} %", value, value >= 9.95 ? 0 : value >= 0.1 ? 1 : 2);
}

std::string times(double ratio) { return fmt::format("{:.{}f}", ratio, ratio >= 10 ? 0 : ratio >= 3 ? 1 : 2); }

std::string cost_text(double seconds) {
  return seconds < 0.1     ? fmt::format("{:.2g} s", seconds)
         : seconds < 600   ? fmt::format("{:.{}f} s", seconds,
                                       seconds < 1    ? 2
                                         : seconds < 10 ? 1
                                                        : 0)
         : seconds < 36000 ? fmt::format("{:.0f} min", seconds / 60)
                           : fmt::format("{:.1f} h", seconds / 3600);
}

std::string verdict(const Chart& chart) {
  if (chart.reference.empty()) return "The finest settings have no result, so that there is nothing to compare with.";
  const std::string tolerance = percent(chart.study.tolerance);
  std::vector<std::string> untold;
  for (const auto& [name, figure] : chart.study.figures)
    if (!chart.reference.contains(name)) untold.push_back(name);
  std::string text;
  if (!untold.empty())
    text = fmt::format("The finest settings have no result, so that nothing is known of {}. ", fmt::join(untold, ", "));
  const bool scattered = std::ranges::any_of(chart.variants, [&](const VariantResult& one) {
    return one.complete() && &one != &chart.finest() && one.confidence(chart.study.tolerance) == Confidence::untold;
  });
  const std::string more =
      scattered ? " Of some it cannot be told: samples scatter by more than that; more seeds would tell." : "";
  if (!chart.cheapest) return text + "No variant was found to keep all figures within " + tolerance + "." + more;
  const VariantResult& best = chart.variants[*chart.cheapest];
  if (&best == &chart.finest())
    return text + "Nothing cheaper than the finest settings was found to keep all figures within " + tolerance + "." +
           more;
  const Deviation& worst = best.of_worst();
  text +=
      fmt::format("Cheapest within {}: {}, {} of one core", tolerance, best.variant.name, cost_text(best.core_seconds));
  if (chart.finest().core_seconds > 0)
    text += ", " + times(chart.finest().core_seconds / best.core_seconds) + " times cheaper than the finest";
  text += fmt::format("; its largest error is {} ± {} ({}).", percent(worst.error), percent(worst.standard_error),
                      best.worst);
  std::vector<std::string> doubtful;
  for (const auto& [name, one] : best.deviations)
    if (confidence(one.error, one.standard_error, chart.study.tolerance) != Confidence::certain)
      doubtful.push_back(name);
  if (!doubtful.empty())
    text += fmt::format(" Samples scatter so much that this is not certain of {}; more seeds would tell.",
                        fmt::join(doubtful, ", "));
  return text;
}

}  // namespace grit
