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

/// "2%", "2 %" or 0.02; at most all.
double share_of(const std::string& text) {
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
    throw UsageError("--tolerance takes a share above 0 and up to 1, such as 2% or 0.02, not \"" + text + '"');
  return value;
}

std::vector<std::string> lacks(const std::vector<std::string>& these, const std::vector<std::string>& those) {
  std::vector<std::string> missing;
  std::ranges::set_difference(those, these, std::back_inserter(missing));
  return missing;
}

/// What tells a description from a study's scene.
std::string unlike_parts(const ChartedStudy& study, const std::vector<std::string>& parts) {
  std::vector<std::string> all;
  for (const auto& part : lacks(parts, study.parts)) all.push_back("here is no \"" + part + '"');
  for (const auto& part : lacks(study.parts, parts)) all.push_back("there is no \"" + part + '"');
  return fmt::format("{}", fmt::join(all, ", "));
}

/// What tells a description from the scene of the study that is most like it.
std::string nearest_scene(const std::vector<ChartedStudy>& studies, const std::vector<std::string>& parts) {
  const ChartedStudy* nearest = nullptr;
  const auto apart = [&](const ChartedStudy& one) {
    return lacks(parts, one.parts).size() + lacks(one.parts, parts).size();
  };
  for (const ChartedStudy& one : studies)
    if (one.advice && !one.parts.empty() && (nearest == nullptr || apart(one) < apart(*nearest))) nearest = &one;
  if (nearest == nullptr) return "";
  return fmt::format(" (the nearest is of \"{}\": {})", nearest->title, unlike_parts(*nearest, parts));
}

std::string kind_of(const std::string& scenario) {
  return scenario.empty() ? "a scene without a scenario" : "the scenario \"" + scenario + '"';
}

/// Why a study that was named may be applied. Throws Error if its scene is another.
std::string relation(const ChartedStudy& study, const std::string& file, const std::string& scenario,
                     const std::vector<std::string>& parts) {
  if (study.parts == parts) return "whose scene has the same parts";
  if (scenario.empty() || study.scenario != scenario)
    throw Error(
        fmt::format("{}: is of {}, and {} is {}, so that nothing may be relaxed by it{}; run a study of your "
                    "own scene ('grit describe study'), or leave out --study for those that came with grit",
                    study.file.string(), kind_of(study.scenario), file, kind_of(scenario),
                    study.scenario != scenario ? ""
                    : study.parts.empty() ? ": it does not say what its scene is made of, which 'grit chart' now does"
                                          : " (" + unlike_parts(study, parts) + ')'));
  return fmt::format("whose scene is of the same scenario{}",
                     study.parts.empty() ? "" : ", but not of the same parts: " + unlike_parts(study, parts));
}

std::string no_advice(const ChartedStudy& study) {
  return fmt::format(
      "{}: its settings are what is modelled, not how it is computed (\"advice\": false), so that nothing may be "
      "relaxed by it; run a study of your scene that varies how it is computed, such as rate, stiffness and time step "
      "('grit describe study' and sims/studies say how), and name its chart.json with --study",
      study.file.string());
}

/// The studies that came with grit for scenes like this. Throws UsageError if there is none.
std::vector<ChartedStudy> studies_like(const std::string& scenario, const std::vector<std::string>& parts,
                                       const std::vector<std::string>& figures) {
  const auto [all, unreadable] = installed_studies();
  for (const std::string& why : unreadable) std::cerr << "grit: left out: " << why << std::endl;
  std::vector<ChartedStudy> studies;
  const ChartedStudy* other = nullptr;  // of the scenario, but not to advise by
  std::vector<std::string> files;
  for (const ChartedStudy& study : all) {
    files.push_back(study.file.string());
    if (!study.advice && !scenario.empty() && study.scenario == scenario) other = &study;
    if (is_of(study, scenario, parts)) studies.push_back(read_charted_study(study.file, figures));
  }
  if (studies.empty() && other != nullptr) throw UsageError(no_advice(*other));
  if (studies.empty())
    throw UsageError(fmt::format("{}; name a chart.json of a scene like yours with --study; with grit came {}",
                                 scenario.empty() ? "the description has no scenario, and no study that came with this "
                                                    "grit has a scene of the same parts" +
                                                        nearest_scene(all, parts)
                                                  : "no study of scenario \"" + scenario + "\" came with this grit",
                                 fmt::join(files, ", ")));
  return studies;
}

/// "5.4 % ± 3.0 %"; "?" for the scatter of one sample, and for what a chart does not tell.
std::string with_scatter(double error, double standard_error) {
  const auto told = [](double share) { return std::isnan(share) ? "?" : fmt::format("{:.1f} %", 100 * share); };
  return told(error) + " ± " + told(standard_error);
}

/// "1.16 ± 0.07 times cheaper", or dearer.
std::string cost_beside(const Evidence& one, const Evidence& now) {
  const bool dearer = one.cost > now.cost;
  const double ratio = dearer ? one.cost / now.cost : now.cost / one.cost;
  const double error = ratio * std::hypot(one.cost_error / one.cost, now.cost_error / now.cost);
  const char* word = dearer ? "dearer" : "cheaper";
  if (std::isnan(error))
    return fmt::format("{:.2f} ± ? times {} (the chart has no scatter of times, which a second seed would give)", ratio,
                       word);
  return fmt::format("{:.2f} ± {:.2f} times {}{}", ratio, error, word,
                     saves(one, now) || saves(now, one) ? "" : ", which is within what times scatter");
}

/// Of the figure that decides.
std::string changes(const Evidence& one, double tolerance) {
  const Finding* finding = one.decisive(tolerance);
  if (finding == nullptr) return "is the finest that was tried";
  return fmt::format("changes {} by {}", finding->figure, with_scatter(finding->error, finding->standard_error));
}

/// `levels`: all of its setting.
std::string why(const std::vector<Evidence>& levels, const Evidence& one, double tolerance) {
  if (const Evidence& finer = least_sure(levels, one, tolerance); &finer != &one)
    return fmt::format("{}: {}, which is finer, {}{}", word_of(finer.confidence(tolerance)), finer.level,
                       changes(finer, tolerance),
                       finer.confidence(tolerance) == Confidence::likely ? "" : ", so that errors may cancel here");
  const Confidence own = one.confidence(tolerance);
  std::string text = word_of(own);
  if (const Finding* finding = one.decisive(tolerance); finding != nullptr && std::isnan(finding->standard_error))
    text += ": nobody knows how samples scatter";
  else if (own == Confidence::likely || own == Confidence::untold)
    text += ": the samples scatter by more than the tolerance leaves";
  if (own == Confidence::untold) text += "; a study with more seeds would tell";
  return text;
}

/// What a description is, for the command line.
struct Asked {
  std::string file;
  std::vector<std::string> sets, studies, figures;  ///< of --study none where it was not given, of --figure likewise
  double tolerance = 0;
  std::function<bool(const std::vector<std::string>&)> same;  ///< as advise() takes it
};

/// The last of each pointer.
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

/// "depth 6 mm, safety 0.8": what is relaxed.
std::string relaxed(const std::vector<Advice>& advices) {
  std::vector<std::string> all;
  for (const Advice& advice : advices)
    if (advice.is_relaxed()) all.push_back(advice.setting + ' ' + advice.taken->level);
  return fmt::format("{}", fmt::join(all, ", "));
}

/// The least tolerance in whole per cent, from the wanted one on, at which something may be relaxed, and what. Nothing
/// if there is none.
std::optional<std::pair<double, std::string>> least_tolerance(const ChartedStudy& study, const Asked& asked) {
  for (double tolerance = asked.tolerance; tolerance <= 1;
       tolerance = 0.01 * (std::floor(100 * tolerance + 1e-9) + 1))  // 0.29 is a little less than 29 of 0.01
    if (const auto what = relaxed(advise(study, tolerance, asked.same)); !what.empty())
      return std::pair(tolerance, what);
  return std::nullopt;
}

/// Where something may be relaxed by the same study: at which tolerance, for all figures or for one alone.
void print_where(const ChartedStudy& study, const Asked& asked) {
  std::string lines;
  const auto add = [&](const ChartedStudy& of, const std::vector<std::string>& figures) {
    if (const auto found = least_tolerance(of, asked))
      lines += fmt::format("  grit advise {}{}{}{} --tolerance {:.3g}%\n      {}\n", shell_word(asked.file),
                           words_of("--set", asked.sets), words_of("--study", asked.studies),
                           words_of("--figure", figures), 100 * found->first, found->second);
  };
  add(study, asked.figures);
  if (study.figures.size() > 1)
    for (const auto& figure : study.figures) try {
        add(read_charted_study(study.file, {figure}), {figure});
      } catch (const FileError&) {  // the study has no errors of it
      }
  std::cout << (lines.empty() ? "nor by another figure of the study, or at another tolerance\n"
                              : "by the same study something may be relaxed with\n" + lines);
}

/// Why nothing may be relaxed. Returns whether there is anything cheaper that it could be.
bool print_why_not(const ChartedStudy& study, const std::vector<Advice>& advices, double tolerance) {
  std::vector<std::string> held;
  std::map<std::string, int> against;  // by figure that decides
  for (const Advice& advice : advices)
    for (const Evidence* one : advice.cheaper) {
      if (!one->known || one > advice.now || !saves(*one, *advice.now)) continue;
      const Evidence& decisive = least_sure(study.settings.at(advice.setting), *one, tolerance);
      if (decisive.confidence(tolerance) <= Confidence::likely) held.push_back(advice.setting + ' ' + one->level);
      else ++against[decisive.decisive(tolerance)->figure];
    }
  std::vector<std::string> counts;
  for (const auto& [figure, count] : against) counts.push_back(fmt::format("{} ({})", figure, count));
  if (held.empty() && counts.empty()) {
    std::cout << "nothing coarser that the study tried is known to be cheaper\n";
    return false;
  }
  std::cout << "nothing that the study tried may be relaxed\n";
  if (!counts.empty())
    std::cout << fmt::format("  what decides against coarser levels, each by itself: {}\n", fmt::join(counts, ", "));
  if (held.empty()) return true;
  const Evidence stays = together(advices);
  const Finding* sum = stays.decisive(tolerance);
  std::cout << fmt::format("  within the tolerance by itself, but not with what the other settings change: {}\n",
                           fmt::join(held, ", "));
  const Advice* most = nullptr;
  const Finding* largest = nullptr;
  for (const Advice& advice : advices)
    if (sum != nullptr && advice.now != nullptr)
      for (const Finding& one : advice.then()->findings)
        if (one.figure == sum->figure && (largest == nullptr || one.error > largest->error))
          most = &advice, largest = &one;
  if (most != nullptr)
    std::cout << fmt::format("  the largest of these is that of {} {}, which changes {} by {}\n", most->setting,
                             most->then()->level, largest->figure,
                             with_scatter(largest->error, largest->standard_error));
  return true;
}

/// What the figures that count are not told of.
void print_untold_figures(const ChartedStudy& study, double tolerance) {
  for (const auto& [figure, why] : study.uncharted)
    std::cout << fmt::format("  nothing is known of {}, which counts but could not be charted: {}\n", figure, why);
  for (const Finding& one : far_off(study, tolerance))
    std::cout << fmt::format(
        "  {} is at every level further than the tolerance from the reference of its own, {} at "
        "best: what is said of it is of changes beside the finest level alone\n",
        one.figure, with_scatter(one.error, one.standard_error));
}

/// `related`: how to the description.
void print(const ChartedStudy& study, const std::string& related, const Asked& asked) {
  const double tolerance = asked.tolerance;
  const auto advices = advise(study, tolerance, asked.same);
  std::cout << fmt::format("{}, within {:.3g} %, by {}\n  ({}, {} samples of each variant),\n  {}\n", asked.file,
                           100 * tolerance, study.title, study.file.string(), study.samples, related);
  if (!study.of_samples.empty()) std::cout << "  " << study.of_samples << '\n';
  print_untold_figures(study, tolerance);
  std::cout << '\n';
  std::vector<std::string> beyond, untold, unknown, given = asked.sets;
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
        finer != nullptr && within == Confidence::impossible)
      beyond.push_back(fmt::format("{} {}; {}, which is finer, is within it and {}", advice.setting, advice.now->level,
                                   finer->level, cost_beside(*finer, *advice.now)));
    if (within == Confidence::untold) untold.push_back(advice.setting);
    if (advice.cheaper.empty()) std::cout << "      nothing cheaper was tried\n";
    for (const Evidence* one : advice.cheaper)
      std::cout << (one->known ? fmt::format("    {} {}: {}{}, {}{}\n", one == advice.taken ? "→" : " ", one->level,
                                             one > advice.now ? "finer and " : "", cost_beside(*one, *advice.now),
                                             changes(*one, tolerance),
                                             one->findings.empty() ? "" : ", " + why(levels, *one, tolerance))
                               : fmt::format("      {}: runs of the study failed with it\n", one->level));
    if (advice.taken != nullptr) given.insert(given.end(), advice.taken->sets.begin(), advice.taken->sets.end());
  }
  std::cout << '\n';
  for (const auto& one : beyond) std::cout << "beyond the tolerance as it is: " << one << '\n';
  if (!untold.empty())
    std::cout << fmt::format("cannot be told of as it is: {}; a study with more seeds would tell\n",
                             fmt::join(untold, ", "));
  const Evidence all = together(advices);
  const bool any = std::ranges::any_of(advices, [](const Advice& one) { return one.taken != nullptr; });
  const bool more_wanted =
      std::ranges::none_of(advices, &Advice::is_relaxed) && print_why_not(study, advices, tolerance);
  if (any) std::cout << fmt::format("together about {:.1f} times cheaper\n", 1 / all.cost);
  if (const Finding* sum = all.decisive(tolerance))
    std::cout << fmt::format(
        "what all settings change, those that stay included, adds up to {} ({}), if they do not act on each other: "
        "{}{}\n",
        with_scatter(sum->error, sum->standard_error), sum->figure, word_of(all.confidence(tolerance)),
        unknown.empty() ? "" : fmt::format("; not counted: {}", fmt::join(unknown, ", ")));
  if (any) std::cout << "  grit run " << shell_word(asked.file) << words_of("--set", each_once(given)) << '\n';
  if (more_wanted) print_where(study, asked);
}

}  // namespace

ExitStatus advise_command(const std::vector<std::string>& words) {
  namespace po = boost::program_options;
  Options options(command("advise"));
  options.add()("tolerance", po::value<std::string>()->default_value("5%")->value_name("SHARE"),
                "error that is good enough, e.g. 2% or 0.02")(
      "study", po::value<std::vector<std::string>>()->composing()->value_name("CHART"),
      "chart.json of a study; may be given again; default: those that came with grit for the same scenario, or for a "
      "scene of the same parts")("figure", po::value<std::vector<std::string>>()->composing()->value_name("NAME"),
                                 "figure that counts; may be given again; default: all of the study");
  options.add_set();
  if (!options.read(words)) return ExitStatus::done;
  const std::string file = options.only_word("description");
  const double tolerance = share_of(options.get<std::string>("tolerance"));
  const auto registry = options.registry();
  const auto sets = options.list("set");
  const Description now = resolved(*load_scene(file, sets, *registry).description);
  std::map<std::vector<std::string>, std::optional<bool>> seen;  // nothing: not to be read with them
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
  std::vector<ChartedStudy> studies;
  for (const auto& chart : options.list("study")) {
    studies.push_back(read_charted_study(chart, options.list("figure")));
    if (!studies.back().advice) throw UsageError(no_advice(studies.back()));
  }
  const auto scenario = scenario_type(Document::load(file));
  const auto parts = parts_of(now);
  if (studies.empty()) studies = studies_like(scenario, parts, options.list("figure"));
  std::vector<std::string> related;  // of all before anything is said
  for (const ChartedStudy& study : studies) related.push_back(relation(study, file, scenario, parts));
  for (std::size_t i = 0; i < studies.size(); ++i) {
    if (i > 0) std::cout << '\n';
    print(studies[i], related[i],
          {file, each_once(sets), options.list("study"), options.list("figure"), tolerance, same});
  }
  return ExitStatus::done;
}

}  // namespace grit
