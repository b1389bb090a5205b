#include "study/advice.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <ranges>

#include "grit/description.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

/// The figure with the largest error among those that count.
void put_largest(Evidence& evidence, const Description& deviations, const std::vector<std::string>& figures) {
  for (const auto& [name, one] : deviations.items()) {
    if (!figures.empty() && std::ranges::find(figures, name) == figures.end()) continue;
    const double error = one.at("error").get<double>();
    if (!evidence.figure.empty() && error <= evidence.error) continue;
    evidence.figure = name, evidence.error = error;
    evidence.standard_error =
        one.at("standard_error").is_number() ? one.at("standard_error").get<double>() : std::nan("");
  }
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
                     json.at("samples").get<std::size_t>(),
                     {}};
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
        put_largest(evidence, effect->at("figures"), figures);
      } else {
        evidence.known = &level == &all.back();
      }
    }
  }
  return study;
}

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

Confidence confidence(const Evidence& evidence, double tolerance) {
  if (evidence.figure.empty() || evidence.error + 2 * evidence.standard_error <= tolerance) return Confidence::certain;
  if (evidence.error <= tolerance) return Confidence::likely;
  return evidence.error <= 2 * evidence.standard_error || std::isnan(evidence.standard_error) ? Confidence::untold
                                                                                              : Confidence::impossible;
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
    for (const Evidence& level : levels) {
      if (!level.known && &level < advice.now) advice.cheaper.push_back(&level);
      if (!level.known || !(level.cost < advice.now->cost)) continue;
      advice.cheaper.push_back(&level);
      const Confidence sure = confidence(level, tolerance);
      if (sure != Confidence::certain && sure != Confidence::likely) continue;
      if (advice.best == nullptr || level.cost < advice.best->cost) advice.best = &level;
    }
  }
  std::vector<Advice*> wanted;
  for (Advice& advice : all)
    if (advice.best != nullptr) wanted.push_back(&advice);
  const auto worth = [](const Advice* a) {
    return std::log(a->now->cost / a->best->cost) / std::max(a->best->error, 1e-12);
  };
  std::ranges::sort(wanted, std::greater(), worth);
  double sum = 0;
  for (Advice* advice : wanted) {
    if (sum + advice->best->error > tolerance) continue;
    advice->taken = true, sum += advice->best->error;
  }
  return all;
}

}  // namespace grit
