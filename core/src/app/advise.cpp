#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <iterator>

#include "app/options.hpp"
#include "app/shipped_studies.hpp"
#include "grit/error.hpp"
#include "input/scene.hpp"
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

/// The studies that came with grit for scenes like this. Throws UsageError if there is none.
std::vector<ChartedStudy> studies_like(const std::string& scenario, const std::vector<std::string>& parts,
                                       const std::vector<std::string>& figures) {
  const auto all = shipped_studies();
  std::vector<ChartedStudy> studies;
  std::vector<std::string> files;
  for (const ChartedStudy& study : all) {
    files.push_back(study.file.string());
    if (is_of(study, scenario, parts)) studies.push_back(read_charted_study(study.file, figures));
  }
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

/// "1.16 ± 0.07 times cheaper"
std::string saving(const Evidence& one, const Evidence& now) {
  const double ratio = now.cost / one.cost;
  const double error = ratio * std::hypot(one.cost_error / one.cost, now.cost_error / now.cost);
  if (std::isnan(error)) return fmt::format("{:.2f} ± ? times cheaper (the chart has no scatter of times)", ratio);
  return fmt::format("{:.2f} ± {:.2f} times cheaper{}", ratio, error,
                     saves(one, now) ? "" : ", which is within what times scatter");
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
  if (own == Confidence::likely || own == Confidence::untold)
    text += ": the samples scatter by more than the tolerance leaves";
  if (own == Confidence::untold) text += "; a study with more seeds would tell";
  return text;
}

/// `related`: how to the description. `given`: what --set changed in that.
void print(const ChartedStudy& study, const std::string& related, const std::string& file,
           std::vector<std::string> given, double tolerance, const std::vector<Advice>& advices) {
  std::cout << fmt::format("{}, within {:.3g} %, by {}\n  ({}, {} samples of each variant),\n  {}\n\n", file,
                           100 * tolerance, study.title, study.file.string(), study.samples, related);
  std::vector<std::string> beyond, untold, unknown;
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
    if (within == Confidence::impossible) beyond.push_back(advice.setting);
    if (within == Confidence::untold) untold.push_back(advice.setting);
    if (advice.cheaper.empty()) std::cout << "      nothing cheaper was tried\n";
    for (const Evidence* one : advice.cheaper)
      std::cout << (one->known ? fmt::format("    {} {}: {}, {}, {}\n", one == advice.best && advice.taken ? "→" : " ",
                                             one->level, saving(*one, *advice.now), changes(*one, tolerance),
                                             why(levels, *one, tolerance))
                               : fmt::format("      {}: runs of the study failed with it\n", one->level));
    if (advice.taken) given.insert(given.end(), advice.best->sets.begin(), advice.best->sets.end());
  }
  std::cout << '\n';
  if (!beyond.empty())
    std::cout << fmt::format("beyond the tolerance as it is: {}; a finer value costs more\n", fmt::join(beyond, ", "));
  if (!untold.empty())
    std::cout << fmt::format("cannot be told of as it is: {}; a study with more seeds would tell\n",
                             fmt::join(untold, ", "));
  const Evidence all = together(advices);
  const bool any = std::ranges::any_of(advices, &Advice::taken);
  if (any) std::cout << fmt::format("together about {:.1f} times cheaper\n", 1 / all.cost);
  else std::cout << "nothing that the study tried may be relaxed\n";
  if (const Finding* sum = all.decisive(tolerance))
    std::cout << fmt::format(
        "what all settings change, those that stay included, adds up to {} ({}), if they do not act on each other{}\n",
        with_scatter(sum->error, sum->standard_error), sum->figure,
        unknown.empty() ? "" : fmt::format("; not counted: {}", fmt::join(unknown, ", ")));
  if (!any) return;
  std::cout << "  grit run " << shell_word(file);
  for (const auto& set : given) std::cout << " --set " << shell_word(set);
  std::cout << '\n';
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
  const auto same = [&](const std::vector<std::string>& more) {
    auto all = sets;
    all.insert(all.end(), more.begin(), more.end());
    return resolved(*load_scene(file, all, *registry).description) == now;
  };
  std::vector<ChartedStudy> studies;
  for (const auto& chart : options.list("study")) {
    studies.push_back(read_charted_study(chart, options.list("figure")));
    if (!studies.back().advice)
      throw UsageError(chart +
                       ": its settings are what is modelled, not how (\"advice\": false), so that nothing may be "
                       "relaxed by it; name another study");
  }
  const auto scenario = scenario_type(Document::load(file));
  const auto parts = parts_of(now);
  if (studies.empty()) studies = studies_like(scenario, parts, options.list("figure"));
  std::vector<std::string> related;  // of all before anything is said
  for (const ChartedStudy& study : studies) related.push_back(relation(study, file, scenario, parts));
  for (std::size_t i = 0; i < studies.size(); ++i) {
    if (i > 0) std::cout << '\n';
    print(studies[i], related[i], file, sets, tolerance, advise(studies[i], tolerance, same));
  }
  return ExitStatus::done;
}

}  // namespace grit
