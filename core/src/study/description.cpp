#include "study/description.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "format/number.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "input/document.hpp"
#include "input/file_kind.hpp"
#include "input/reader.hpp"
#include "study/number_with_unit.hpp"

namespace grit {
namespace {

/// Integers up to here are exact in double precision.
constexpr double largest_seed = 1e15;

/// A value as text, strings without quotes.
std::string plain(const Description& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const auto& one : value) text += (text.empty() ? "" : " ") + plain(one);
  return text;
}

/// Whether the first pointer lies at or below the second.
bool covers(const std::string& one, const std::string& other) { return (other + '/').starts_with(one + '/'); }

/// Levels would not differ if another change followed.
void check_pointers(const StudyDescription& study, const Complain& complain) {
  std::vector<ChangedPointer> varied;
  for (const auto& [name, setting] : study.settings)
    for (std::size_t i = 0; i < setting.pointers.size(); ++i)
      varied.push_back({setting.pointers[i], fmt::format("settings/{}/pointers/{}", name, i)});
  varied.push_back({study.seeds.pointer, "seeds/pointer"});
  refuse_changed_twice(varied, "a value that no other setting and no seed changes", complain);
}

}  // namespace

void MeanMetric::declare(Parameters& p) {
  p.add("fraction", fraction).above(0).at_most(1).doc("final fraction of the abscissa's range over which to average");
}
void ValueMetric::declare(Parameters& p) {
  p.add("at", at).required().doc(
      "abscissa at which to evaluate the curve: a number in the unit of its channel, or a text with a unit");
}
void MetricDescription::declare_channels(Parameters& p) {
  p.choose(what);
  p.add("of", of).required().doc("channel, as PROBE/CHANNEL");
  p.add("against", against)
      .doc(
          "channel of the abscissa; default: time, or the index in a profile. A curve omits points at which the "
          "abscissa does not exceed all values before");
  p.check([this](const Complain& complain) {
    check_channel(of, "of", complain), check_channel(against, "against", complain);
  });
}
void MetricDescription::declare(Parameters& p) {
  declare_channels(p);
  p.add("scale", written_scale)
      .doc(
          "divisor of errors, a number in the unit of the channel or a text with a unit; default: largest magnitude of "
          "the reference");
  p.add("value", written_value)
      .doc(
          "reference value, a number in the unit of the channel or a text with a unit; default: result of the finest "
          "settings, none in a sweep");
  p.add("curve", curve).doc("reference curve; default: result of the finest settings, none in a sweep");
  p.check([this](const Complain& complain) {
    if (!written_value.is_null() && is_curve())
      complain("value", "one value for a curve", "a reference curve, or neither");
    find_numbers({}, complain);
    if (curve && !is_curve()) complain("curve", "a curve for one value", "a reference value, or neither");
  });
}
std::string MetricDescription::channel() const {
  return std::holds_alternative<PositionOfMaximumMetric>(what.value()) ? abscissa() : of;
}
std::string MetricDescription::abscissa() const {
  if (!against.empty() || std::holds_alternative<ProfileMetric>(what.value())) return against;
  return of.substr(0, of.find('/')) + "/time";
}
void MetricDescription::find_numbers(const std::map<std::string, std::string>& units, const Complain& complain) {
  const auto find = [&](const Description& written, const std::string& in, const char* key) {
    const auto known = units.find(in);
    const std::string unit = known == units.end() ? "" : known->second;
    const auto number = number_in(unit, written);
    if (!number && !written.is_null() && (!written.is_string() || !unit.empty()))
      complain(key, describe_value(written), numbers_in(unit));
    return number;
  };
  value = find(written_value, channel(), "value"), scale = find(written_scale, channel(), "scale");
  if (scale && !(*scale > 0)) complain("scale", describe_value(written_scale), "a value above 0");
  if (value == 0.0 && written_scale.is_null())
    complain("value", "0 without a scale", "0 with a scale, by which errors are divided");
  if (const auto* at = std::get_if<ValueMetric>(&what.value())) find(at->at, abscissa(), "at");
}
bool MetricDescription::is_curve() const {
  return std::holds_alternative<CurveMetric>(what.value()) || std::holds_alternative<ProfileMetric>(what.value());
}

void SettingDescription::declare(Parameters& p) {
  p.add("doc", doc).doc("short explanation");
  p.add("pointers", pointers).required().entries(1).doc("JSON pointers of the values to vary in the scene");
  p.add("values", values)
      .required()
      .doc(
          "levels, in a study of accuracy from the cheapest to the finest; with several pointers, a list of values per "
          "level");
  p.add("labels", labels).doc("names of the levels; default: the values");
  p.add("usual", usual).doc("label of the level used while other settings vary; default: the first");
  p.check(
      [this](const Complain& complain) {
        if (!values.is_array() || values.size() < 2) {
          complain("values", "not a list of two or more", "a list of two or more values, the finest last");
          return;
        }
        if (pointers.size() > 1)
          for (std::size_t i = 0; i < values.size(); ++i)
            if (!values[i].is_array() || values[i].size() != pointers.size())
              complain("values/" + std::to_string(i), plain(values[i]),
                       "a list of " + std::to_string(pointers.size()) + " values, one for each pointer");
        if (!labels.empty() && labels.size() != values.size())
          complain("labels", counted(labels.size(), "label", "labels"), "one per value, or none");
        for (std::size_t i = 0; i < levels(); ++i)
          for (std::size_t k = 0; k < i; ++k)
            if (label(i) == label(k)) complain("values", "the level \"" + label(i) + "\" twice", "different levels");
        if (!usual.empty() && usual_level() == levels()) {
          std::vector<std::string> all;
          for (std::size_t i = 0; i < levels(); ++i) all.push_back(label(i));
          complain("usual", '"' + usual + '"' + did_you_mean(usual, all),
                   fmt::format("one of the labels: {}", fmt::join(all, ", ")));
        }
      },
      {"pointers", "values", "labels", "usual"});
}
std::string SettingDescription::label(std::size_t level) const {
  return level < labels.size() ? labels[level] : plain(values[level]);
}
std::size_t SettingDescription::usual_level() const {
  std::size_t level = 0;
  while (!usual.empty() && level < levels() && label(level) != usual) ++level;
  return level;
}
std::vector<std::string> SettingDescription::sets(std::size_t level) const {
  std::vector<std::string> sets;
  for (std::size_t k = 0; k < pointers.size(); ++k)
    sets.push_back(pointers[k] + '=' + (pointers.size() > 1 ? values[level][k] : values[level]).dump());
  return sets;
}

void SeedsDescription::declare(Parameters& p) {
  p.add("pointer", pointer).doc("JSON pointer of the seed");
  p.add("values", values).entries(1).doc("seeds; each variant is run with each of them");
  p.check(
      [this](const Complain& complain) {
        for (std::size_t i = 0; i < values.size(); ++i)
          if (values[i] != std::floor(values[i]) || values[i] < 0 || values[i] > largest_seed ||
              std::count(values.begin(), values.end(), values[i]) > 1)
            complain("values/" + std::to_string(i), fmt::format("{}", values[i]),
                     fmt::format("different whole numbers from 0 to {}", largest_seed));
      },
      {"values"});
}

namespace {

constexpr int most_runs = 10000;

/// The number of runs, or a few more; it may exceed all integers.
double most_runs_of(const StudyDescription& study) {
  double crossed = 1, alone = 2;
  for (const auto& [name, setting] : study.settings) {
    const auto levels = static_cast<double>(setting.levels());
    crossed *= levels, alone += levels - 1;
  }
  return (study.vary == "crossed" ? crossed : alone) * static_cast<double>(study.seeds.values.size());
}

}  // namespace

void StudyDescription::declare(Parameters& p) {
  p.add("title", title).doc("one line");
  p.add("scene", scene).file().required().doc("description to run");
  p.add("purpose", purpose)
      .one_of({"accuracy", "sweep"})
      .doc(
          "accuracy: numerical settings, whose errors against the finest are compared with their cost; sweep: any "
          "other parameters, metrics against each of them. 'grit advise' uses studies of accuracy only");
  p.add("set", set).doc("values by JSON pointer that override those of the scene in all runs");
  p.add("settings", settings).required().doc("settings to vary, by name");
  p.add("vary", vary)
      .one_of({"one-at-a-time", "crossed"})
      .doc(
          "one-at-a-time: each setting alone, the others at their usual levels, and for accuracy all at their finest; "
          "crossed: all combinations");
  p.add("seeds", seeds).doc("samples; errors below the scatter between samples are not resolved");
  p.add("metrics", metrics).required().doc("results to compare, by name");
  p.add("tolerance", tolerance).above(0).doc("allowed error, as a fraction of the scale, in a study of accuracy");
  p.resolved_before({"extends"});
  p.check(
      [this](const Complain& complain) {
        if (!set.is_object()) complain("set", describe_value(set), "an object of values by JSON pointer");
        if (settings.empty()) complain("settings", "none", "at least one");
        if (metrics.empty()) complain("metrics", "none", "at least one");
      },
      {"set", "settings", "metrics"});
  p.check([this](const Complain& complain) { check_pointers(*this, complain); }, {"settings", "seeds"});
  p.check(
      [this](const Complain& complain) {
        if (const double runs = most_runs_of(*this); runs > most_runs)
          complain("settings", number(runs) + " runs, of all levels and seeds",
                   "at most " + std::to_string(most_runs) +
                       "; take fewer levels or seeds, vary one at a time, or divide the "
                       "study");
      },
      {"settings", "vary", "seeds"});
}

bool StudyDescription::compares_with_finest() const {
  return !is_sweep() &&
         std::ranges::any_of(metrics, [](const auto& metric) { return !metric.second.has_own_reference(); });
}

void refuse_changed_twice(const std::vector<ChangedPointer>& all, std::string_view allowed, const Complain& complain) {
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (covers(all[i].pointer, all[k].pointer) || covers(all[k].pointer, all[i].pointer))
        complain(all[i].where, fmt::format("{}, of which /{} changes {}", all[i].pointer, all[k].where, all[k].pointer),
                 allowed);
}

StudyDescription load_study(const std::filesystem::path& path) {
  StudyDescription study;
  Parameters parameters;
  study.declare(parameters);
  const Document document = Document::load(path);
  refuse_other_kinds(document, path, FileKind::study);
  read(document, parameters);
  return study;
}

}  // namespace grit
