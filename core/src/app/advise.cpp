#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "app/options.hpp"
#include "grit/error.hpp"
#include "input/scene.hpp"
#include "lint/installed_studies.hpp"
#include "output/shell_word.hpp"
#include "study/advice.hpp"
#include "study/parts.hpp"

namespace grit {
namespace {

/// The fraction given as "2%", "2 %" or "0.02".
double fraction_of(const std::string& text) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = std::string::npos;
  }
  std::string rest = used == std::string::npos ? "?" : text.substr(used);
  std::erase(rest, ' ');
  if (rest == "%") value /= 100, rest.clear();
  if (!rest.empty() || !(value > 0 && value <= 1))
    throw UsageError("--tolerance takes a fraction above 0 and up to 1, such as 2% or 0.02, not \"" + text + '"');
  return value;
}

std::vector<std::string> lacks(const std::vector<std::string>& these, const std::vector<std::string>& those) {
  std::vector<std::string> missing;
  std::ranges::set_difference(those, these, std::back_inserter(missing));
  return missing;
}

/// The components in which a description and a study's scene differ.
std::string unlike_parts(const EvaluatedStudy& study, const std::vector<std::string>& parts) {
  std::vector<std::string> all;
  for (const auto& part : lacks(parts, study.parts)) all.push_back("the description has no \"" + part + '"');
  for (const auto& part : lacks(study.parts, parts)) all.push_back("the study has no \"" + part + '"');
  return fmt::format("{}", fmt::join(all, ", "));
}

/// The most similar study and its differences from a description.
std::string nearest_scene(const std::vector<EvaluatedStudy>& studies, const std::vector<std::string>& parts) {
  const EvaluatedStudy* nearest = nullptr;
  const auto apart = [&](const EvaluatedStudy& one) {
    return lacks(parts, one.parts).size() + lacks(one.parts, parts).size();
  };
  for (const EvaluatedStudy& one : studies)
    if (!one.sweep && !one.parts.empty() && (nearest == nullptr || apart(one) < apart(*nearest))) nearest = &one;
  if (nearest == nullptr) return "";
  return fmt::format(" (the closest study is \"{}\": {})", nearest->title, unlike_parts(*nearest, parts));
}

std::string kind_of(const std::string& scenario) {
  return scenario.empty() ? "a scene without a scenario" : "a scene of the scenario \"" + scenario + '"';
}

/// Why a study given by the user applies. Throws Error if its scene is a different one.
std::string relation(const EvaluatedStudy& study, const std::string& file, const std::string& scenario,
                     const std::vector<std::string>& parts) {
  if (study.parts == parts) return "of a scene with the same components";
  if (scenario.empty() || study.scenario != scenario)
    throw Error(
        fmt::format("{}: is a study of {}, but {} is {}, so that it does not apply{}; run a study of your "
                    "own scene ('grit describe study'), or omit --study to use the installed studies",
                    study.file.string(), kind_of(study.scenario), file, kind_of(scenario),
                    study.scenario != scenario ? ""
                    : study.parts.empty() ? " (it does not list the components of its scene; run 'grit study' again)"
                                          : " (" + unlike_parts(study, parts) + ')'));
  return fmt::format("of a scene of the same scenario{}",
                     study.parts.empty() ? "" : ", but with other components: " + unlike_parts(study, parts));
}

std::string no_advice(const EvaluatedStudy& study) {
  return fmt::format(
      "{}: is a sweep, of other parameters than numerical settings, so that it gives no advice; run a study of your "
      "scene that varies numerical settings, such as rate, stiffness and time step (see 'grit describe study' and "
      "sims/studies), and give its study.json with --study",
      study.file.string());
}

/// The installed studies of similar scenes. Throws UsageError if there is none.
std::vector<EvaluatedStudy> studies_like(const std::string& scenario, const std::vector<std::string>& parts,
                                         const std::vector<std::string>& metrics) {
  const auto [all, unreadable] = installed_studies();
  for (const std::string& why : unreadable) std::cerr << "grit: omitted: " << why << std::endl;
  std::vector<EvaluatedStudy> studies;
  const EvaluatedStudy* other = nullptr;  // of the scenario, but without advice
  std::vector<std::string> files;
  for (const EvaluatedStudy& study : all) {
    files.push_back(study.file.string());
    if (study.sweep && !scenario.empty() && study.scenario == scenario) other = &study;
    if (is_of(study, scenario, parts)) studies.push_back(read_evaluated_study(study.file, metrics));
  }
  if (studies.empty() && other != nullptr) throw UsageError(no_advice(*other));
  if (studies.empty())
    throw UsageError(fmt::format("{}; give the study.json of a similar scene with --study; installed studies: {}",
                                 scenario.empty() ? "the description has no scenario, and no installed study has a "
                                                    "scene with the same components" +
                                                        nearest_scene(all, parts)
                                                  : "no installed study is of the scenario \"" + scenario + '"',
                                 fmt::join(files, ", ")));
  return studies;
}

/// "5.4 % ± 3.0 %"; "?" for unknown values, such as the standard error of one sample.
std::string with_scatter(double error, double standard_error) {
  const auto text = [](double value) { return std::isnan(value) ? "?" : fmt::format("{:.1f} %", 100 * value); };
  return text(error) + " ± " + text(standard_error);
}

/// "1.16 ± 0.07 times cheaper", or more expensive.
std::string cost_beside(const Evidence& one, const Evidence& now) {
  const bool costs_more = one.cost > now.cost;
  const double ratio = costs_more ? one.cost / now.cost : now.cost / one.cost;
  const double error = ratio * std::hypot(one.cost_error / one.cost, now.cost_error / now.cost);
  const char* word = costs_more ? "more expensive" : "cheaper";
  if (std::isnan(error))
    return fmt::format("{:.2f} ± ? times {} (standard error of run times unknown; add a second seed to the study)",
                       ratio, word);
  return fmt::format("{:.2f} ± {:.2f} times {}{}", ratio, error, word,
                     saves(one, now) || saves(now, one) ? "" : ", which is within the scatter of run times");
}

/// The change of the decisive metric.
std::string changes(const Evidence& one, double tolerance) {
  const Finding* finding = one.decisive(tolerance);
  if (finding == nullptr) return "is the finest level studied";
  return fmt::format("changes {} by {}", finding->metric, with_scatter(finding->error, finding->standard_error));
}

/// The confidence of a level and its reason. `levels`: all levels of its setting.
std::string why(const std::vector<Evidence>& levels, const Evidence& one, double tolerance) {
  if (const Evidence& finer = least_sure(levels, one, tolerance); &finer != &one)
    return fmt::format(
        "{}: {}, which is finer, {}{}", word_of(finer.confidence(tolerance)), finer.level, changes(finer, tolerance),
        finer.confidence(tolerance) == Confidence::likely ? "" : ", so that errors may cancel at this level");
  const Confidence own = one.confidence(tolerance);
  std::string text = word_of(own);
  if (const Finding* finding = one.decisive(tolerance); finding != nullptr && std::isnan(finding->standard_error))
    text += ": sample variance unknown";
  else if (own == Confidence::likely || own == Confidence::inconclusive) text += ": large scatter between samples";
  if (own == Confidence::inconclusive) text += "; use a study with more seeds";
  return text;
}

/// The description and the options given on the command line.
struct Asked {
  std::string file;
  std::vector<std::string> sets, studies, metrics;  ///< values of --set, --study and --metric
  double tolerance = 0;
  std::function<bool(const std::vector<std::string>&)> same;  ///< see advise()
};

/// The last value of each pointer.
std::vector<std::string> each_once(const std::vector<std::string>& sets) {
  std::vector<std::string> once;
  for (const auto& set : sets) {
    const std::string pointer = set.substr(0, set.find('=') + 1);
    std::erase_if(once, [&](const std::string& other) { return other.starts_with(pointer); });
    once.push_back(set);
  }
  return once;
}

std::string words_of(const std::string& option, const std::vector<std::string>& values) {
  std::string text;
  for (const auto& value : values) text += ' ' + option + ' ' + shell_word(value);
  return text;
}

/// The relaxed settings, e.g. "depth 6 mm, safety 0.8".
std::string relaxed(const std::vector<Advice>& advices) {
  std::vector<std::string> all;
  for (const Advice& advice : advices)
    if (advice.is_relaxed()) all.push_back(advice.setting + ' ' + advice.taken->level);
  return fmt::format("{}", fmt::join(all, ", "));
}

/// The lowest tolerance, in whole per cent from the given one on, at which settings can be relaxed, and these settings.
/// Nothing if there is none.
std::optional<std::pair<double, std::string>> least_tolerance(const EvaluatedStudy& study, const Asked& asked) {
  for (double tolerance = asked.tolerance; tolerance <= 1;
       tolerance = 0.01 * (std::floor(100 * tolerance + 1e-9) + 1))  // 100 * 0.29 is a little less than 29
    if (const auto what = relaxed(advise(study, tolerance, asked.same)); !what.empty())
      return std::pair(tolerance, what);
  return std::nullopt;
}

/// Prints the tolerances at which the same study relaxes settings, for all metrics and for each one alone.
void print_where(const EvaluatedStudy& study, const Asked& asked) {
  std::string lines;
  const auto add = [&](const EvaluatedStudy& of, const std::vector<std::string>& metrics) {
    if (const auto found = least_tolerance(of, asked))
      lines += fmt::format("  grit advise {}{}{}{} --tolerance {:.3g}%\n      {}\n", shell_word(asked.file),
                           words_of("--set", asked.sets), words_of("--study", asked.studies),
                           words_of("--metric", metrics), 100 * found->first, found->second);
  };
  add(study, asked.metrics);
  if (study.metrics.size() > 1)
    for (const auto& metric : study.metrics) try {
        add(read_evaluated_study(study.file, {metric}), {metric});
      } catch (const FileError&) {  // the study has no errors of this metric
      }
  std::cout << (lines.empty() ? "nor for a single metric of the study or at a higher tolerance\n"
                              : "settings can be relaxed with\n" + lines);
}

/// Prints why no setting can be relaxed. Returns whether any coarser level is cheaper.
bool print_why_not(const EvaluatedStudy& study, const std::vector<Advice>& advices, double tolerance) {
  std::vector<std::string> held;
  std::map<std::string, int> against;  // by metric that decides
  for (const Advice& advice : advices)
    for (const Evidence* one : advice.cheaper) {
      if (!one->known || one > advice.now || !saves(*one, *advice.now)) continue;
      const Evidence& decisive = least_sure(study.settings.at(advice.setting), *one, tolerance);
      if (decisive.confidence(tolerance) <= Confidence::likely) held.push_back(advice.setting + ' ' + one->level);
      else ++against[decisive.decisive(tolerance)->metric];
    }
  std::vector<std::string> counts;
  for (const auto& [metric, count] : against) counts.push_back(fmt::format("{} ({})", metric, count));
  if (held.empty() && counts.empty()) {
    std::cout << "no coarser level of the study is known to be cheaper\n";
    return false;
  }
  std::cout << "no setting can be relaxed\n";
  if (!counts.empty())
    std::cout << fmt::format("  metrics that exclude coarser levels, each level on its own: {}\n",
                             fmt::join(counts, ", "));
  if (held.empty()) return true;
  const Evidence stays = together(advices);
  const Finding* sum = stays.decisive(tolerance);
  std::cout << fmt::format("  within the tolerance on its own, but not together with the other settings: {}\n",
                           fmt::join(held, ", "));
  const Advice* most = nullptr;
  const Finding* largest = nullptr;
  for (const Advice& advice : advices)
    if (sum != nullptr && advice.now != nullptr)
      for (const Finding& one : advice.then()->findings)
        if (one.metric == sum->metric && (largest == nullptr || one.error > largest->error))
          most = &advice, largest = &one;
  if (most != nullptr)
    std::cout << fmt::format("  the largest change of these: {} {} changes {} by {}\n", most->setting,
                             most->then()->level, largest->metric,
                             with_scatter(largest->error, largest->standard_error));
  return true;
}

/// Prints the limits of the study: metrics without a result, and metrics far from their references.
void print_metric_caveats(const EvaluatedStudy& study, double tolerance) {
  for (const auto& [metric, why] : study.unevaluated)
    std::cout << fmt::format("  {} could not be evaluated: {}\n", metric, why);
  for (const Finding& one : far_off(study, tolerance))
    std::cout << fmt::format(
        "  {} deviates from its own reference by more than the tolerance in every variant, {} at best; its changes are "
        "relative to the finest level only\n",
        one.metric, with_scatter(one.error, one.standard_error));
}

/// `related`: how the study is related to the description.
void print(const EvaluatedStudy& study, const std::string& related, const Asked& asked) {
  const double tolerance = asked.tolerance;
  const auto advices = advise(study, tolerance, asked.same);
  std::cout << fmt::format("{}, within {:.3g} %, by the study \"{}\"\n  ({}, {} samples per variant),\n  {}\n",
                           asked.file, 100 * tolerance, study.title, study.file.string(), study.samples, related);
  if (!study.of_samples.empty()) std::cout << "  " << study.of_samples << '\n';
  print_metric_caveats(study, tolerance);
  std::cout << '\n';
  std::vector<std::string> beyond, inconclusive, unknown, given = asked.sets;
  for (const Advice& advice : advices) {
    if (advice.now == nullptr) {
      std::cout << fmt::format("  {}: {}\n", advice.setting, advice.found);
      unknown.push_back(advice.setting);
      continue;
    }
    const auto& levels = study.settings.at(advice.setting);
    std::cout << fmt::format("  {}: {} here; {}{}\n", advice.setting, advice.now->level,
                             changes(*advice.now, tolerance),
                             advice.now->findings.empty() ? "" : ", " + why(levels, *advice.now, tolerance));
    const Confidence within = least_sure(levels, *advice.now, tolerance).confidence(tolerance);
    if (const Evidence* finer = within_and_finer(levels, *advice.now, tolerance);
        finer != nullptr && within == Confidence::exceeded)
      beyond.push_back(fmt::format("{} {}; {}, which is finer, is within it and {}", advice.setting, advice.now->level,
                                   finer->level, cost_beside(*finer, *advice.now)));
    if (within == Confidence::inconclusive) inconclusive.push_back(advice.setting);
    if (advice.cheaper.empty()) std::cout << "      no cheaper level was studied\n";
    for (const Evidence* one : advice.cheaper)
      std::cout << (one->known ? fmt::format("    {} {}: {}{}, {}{}\n", one == advice.taken ? "→" : " ", one->level,
                                             one > advice.now ? "finer and " : "", cost_beside(*one, *advice.now),
                                             changes(*one, tolerance),
                                             one->findings.empty() ? "" : ", " + why(levels, *one, tolerance))
                               : fmt::format("      {}: runs of the study failed at this level\n", one->level));
    if (advice.taken != nullptr) given.insert(given.end(), advice.taken->sets.begin(), advice.taken->sets.end());
  }
  std::cout << '\n';
  for (const auto& one : beyond) std::cout << "beyond the tolerance already: " << one << '\n';
  if (!inconclusive.empty())
    std::cout << fmt::format("inconclusive already: {}; use a study with more seeds\n", fmt::join(inconclusive, ", "));
  const Evidence all = together(advices);
  const bool any = std::ranges::any_of(advices, [](const Advice& one) { return one.taken != nullptr; });
  const bool more_wanted =
      std::ranges::none_of(advices, &Advice::is_relaxed) && print_why_not(study, advices, tolerance);
  if (any) std::cout << fmt::format("combined, about {:.1f} times cheaper\n", 1 / all.cost);
  if (const Finding* sum = all.decisive(tolerance))
    std::cout << fmt::format(
        "sum of the changes by all settings, including unchanged ones, if they do not interact: {} ({}), {}{}\n",
        with_scatter(sum->error, sum->standard_error), sum->metric, word_of(all.confidence(tolerance)),
        unknown.empty() ? "" : fmt::format("; not included: {}", fmt::join(unknown, ", ")));
  if (any) std::cout << "  grit run " << shell_word(asked.file) << words_of("--set", each_once(given)) << '\n';
  if (more_wanted) print_where(study, asked);
}

}  // namespace

void advise_options(Options& options) {
  namespace po = boost::program_options;
  options.add()("tolerance", po::value<std::string>()->default_value("5%")->value_name("FRACTION"),
                "allowed error, e.g. 2% or 0.02")(
      "study", po::value<std::vector<std::string>>()->composing()->value_name("FILE"),
      "study.json of a study; may be repeated; default: installed studies of the same scenario, or of a scene with the "
      "same components")("metric", po::value<std::vector<std::string>>()->composing()->value_name("METRIC"),
                         "metric to keep within the tolerance; may be repeated; default: all metrics of the study");
  options.add_set();
}

ExitStatus advise_command(const Options& options) {
  const std::string file = options.only_word("description");
  const double tolerance = fraction_of(options.get<std::string>("tolerance"));
  const auto registry = options.registry();
  const auto sets = options.list("set");
  const Description now = resolved(*load_scene(file, sets, *registry).description);
  std::map<std::vector<std::string>, std::optional<bool>> seen;  // nothing: cannot be read with these sets
  const auto same = [&](const std::vector<std::string>& more) {
    const auto [found, is_new] = seen.try_emplace(more);
    if (is_new) try {
        auto all = sets;
        all.insert(all.end(), more.begin(), more.end());
        found->second = resolved(*load_scene(file, all, *registry).description) == now;
      } catch (const Error&) {
      }
    if (!found->second) throw Error(file + ": cannot be read with " + fmt::format("{}", fmt::join(more, ", ")));
    return *found->second;
  };
  std::vector<EvaluatedStudy> studies;
  for (const auto& result : options.list("study")) {
    studies.push_back(read_evaluated_study(result, options.list("metric")));
    if (studies.back().sweep) throw UsageError(no_advice(studies.back()));
  }
  const auto scenario = scenario_type(Document::load(file));
  const auto parts = parts_of(now);
  if (studies.empty()) studies = studies_like(scenario, parts, options.list("metric"));
  std::vector<std::string> related;  // of all studies before anything is printed
  for (const EvaluatedStudy& study : studies) related.push_back(relation(study, file, scenario, parts));
  for (std::size_t i = 0; i < studies.size(); ++i) {
    if (i > 0) std::cout << '\n';
    print(studies[i], related[i],
          {file, each_once(sets), options.list("study"), options.list("metric"), tolerance, same});
  }
  return ExitStatus::done;
}

}  // namespace grit
