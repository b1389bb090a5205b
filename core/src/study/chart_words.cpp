#include "study/chart_words.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "study/chart.hpp"

namespace grit {
namespace {

/// What is cheaper than the best and may be near enough itself, but does not count. Empty if there is nothing.
std::string passed_over(const Chart& chart) {
  const VariantResult* cheapest = nullptr;
  for (const VariantResult& one : chart.variants) {
    if (finer_that_is_not(chart, one).empty()) continue;
    if (chart.cheapest && one.core_seconds >= chart.variants[*chart.cheapest].core_seconds) continue;
    if (cheapest == nullptr || one.core_seconds < cheapest->core_seconds) cheapest = &one;
  }
  if (cheapest == nullptr) return "";
  return fmt::format(" {} does not count though its own largest error is {}: {}, so that errors may cancel there.",
                     cheapest->variant.name, percent(cheapest->of_worst().error), finer_that_is_not(chart, *cheapest));
}

}  // namespace

std::string word_for_error(const StudyDescription& study) { return study.advice ? "error" : "difference"; }

std::vector<std::string> not_charted(const Chart& chart) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const auto& [name, why] : chart.uncharted) by_reason[why].push_back(name);
  std::vector<std::string> lines;
  for (const auto& [why, names] : by_reason) lines.push_back(fmt::format("{}: {}", fmt::join(names, ", "), why));
  return lines;
}

std::string finer_that_is_not(const Chart& chart, const VariantResult& one) {
  const double tolerance = chart.study.tolerance;
  const bool itself = one.confidence(tolerance) == Confidence::impossible;
  if (itself || one.decided_by.empty() || one.within <= Confidence::likely) return "";
  const auto finer = std::ranges::find_if(
      chart.variants, [&](const VariantResult& other) { return other.variant.name == one.decided_by; });
  for (const auto& [name, own] : finer->deviations)
    if (confidence(own.error, own.standard_error, tolerance) == one.within)
      return fmt::format("{}, which is finer, is {} ± {} off ({})", one.decided_by, percent(own.error),
                         percent(own.standard_error), name);
  return "";
}

std::string verdict_of_figures(const Chart& chart) {
  if (chart.reference.empty()) {
    const bool failed = std::ranges::any_of(chart.finest().samples, [](const auto& s) { return s.status != "done"; });
    return failed ? "The finest settings have no result, so that there is nothing to compare with."
                  : "No figure could be charted.";
  }
  const std::string tolerance = percent(chart.study.tolerance);
  std::string text;
  if (!chart.uncharted.empty())
    text = fmt::format("Nothing is known of {}, which could not be charted. ",
                       fmt::join(std::views::keys(chart.uncharted), ", "));
  const bool scattered = std::ranges::any_of(chart.variants, [&](const VariantResult& one) {
    return one.complete() && &one != &chart.finest() && one.within == Confidence::untold;
  });
  const std::string more =
      (!scattered     ? ""
       : !chart.alike ? " Of some it cannot be told: samples scatter by more than that; more seeds would tell."
                      : " Of some it cannot be told: nobody knows how samples scatter.") +
      passed_over(chart);
  if (!chart.cheapest) return text + "No variant was found to keep all figures within " + tolerance + "." + more;
  const VariantResult& best = chart.variants[*chart.cheapest];
  if (&best == &chart.finest())
    return text + "Nothing cheaper than the finest settings was found to keep all figures within " + tolerance + "." +
           more;
  const Deviation& worst = best.of_worst();
  text +=
      fmt::format("Cheapest within {}: {}, {} of one core", tolerance, best.variant.name, cost_text(best.core_seconds));
  if (chart.finest().core_seconds > 0)
    text += ", " + ratio_text(chart.finest().core_seconds / best.core_seconds) + " times cheaper than the finest";
  text += fmt::format("; its largest error is {} ± {} ({}).", percent(worst.error), percent(worst.standard_error),
                      best.worst);
  std::vector<std::string> doubtful;
  for (const auto& [name, one] : best.deviations)
    if (confidence(one.error, one.standard_error, chart.study.tolerance) != Confidence::certain)
      doubtful.push_back(name);
  if (!doubtful.empty())
    text += fmt::format(" Samples scatter so much that this is not certain of {}; more seeds would tell.",
                        fmt::join(doubtful, ", "));
  else if (best.within != Confidence::certain)
    text += fmt::format(" It is not certain, for {}, which is finer, is not; more seeds would tell.", best.decided_by);
  return text + passed_over(chart);
}

std::string of_samples(const Chart& chart) {
  const bool several = chart.study.seeds.values.size() > 1;
  if (!chart.alike) return "";
  if (!chart.random)
    return several ? "Nothing is random in this scene: the seed changes nothing, samples are alike to the last digit, "
                     "and one is all that figures need."
                   : "Nothing is random in this scene: one sample is all that figures need.";
  if (!several) return "";
  return fmt::format(
      "Samples are alike to the last digit though something is random in this scene: the seed at {} changes nothing, "
      "so that they count as one, whose scatter is unknown.",
      chart.study.seeds.pointer);
}

std::string of_order(const Chart& chart) {
  constexpr double suspicious = 1.5;
  std::string text;
  for (const auto& [name, setting] : chart.study.settings) {
    const auto first = std::ranges::find_if(chart.effects, [&](const Effect& effect) {
      return effect.setting == name && effect.level == setting.label(0);
    });
    if (first == chart.effects.end() || first->cost <= suspicious) continue;
    text += fmt::format(
        "{}{}={} costs {} times as much as {}, which stands last and so is taken for the finest: levels go from the "
        "cheapest to the finest.",
        text.empty() ? "" : " ", name, first->level, ratio_text(first->cost), setting.label(setting.finest_level()));
  }
  return text;
}

std::string verdict(const Chart& chart) {
  std::string text = verdict_of_figures(chart);
  for (const std::string& more : {of_samples(chart), of_order(chart)})
    if (!more.empty()) text += ' ' + more;
  return text;
}

}  // namespace grit
