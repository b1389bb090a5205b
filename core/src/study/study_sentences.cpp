#include "study/study_sentences.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "study/study_result.hpp"

namespace grit {
namespace {

/// The cheapest variant that is rejected only because of a finer one, if it is cheaper than the best. Empty if none.
std::string passed_over(const StudyResult& result) {
  const VariantResult* cheapest = nullptr;
  for (const VariantResult& one : result.variants) {
    if (finer_that_is_not(result, one).empty()) continue;
    if (result.cheapest && one.core_seconds >= result.variants[*result.cheapest].core_seconds) continue;
    if (cheapest == nullptr || one.core_seconds < cheapest->core_seconds) cheapest = &one;
  }
  if (cheapest == nullptr) return "";
  return fmt::format(" {} is rejected although its own largest error is {}: {}, so that errors may cancel.",
                     cheapest->variant.name, percent(cheapest->of_worst().error), finer_that_is_not(result, *cheapest));
}

}  // namespace

std::string deviation_title(const StudyDescription& study, const std::string& metric) {
  if (!metric.empty())
    return study.metrics.at(metric).has_own_reference() ? "difference of " + metric + " from its reference"
                                                        : "error of " + metric;
  return study.compares_with_finest() ? "largest error of all metrics"
                                      : "largest difference of all metrics from their references";
}

std::string of_progress(const StudyResult& result) {
  constexpr std::size_t most_named = 10;
  const std::size_t done = result.count("done");
  if (done == result.runs()) return "";
  std::string text = fmt::format("{} of {} runs are done", done, result.runs());
  for (const char* status : {"under way", "missing", "failed"}) {
    std::vector<std::string> names;
    for (const VariantResult& one : result.variants)
      for (const Sample& sample : one.samples)
        if (sample.status == status) names.push_back(fmt::format("{}, seed {:.0f}", one.variant.name, sample.seed));
    if (names.empty()) continue;
    const std::size_t count = names.size();
    if (count > most_named) names.resize(most_named), names.push_back("…");
    text += fmt::format("; {} {}: {}", count, status, fmt::join(names, "; "));
  }
  return text + '.';
}

namespace {

/// For each metric with a given value the variant that is closest to it.
std::string closest(const StudyResult& result) {
  std::vector<std::string> sentences;
  for (const auto& [name, metric] : result.study.metrics) {
    if (!metric.value) continue;
    const VariantResult* best = nullptr;
    const auto apart = [&](const VariantResult& one) { return std::abs(one.values.at(name).mean - *metric.value); };
    for (const VariantResult& one : result.variants)
      if (one.values.contains(name) && (best == nullptr || apart(one) < apart(*best))) best = &one;
    if (best == nullptr) continue;
    const Value& value = best->values.at(name);
    sentences.push_back(
        fmt::format("{} is closest to {:g} with {}: {:.4g} ± {}.", name, *metric.value, best->variant.name, value.mean,
                    std::isfinite(value.standard_error()) ? fmt::format("{:.2g}", value.standard_error()) : "?"));
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

}  // namespace

std::vector<std::string> not_evaluated(const StudyResult& result) {
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const auto& [name, why] : result.unevaluated) by_reason[why].push_back(name);
  std::vector<std::string> lines;
  for (const auto& [why, names] : by_reason) lines.push_back(fmt::format("{}: {}", fmt::join(names, ", "), why));
  return lines;
}

std::vector<std::string> failed_runs(const StudyResult& result) {
  std::vector<std::string> lines;
  for (const VariantResult& one : result.variants)
    for (const Sample& sample : one.samples)
      if (sample.status == "failed")
        lines.push_back(fmt::format("{}, seed {:.0f}: {}", one.variant.name, sample.seed, sample.message));
  return lines;
}

std::string finer_that_is_not(const StudyResult& result, const VariantResult& one) {
  const double tolerance = result.study.tolerance;
  const bool itself = one.confidence(tolerance) == Confidence::exceeded;
  if (itself || one.decided_by.empty() || one.within <= Confidence::likely) return "";
  const auto finer = std::ranges::find_if(
      result.variants, [&](const VariantResult& other) { return other.variant.name == one.decided_by; });
  for (const auto& [name, own] : finer->deviations)
    if (confidence(own.error, own.standard_error, tolerance) == one.within)
      return fmt::format("{}, which is finer, deviates by {} ± {} ({})", one.decided_by, percent(own.error),
                         percent(own.standard_error), name);
  return "";
}

namespace {

std::string verdict_of_metrics(const StudyResult& result) {
  if (result.reference.empty()) {
    const bool failed = std::ranges::any_of(result.finest().samples, [](const auto& s) { return s.status != "done"; });
    return failed ? "The finest settings have no result, so that there is no reference."
                  : "No metric could be evaluated.";
  }
  const std::string tolerance = percent(result.study.tolerance);
  std::string text;
  if (!result.unevaluated.empty())
    text =
        fmt::format("Metrics that could not be evaluated: {}. ", fmt::join(std::views::keys(result.unevaluated), ", "));
  const bool scattered = std::ranges::any_of(result.variants, [&](const VariantResult& one) {
    return one.complete() && &one != &result.finest() && one.within == Confidence::inconclusive;
  });
  const std::string more =
      (!scattered      ? ""
       : !result.alike ? " Some variants are inconclusive because of scatter between samples; use more seeds."
                       : " Some variants are inconclusive: sample variance unknown.") +
      passed_over(result);
  if (!result.cheapest) return text + "No variant keeps all metrics within " + tolerance + "." + more;
  const VariantResult& best = result.variants[*result.cheapest];
  const bool with_finest = result.study.compares_with_finest();
  if (with_finest && &best == &result.finest())
    return text + "No variant cheaper than the finest settings keeps all metrics within " + tolerance + "." + more;
  const Deviation& worst = best.of_worst();
  text +=
      fmt::format("Cheapest within {}: {}, {} on one core", tolerance, best.variant.name, cost_text(best.core_seconds));
  if (with_finest && result.finest().core_seconds > 0)
    text += ", " + ratio_text(result.finest().core_seconds / best.core_seconds) + " times cheaper than the finest";
  text += fmt::format("; its largest {} is {} ± {} ({}).", with_finest ? "error" : "difference", percent(worst.error),
                      percent(worst.standard_error), best.worst);
  std::vector<std::string> doubtful;
  for (const auto& [name, one] : best.deviations)
    if (confidence(one.error, one.standard_error, result.study.tolerance) != Confidence::certain)
      doubtful.push_back(name);
  if (!doubtful.empty())
    text += fmt::format(" This is not certain for {} because of scatter between samples; use more seeds.",
                        fmt::join(doubtful, ", "));
  else if (best.within != Confidence::certain)
    text += fmt::format(" This is not certain because {}, which is finer, is not; use more seeds.", best.decided_by);
  return text + passed_over(result);
}

}  // namespace

std::string of_samples(const StudyResult& result) {
  const bool several = result.study.seeds.values.size() > 1;
  if (!result.alike) return "";
  if (!result.random)
    return several ? "Nothing is random in this scene: the seed has no effect, all samples are identical, and one "
                     "sample is sufficient."
                   : "Nothing is random in this scene: one sample is sufficient.";
  if (!several) return "";
  return fmt::format(
      "All samples are identical although the scene is random: the seed at {} has no effect. They count as one sample, "
      "so that the sample variance is unknown.",
      result.study.seeds.pointer);
}

std::string of_order(const StudyResult& result) {
  constexpr double suspicious = 1.5;
  std::string text;
  for (const auto& [name, setting] : result.study.settings) {
    const auto first = std::ranges::find_if(result.effects, [&](const Effect& effect) {
      return effect.setting == name && effect.level == setting.label(0);
    });
    if (first == result.effects.end() || first->cost <= suspicious) continue;
    text += fmt::format(
        "{}{}={} costs {} times as much as {}, the last level, which is taken as the finest; list levels from the "
        "cheapest to the finest.",
        text.empty() ? "" : " ", name, first->level, ratio_text(first->cost), setting.label(setting.finest_level()));
  }
  return text;
}

std::string verdict(const StudyResult& result) {
  std::string text = result.study.is_sweep() ? closest(result) : verdict_of_metrics(result);
  for (const std::string& more : {of_progress(result), of_samples(result), of_order(result)})
    if (!more.empty()) text += (text.empty() ? "" : " ") + more;
  return text;
}

}  // namespace grit
