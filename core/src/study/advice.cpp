#include "study/advice.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <ranges>

#include "grit/description.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

double number_or_nan(const Description& json) { return json.is_number() ? json.get<double>() : std::nan(""); }

/// Of the figures that are wanted.
std::vector<Finding> findings_of(const Description& deviations, const std::vector<std::string>& figures) {
  std::vector<Finding> all;
  for (const auto& [name, one] : deviations.items())
    if (std::ranges::find(figures, name) != figures.end())
      all.push_back({name, number_or_nan(one.at("error")), number_or_nan(one.at("standard_error"))});
  return all;
}

/// Sorts the figures that count by whether they are charted; all count if none is named.
void read_figures(ChartedStudy& study, const Description& json, const std::vector<std::string>& wanted) {
  std::vector<std::string> with_reference;
  for (const auto& [name, figure] : json.at("figures").items()) {
    if (!wanted.empty() && std::ranges::find(wanted, name) == wanted.end()) continue;
    const Description why = figure.value("not_charted", Description());
    if (why.is_string()) study.uncharted[name] = why.get<std::string>();
    else study.figures.push_back(name);
    if (figure.value("reference", "finest") != "finest") with_reference.push_back(name);
  }
  if (with_reference.empty()) return;
  for (const auto& variant : json.at("variants"))
    if (!variant.at("figures").empty())
      study.beside_references.push_back({.level = variant.at("name").get<std::string>(),
                                         .sets = {},
                                         .findings = findings_of(variant.at("figures"), with_reference)});
}

/// Throws Description::exception if the chart lacks something.
ChartedStudy charted_study(const std::filesystem::path& file, const Description& json,
                           const std::vector<std::string>& figures) {
  for (const auto& name : figures)
    if (!json.at("figures").contains(name)) {
      std::vector<std::string> known;
      for (const auto& [figure, _] : json.at("figures").items()) known.push_back(figure);
      throw Error(fmt::format("{}: has no figure \"{}\" but {}", file.string(), name, fmt::join(known, ", ")));
    }
  ChartedStudy study{file,
                     json.at("title").get<std::string>(),
                     json.at("scenario").get<std::string>(),
                     json.value("parts", std::vector<std::string>()),
                     json.value("advice", true),
                     json.at("samples").get<std::size_t>(),
                     json.value("of_samples", "")};
  read_figures(study, json, figures);
  bool told = false;
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
        evidence.findings = findings_of(effect->at("figures"), study.figures);
      }
      evidence.known = &level == &all.back() || !evidence.findings.empty();
      told |= std::ranges::any_of(evidence.findings, [](const Finding& one) { return std::isfinite(one.error); });
    }
  }
  if (!told)
    throw FileError(
        fmt::format("{}: has no errors of {}, so that nothing can be advised by it; its page says why, and "
                    "'grit chart' makes it anew",
                    file.string(), figures.empty() ? "any figure" : fmt::format("{}", fmt::join(figures, ", "))));
  return study;
}

/// Of a finer level: whether no figure is changed by more than another level changes it.
bool changes_no_more(const Evidence& finer, const Evidence& than) {
  return std::ranges::all_of(finer.findings, [&](const Finding& one) {
    const auto other = std::ranges::find(than.findings, one.figure, &Finding::figure);
    return other != than.findings.end() && one.error <= other->error;
  });
}

/// With the changes of one more setting: errors of a figure add up.
void add(Evidence& sum, const Evidence& one) {
  sum.cost *= one.cost;
  for (const Finding& finding : one.findings) {
    auto own = std::ranges::find(sum.findings, finding.figure, &Finding::figure);
    if (own == sum.findings.end()) own = sum.findings.insert(own, {finding.figure});
    own->error += finding.error;
    own->standard_error = std::hypot(own->standard_error, finding.standard_error);
  }
}

double largest_error(const Evidence& one) {
  return one.findings.empty() ? 0 : std::ranges::max(std::views::transform(one.findings, &Finding::error));
}

/// The cheapest combination of levels within the tolerance. Goes through all but those that begin like one that is
/// beyond it, or that cannot be cheaper than one found before: errors only add up.
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

  /// Takes it, if there is any.
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
    const auto go_on_with = [&](const Evidence* level) {
      Evidence more = sum;
      add(more, *level);
      chosen_.push_back(level);
      choose(more);
      chosen_.pop_back();
    };
    for (const Evidence* level : settings_[k]->within) go_on_with(level);
    go_on_with(settings_[k]->then());
  }

  double tolerance_;
  std::vector<Advice*> settings_;
  std::vector<double> least_cost_;  ///< of each setting and those after it
  std::vector<const Evidence*> chosen_, best_;
  double best_cost_ = std::numeric_limits<double>::infinity(), best_error_ = 0;
};

}  // namespace

ChartedStudy read_charted_study(const std::filesystem::path& file, const std::vector<std::string>& figures) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw FileError(file.string() + ": cannot be read; it should be a chart.json that 'grit chart' wrote");
  try {
    return charted_study(file, Description::parse(stream), figures);
  } catch (const Description::exception&) {
    throw FileError(file.string() + ": is no chart.json; 'grit chart' writes one");
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

std::vector<Finding> far_off(const ChartedStudy& study, double tolerance) {
  std::map<std::string, Finding> nearest;
  std::vector<std::string> reached;
  for (const Evidence& variant : study.beside_references)
    for (const Finding& one : variant.findings) {
      if (confidence(one.error, one.standard_error, tolerance) != Confidence::impossible) reached.push_back(one.figure);
      if (const auto [found, is_new] = nearest.emplace(one.figure, one); !is_new && one.error < found->second.error)
        found->second = one;
    }
  for (const auto& figure : reached) nearest.erase(figure);
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

std::vector<Advice> advise(const ChartedStudy& study, double tolerance,
                           const std::function<bool(const std::vector<std::string>&)>& same) {
  std::vector<Advice> all;
  for (const auto& [name, levels] : study.settings) {
    Advice& advice = all.emplace_back();
    advice.setting = name;
    try {
      for (const Evidence& level : levels)
        if (same(level.sets)) advice.now = &level;
    } catch (const Error&) {
      advice.found = "means nothing in this description";
      continue;
    }
    if (advice.now == nullptr) {
      advice.found = fmt::format("has a value that the study did not try; it tried {}",
                                 fmt::join(std::views::transform(levels, &Evidence::level), ", "));
      continue;
    }
    if (!advice.now->known) {
      advice.found = advice.now->level + " here, with which the study's scene failed";
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
