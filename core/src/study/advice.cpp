#include "study/advice.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>

#include "grit/description.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "grit/toolkit/text_file.hpp"
#include "storage/parsed_json.hpp"

namespace grit {
namespace {

double number_or_nan(const Description& json) { return json.is_number() ? json.get<double>() : std::nan(""); }

/// Findings of the selected metrics.
std::vector<Finding> findings_of(const Description& deviations, const std::vector<std::string>& metrics) {
  std::vector<Finding> all;
  for (const auto& [name, one] : deviations.items())
    if (std::ranges::find(metrics, name) != metrics.end())
      all.push_back({name, number_or_nan(one.at("error")), number_or_nan(one.at("standard_error"))});
  return all;
}

/// Splits the selected metrics into evaluated and unevaluated ones; all are selected if `wanted` is empty.
void read_metrics(EvaluatedStudy& study, const Description& json, const std::vector<std::string>& wanted) {
  std::vector<std::string> with_reference;
  for (const auto& [name, metric] : json.at("metrics").items()) {
    if (!wanted.empty() && std::ranges::find(wanted, name) == wanted.end()) continue;
    const Description why = metric.value("not_charted", Description());
    if (why.is_string()) study.unevaluated[name] = why.get<std::string>();
    else study.metrics.push_back(name);
    if (metric.value("reference", "finest") != "finest") with_reference.push_back(name);
  }
  if (with_reference.empty()) return;
  for (const auto& variant : json.at("variants"))
    if (!variant.at("metrics").empty())
      study.beside_references.push_back({.level = variant.at("name").get<std::string>(),
                                         .sets = {},
                                         .findings = findings_of(variant.at("metrics"), with_reference)});
}

/// Throws Description::exception if something is missing.
EvaluatedStudy evaluated_study(const std::filesystem::path& file, const Description& json,
                               const std::vector<std::string>& metrics) {
  for (const auto& name : metrics)
    if (!json.at("metrics").contains(name)) {
      std::vector<std::string> known;
      for (const auto& [metric, _] : json.at("metrics").items()) known.push_back(metric);
      throw Error(fmt::format("{}: has no metric \"{}\"{}", file.string(), name,
                              did_you_mean(name, known, fmt::format("its metrics are {}", fmt::join(known, ", ")))));
    }
  EvaluatedStudy study{file,
                       json.at("title").get<std::string>(),
                       json.at("scenario").get<std::string>(),
                       json.value("parts", std::vector<std::string>()),
                       json.value("purpose", "accuracy") == "sweep",
                       json.at("samples").get<std::size_t>(),
                       json.value("of_samples", "")};
  read_metrics(study, json, metrics);
  bool has_errors = false;
  for (const auto& [name, setting] : json.at("settings").items()) {
    auto& levels = study.settings[name];
    const auto& all = setting.at("levels");
    for (const auto& level : all) {
      Evidence& evidence = levels.emplace_back();
      evidence.level = level.at("label").get<std::string>();
      evidence.sets = level.at("sets").get<std::vector<std::string>>();
      const auto effect = std::ranges::find_if(json.at("effects"), [&](const Description& one) {
        return one.at("setting") == name && one.at("level") == evidence.level;
      });
      if (effect != json.at("effects").end()) {
        evidence.cost = effect->at("cost").get<double>();
        evidence.cost_error = number_or_nan(effect->value("cost_standard_error", Description()));
        evidence.findings = findings_of(effect->at("metrics"), study.metrics);
      }
      evidence.known = &level == &all.back() || !evidence.findings.empty();
      has_errors |= std::ranges::any_of(evidence.findings, [](const Finding& one) { return std::isfinite(one.error); });
    }
  }
  if (!has_errors && !study.sweep)
    throw FileError(
        fmt::format("{}: has no errors of {}, so that it gives no advice; see its page, or run 'grit study' again",
                    file.string(), metrics.empty() ? "any metric" : fmt::format("{}", fmt::join(metrics, ", "))));
  return study;
}

/// Whether a finer level changes no metric by more than another level does.
bool changes_no_more(const Evidence& finer, const Evidence& than) {
  return std::ranges::all_of(finer.findings, [&](const Finding& one) {
    const auto other = std::ranges::find(than.findings, one.metric, &Finding::metric);
    return other != than.findings.end() && one.error <= other->error;
  });
}

/// Adds the changes by one more setting: errors of a metric are summed.
void add(Evidence& sum, const Evidence& one) {
  sum.cost *= one.cost;
  for (const Finding& finding : one.findings) {
    auto own = std::ranges::find(sum.findings, finding.metric, &Finding::metric);
    if (own == sum.findings.end()) own = sum.findings.insert(own, {finding.metric});
    own->error += finding.error;
    own->standard_error = std::hypot(own->standard_error, finding.standard_error);
  }
}

double largest_error(const Evidence& one) {
  return one.findings.empty() ? 0 : std::ranges::max(std::views::transform(one.findings, &Finding::error));
}

/// The cheapest combination of levels within the tolerance, by branch and bound. A branch is cut off if its sum exceeds
/// the tolerance, as errors only grow, or if it cannot be cheaper than the best found.
class Cheapest {
 public:
  Cheapest(std::vector<Advice>& advices, double tolerance) : tolerance_(tolerance) {
    for (Advice& advice : advices)
      if (advice.now != nullptr) settings_.push_back(&advice);
    least_cost_.assign(settings_.size() + 1, 1);
    for (std::size_t k = settings_.size(); k-- > 0;) {
      const Advice& one = *settings_[k];
      const double least = one.within.empty() ? one.then()->cost : std::min(one.within[0]->cost, one.then()->cost);
      least_cost_[k] = least_cost_[k + 1] * least;
    }
  }

  /// Stores the best combination in the advice, if there is any.
  void take() {
    choose({});
    for (std::size_t k = 0; k < best_.size(); ++k)
      if (best_[k] != settings_[k]->then()) settings_[k]->taken = best_[k];
  }

 private:
  void choose(const Evidence& sum) {
    const std::size_t k = chosen_.size();
    if (sum.confidence(tolerance_) > Confidence::likely || sum.cost * least_cost_[k] > best_cost_) return;
    if (k == settings_.size()) {
      if (sum.cost == best_cost_ && largest_error(sum) >= best_error_) return;
      best_ = chosen_, best_cost_ = sum.cost, best_error_ = largest_error(sum);
      return;
    }
    const auto try_level = [&](const Evidence* level) {
      Evidence more = sum;
      add(more, *level);
      chosen_.push_back(level);
      choose(more);
      chosen_.pop_back();
    };
    for (const Evidence* level : settings_[k]->within) try_level(level);
    try_level(settings_[k]->then());
  }

  double tolerance_;
  std::vector<Advice*> settings_;
  std::vector<double> least_cost_;  ///< of each setting and those after it
  std::vector<const Evidence*> chosen_, best_;
  double best_cost_ = std::numeric_limits<double>::infinity(), best_error_ = 0;
};

}  // namespace

EvaluatedStudy read_evaluated_study(const std::filesystem::path& file, const std::vector<std::string>& metrics) {
  std::string fault;
  const std::string text = read_bytes(file, fault);
  if (!fault.empty()) throw FileError(file.string() + ": cannot be read; give a study.json written by 'grit study'");
  try {
    return evaluated_study(file, parsed_json(text), metrics);
  } catch (const Description::exception&) {
    throw FileError(file.string() + ": is not a study.json; 'grit study' writes one");
  }
}

Confidence Evidence::confidence(double tolerance) const {
  Confidence worst = Confidence::certain;
  for (const Finding& one : findings)
    worst = std::max(worst, grit::confidence(one.error, one.standard_error, tolerance));
  return worst;
}

const Evidence& least_sure(const std::vector<Evidence>& levels, const Evidence& level, double tolerance) {
  const Evidence* found = &level;
  for (const Evidence& one : std::views::reverse(levels)) {
    if (&one == &level) break;
    if (one.known && one.confidence(tolerance) > found->confidence(tolerance)) found = &one;
  }
  return *found;
}

std::vector<Finding> far_off(const EvaluatedStudy& study, double tolerance) {
  std::map<std::string, Finding> nearest;
  std::vector<std::string> reached;
  for (const Evidence& variant : study.beside_references)
    for (const Finding& one : variant.findings) {
      if (confidence(one.error, one.standard_error, tolerance) != Confidence::exceeded) reached.push_back(one.metric);
      if (const auto [found, is_new] = nearest.emplace(one.metric, one); !is_new && one.error < found->second.error)
        found->second = one;
    }
  for (const auto& metric : reached) nearest.erase(metric);
  const auto all = std::views::values(nearest);
  return {all.begin(), all.end()};
}

const Finding* Evidence::decisive(double tolerance) const {
  const Finding* found = nullptr;
  for (const Finding& one : findings) {
    if (grit::confidence(one.error, one.standard_error, tolerance) != confidence(tolerance)) continue;
    if (found == nullptr || one.error > found->error) found = &one;
  }
  return found;
}

bool saves(const Evidence& level, const Evidence& than) {
  return level.cost + 2 * std::hypot(level.cost_error, than.cost_error) < than.cost;
}

const Evidence* within_and_finer(const std::vector<Evidence>& levels, const Evidence& level, double tolerance) {
  const Evidence* found = nullptr;
  for (const Evidence& one : levels)
    if (&one > &level && one.known && least_sure(levels, one, tolerance).confidence(tolerance) <= Confidence::likely &&
        (found == nullptr || one.cost < found->cost))
      found = &one;
  return found;
}

Evidence together(const std::vector<Advice>& advices) {
  Evidence all;
  for (const Advice& advice : advices) {
    if (advice.now == nullptr) continue;
    add(all, *advice.then());
    all.cost /= advice.now->cost;
  }
  return all;
}

std::vector<Advice> advise(const EvaluatedStudy& study, double tolerance,
                           const std::function<bool(const std::vector<std::string>&)>& same) {
  std::vector<Advice> all;
  for (const auto& [name, levels] : study.settings) {
    Advice& advice = all.emplace_back();
    advice.setting = name;
    try {
      for (const Evidence& level : levels)
        if (same(level.sets)) advice.now = &level;
    } catch (const Error&) {
      advice.found = "does not apply to this description";
      continue;
    }
    if (advice.now == nullptr) {
      advice.found = fmt::format("has a value that was not studied; studied values are {}",
                                 fmt::join(std::views::transform(levels, &Evidence::level), ", "));
      continue;
    }
    if (!advice.now->known) {
      advice.found = advice.now->level + " here, at which runs of the study failed";
      advice.now = nullptr;
      continue;
    }
    for (const Evidence& level : std::views::reverse(levels)) {
      if (!level.known && &level < advice.now) advice.cheaper.push_back(&level);
      if (!level.known || !(level.cost < advice.now->cost)) continue;
      advice.cheaper.push_back(&level);
      if (!saves(level, *advice.now)) continue;
      if (&level > advice.now && changes_no_more(level, *advice.now) &&
          (advice.finer == nullptr || level.cost < advice.finer->cost))
        advice.finer = &level;
      if (least_sure(levels, level, tolerance).confidence(tolerance) > Confidence::likely) continue;
      if (std::ranges::all_of(advice.within, [&](const Evidence* finer) {
            return saves(level, *finer) || !changes_no_more(*finer, level);
          }))
        advice.within.push_back(&level);
    }
    std::ranges::reverse(advice.cheaper);
    std::ranges::stable_sort(advice.within, {}, &Evidence::cost);
    advice.taken = advice.finer;
  }
  Cheapest(all, tolerance).take();
  return all;
}

}  // namespace grit
