#include "calibration/description.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "input/file_kind.hpp"
#include "input/reader.hpp"
#include "study/number_with_unit.hpp"

namespace grit {
namespace {

constexpr std::int64_t most_samples = 1000, most_trials = 10000;

/// A value of a range, as in a description.
std::optional<NumberWithUnit> quantity_of(const Description& value) {
  if (value.is_number()) return NumberWithUnit{value.get<double>(), ""};
  if (value.is_string()) return number_with_unit(value.get<std::string>());
  return std::nullopt;
}

void check_range(const ParameterDescription& parameter, const Complain& complain) {
  const Description& range = parameter.range;
  if (!range.is_array() || range.size() != 2) {
    complain("range", describe_value(range), "a list of two values, the lowest and the highest");
    return;
  }
  const auto low = quantity_of(range[0]), high = quantity_of(range[1]);
  for (std::size_t i = 0; i < 2; ++i)
    if (const auto& end = i == 0 ? low : high; !end || !(std::abs(end->number) <= most_magnitude))
      complain(fmt::format("range/{}", i), describe_value(range[i]),
               fmt::format("a number of at most {:g}, or a text with such a number and a unit", most_magnitude));
  if (!low || !high || std::max(std::abs(low->number), std::abs(high->number)) > most_magnitude) return;
  if (low->unit != high->unit)
    complain("range/1", describe_value(range[1]), "a value in the unit of the first, \"" + low->unit + '"');
  else if (!(low->number < high->number))
    complain("range", range.dump() + ", which is empty", "two values of which the second is larger");
  else if (parameter.is_logarithmic() && !(low->number > 0))
    complain("range/0", describe_value(range[0]), "a value above 0 with the scale \"log\"");
  else if (parameter.value(0.4) == parameter.value(0.6))
    complain("range", range.dump(), "a range wider than the six digits to which values are rounded");
  else if (!parameter.start.is_null()) {
    const auto start = quantity_of(parameter.start);
    if (!start || start->unit != low->unit || start->number < low->number || start->number > high->number)
      complain("start", describe_value(parameter.start),
               fmt::format("a value from {} to {}, in the same unit", range[0].dump(), range[1].dump()));
  }
}

void check_pointers(const CalibrationDescription& calibration, const Complain& complain) {
  std::vector<ChangedPointer> changed;
  for (const auto& [name, parameter] : calibration.parameters)
    for (std::size_t i = 0; i < parameter.pointers.size(); ++i)
      changed.push_back({parameter.pointers[i], fmt::format("parameters/{}/pointers/{}", name, i)});
  changed.push_back({calibration.samples.pointer, "samples/pointer"});
  refuse_changed_twice(changed, "a value that no other parameter and no seed changes", complain);
  for (const auto& [pointer, value] : calibration.set.items())
    for (const ChangedPointer& one : changed)
      if ((pointer + '/').starts_with(one.pointer + '/'))
        complain("set/" + pointer_token(pointer), fmt::format("a value that /{} changes", one.where),
                 "a value that no parameter and no seed changes");
}

}  // namespace

void ParameterDescription::declare(Parameters& p) {
  p.add("doc", doc).doc("short explanation");
  p.add("pointers", pointers).required().entries(1).doc("JSON pointers of the values in the base that get the value");
  p.add("range", range).required().doc("lowest and highest value, with units as in the base");
  p.add("start", start).doc("value of the first trial; default: the middle of the range");
  p.add("scale", scale)
      .one_of({"linear", "log"})
      .doc("log: the search, errors and the middle of the range are in the logarithm of the value");
  p.check([this](const Complain& complain) { check_range(*this, complain); }, {"range", "start", "scale"});
}

std::string ParameterDescription::unit() const { return quantity_of(range[0]).value().unit; }
double ParameterDescription::low() const { return quantity_of(range[0]).value().number; }
double ParameterDescription::high() const { return quantity_of(range[1]).value().number; }
double ParameterDescription::logarithmic_length() const { return std::log(high()) - std::log(low()); }
double ParameterDescription::first_value() const {
  return start.is_null() ? value(0.5) : quantity_of(start).value().number;
}

double ParameterDescription::value(double place) const {
  const double exact =
      is_logarithmic() ? low() * std::exp(place * logarithmic_length()) : low() + place * (high() - low());
  const std::string digits = fmt::format("{:.6g}", exact);
  double rounded = exact;
  std::from_chars(digits.data(), digits.data() + digits.size(), rounded);
  return std::clamp(rounded, low(), high());
}
double ParameterDescription::place(double value) const {
  return is_logarithmic() ? (std::log(value) - std::log(low())) / logarithmic_length()
                          : (value - low()) / (high() - low());
}
double ParameterDescription::error_of_value(double value, double error_of_place) const {
  return error_of_place * (is_logarithmic() ? value * logarithmic_length() : high() - low());
}
Description ParameterDescription::written(double value) const {
  const std::string in = unit();
  return in.empty() ? Description(value) : Description(fmt::format("{} {}", value, in));
}

void TargetDescription::declare(Parameters& p) {
  metric.declare_channels(p);
  p.add("value", value).doc("target value: a number in the unit of its channel, or a text with a unit");
  p.add("curve", metric.curve).doc("target curve, for the types curve and profile");
  p.add("tolerance", tolerance)
      .required()
      .doc("difference that is accepted, such as the scatter of the laboratory: a number or text, as the value");
  p.check([this](const Complain& complain) {
    const char* const key = metric.is_curve() ? "curve" : "value";
    if (metric.is_curve() ? !metric.curve : value.is_null())
      complain(key, "none", metric.is_curve() ? "a target curve" : "a target value");
    if (metric.is_curve() ? !value.is_null() : metric.curve.has_value())
      complain(metric.is_curve() ? "value" : "curve", "one with the type " + metric.what.type(),
               std::string("a ") + key + " only");
  });
}

void SamplesDescription::declare(Parameters& p) {
  p.add("pointer", pointer).doc("JSON pointer of the seed");
  p.add("count", count)
      .at_least(1)
      .at_most(most_samples)
      .doc(
          "runs of each trial, with the seeds 1, 2, …: the same in all trials, so that their differences scatter less");
}

void OptimizerDescription::declare(Parameters& p) {
  p.add("algorithm", algorithm)
      .one_of({"bobyqa", "cobyla", "crs"})
      .doc(
          "of NLopt. bobyqa: local, by quadratic models; cobyla: local, by linear models, for a rougher misfit; crs: "
          "global, by a random population, for many more trials");
  p.add("trials", trials).at_least(1).at_most(most_trials).doc("most trials of the search");
  p.add("resolution", resolution)
      .above(0)
      .at_most(0.5)
      .doc("the search ends when its steps are smaller than this fraction of the ranges");
  p.add("runs_at_once", runs_at_once).at_least(0).at_most(1024).doc("concurrent runs; 0: as many as cores");
}

void CalibrationDescription::declare(Parameters& p) {
  p.add("title", title).doc("one line");
  p.add("base", base).file().required().doc("description to run");
  p.add("set", set).doc("values by JSON pointer that override those of the base in all runs");
  p.add("parameters", parameters).required().doc("parameters to find, by name");
  p.add("targets", targets).required().doc("what the runs are to meet, by name");
  p.add("samples", samples).doc("runs of each trial; their scatter is part of the uncertainty");
  p.add("optimizer", optimizer).doc("the search");
  p.resolved_before({"extends"});
  p.check(
      [this](const Complain& complain) {
        if (!set.is_object()) complain("set", describe_value(set), "an object of values by JSON pointer");
        else
          for (const auto& [pointer, value] : set.items())
            if (value.is_null() || value.is_object())  // as parts of a description that extends the base they differ
              complain("set/" + pointer_token(pointer), describe_value(value),
                       "a number, text, flag or list; change the rest in a description that the base extends");
        if (parameters.empty()) complain("parameters", "none", "at least one");
        if (targets.empty()) complain("targets", "none", "at least one");
      },
      {"set", "parameters", "targets"});
  p.check([this](const Complain& complain) { check_pointers(*this, complain); }, {"set", "parameters", "samples"});
}

std::map<std::string, MetricDescription> CalibrationDescription::metrics() const {
  std::map<std::string, MetricDescription> all;
  for (const auto& [name, target] : targets) all.emplace(name, target.metric);
  return all;
}

std::vector<std::string> CalibrationDescription::names() const {
  std::vector<std::string> all;
  for (const auto& [name, parameter] : parameters) all.push_back(name);
  return all;
}

CalibrationDescription load_calibration(const std::filesystem::path& path) {
  CalibrationDescription calibration;
  Parameters parameters;
  calibration.declare(parameters);
  const Document document = Document::load(path);
  refuse_other_kinds(document, path, FileKind::calibration);
  read(document, parameters);
  return calibration;
}

std::vector<std::string> sets_of(const CalibrationDescription& calibration, const std::vector<double>& values) {
  std::vector<std::string> sets;
  for (const auto& [pointer, value] : calibration.set.items()) sets.push_back(pointer + '=' + value.dump());
  std::size_t k = 0;
  for (const auto& [name, parameter] : calibration.parameters) {
    const std::string value = parameter.written(values[k++]).dump();
    for (const std::string& pointer : parameter.pointers) sets.push_back(pointer + '=' + value);
  }
  return sets;
}

}  // namespace grit
