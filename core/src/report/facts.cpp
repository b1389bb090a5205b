#include "report/facts.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "run/recorder.hpp"

namespace grit {
namespace {

std::optional<double> number(const RunResults& run, const std::string& pointer) {
  const Description& found = run.at(pointer);
  return found.is_number() ? std::optional(found.get<double>()) : std::nullopt;
}

/// A count in digits; nothing for what is no count, in a file that grit did not write.
std::string count_text(double value) {
  constexpr double largest = 1e18;
  return value >= 0 && value < largest ? grouped(static_cast<std::uint64_t>(value)) : "";
}

/// Whether run.json contains progress and run time: it is written at the end of each stage.
bool has_ended_a_stage(const RunResults& run) {
  return status_of(run) != "running" || number(run, "/steps").value_or(0) > 0;
}

/// Start of the last stage [s]; stages before it are preparation.
double last_stage_began(const RunResults& run) {
  const Description& stages = run.at("/stages");
  if (!stages.is_array()) return 0;
  // A run that stopped within a stage has not recorded it.
  const std::size_t ended = stages.size(), before = status_of(run) == "done" ? 2 : 1;
  const Description& stage = ended >= before ? stages[ended - before] : Description();
  return stage.is_object() && stage.contains("time") && stage["time"].is_number() ? stage["time"].get<double>() : 0;
}

/// The value of a channel with the largest magnitude in the last stage, over all probes that have it.
std::optional<double> largest(const RunResults& run, const std::string& channel) {
  const double from = last_stage_began(run);
  std::optional<double> found;
  for (const ProbeSeries& probe : run.probes) {
    const auto *series = probe.channel(channel), *time = probe.channel("time");
    if (series == nullptr || series->width() != 1) continue;
    for (std::size_t i = 0; i < series->sampled.values.size(); ++i) {
      const double value = series->sampled.values[i];
      if (time != nullptr && i < time->sampled.values.size() && time->sampled.values[i] < from) continue;
      if (std::isfinite(value) && (!found || std::abs(value) > std::abs(*found))) found = value;
    }
  }
  return found;
}

/// "758", "45 800": the precision of large ratios.
std::string three_digits(double value) {
  constexpr double many = 1e15;
  if (value < 1000 || !(value < many)) return fmt::format("{:.3g}", value);
  const double step = std::pow(10, std::floor(std::log10(value)) - 2);
  return count_text(step * std::round(value / step));
}

bool has_channel(const RunResults& run, const std::string& channel) {
  return std::ranges::any_of(run.probes, [&](const ProbeSeries& probe) { return probe.channel(channel) != nullptr; });
}

/// Closure error of the energy balance; if unknown, why.
std::optional<Fact> closure_fact(const RunResults& run) {
  if (const auto closure = largest(run, "closure_fraction"))
    return Fact{"energy closure", fmt::format("{:.2g} %", 100 * std::abs(*closure)),
                "of the energy converted, in the last stage", std::abs(*closure) > 0.01};
  if (has_channel(run, "closure_fraction"))
    return Fact{"energy closure", "unknown", "not sampled in the last stage", false};
  if (!run.at("/description").is_object() || !has_ended_a_stage(run)) return std::nullopt;
  return Fact{"energy closure", "not measured",
              R"(--set '/probes/energy={"type": "energy", "every_steps": 1000}' adds an energy balance)", false};
}

bool has_engine(const RunResults& run, const std::string& type) {
  return std::ranges::any_of(run.at("/description/engines"), [&](const Description& engine) {
    return engine.is_object() && engine.contains("type") && engine["type"] == type;
  });
}

/// Of all materials that have one.
std::optional<double> least_modulus(const RunResults& run) {
  std::optional<double> least;
  for (const Description& material : run.at("/description/materials"))
    if (material.is_object() && material.contains("contact_modulus") && material["contact_modulus"].is_number())
      least = std::min(least.value_or(INFINITY), material["contact_modulus"].get<double>());
  return least;
}

/// The channels of the summary, then those of the picture: "probe/channel".
std::vector<std::string> curves_asked_for(const RunResults& run) {
  constexpr std::size_t most = 12;
  std::vector<std::string> all;
  for (const char* pointer : {"/description/output/summary", "/description/output/picture/y"})
    if (const Description& names = run.at(pointer); names.is_array())
      for (const Description& name : names)
        if (name.is_string() && all.size() < most && std::ranges::find(all, name.get<std::string>()) == all.end())
          all.push_back(name.get<std::string>());
  return all;
}

/// Finite values of a channel in the last stage, and where they are sampled.
struct LastStage {
  std::vector<double> values, places;
};

LastStage in_last_stage(const RunResults& run, const NamedChannel& curve, const ProbeSeries::Channel& against) {
  LastStage found;
  const std::vector<double>&values = curve.channel->sampled.values,
        &times = curve.probe->channel("time")->sampled.values, &places = against.sampled.values;
  const double from = last_stage_began(run);
  for (std::size_t i = 0; i < std::min({values.size(), times.size(), places.size()}); ++i)
    if (times[i] >= from && std::isfinite(values[i]) && std::isfinite(places[i]))
      found.values.push_back(values[i]), found.places.push_back(places[i]);
  return found;
}

/// A mean and its standard error.
struct Average {
  double mean = 0;
  std::optional<double> error{};
};

/// Over the last tenth, with the error from the means of parts, as consecutive samples are correlated. With few samples
/// the last one.
Average average_at_the_end(const std::vector<double>& values) {
  constexpr std::size_t parts = 5, least_in_part = 4;
  const std::size_t in_part = values.size() / (10 * parts);
  if (in_part < least_in_part) return {values.back()};
  std::array<double, parts> means{};
  for (std::size_t i = 0; i < parts * in_part; ++i)
    means[i / in_part] += values[values.size() - parts * in_part + i] / static_cast<double>(in_part);
  double mean = 0, squares = 0;
  for (const double part : means) mean += part / parts;
  for (const double part : means) squares += (part - mean) * (part - mean);
  return {mean, std::sqrt(squares / (parts * (parts - 1)))};
}

/// "34.1 ± 0.4 kPa", to one digit of the error, or two if it begins with 1.
std::string written(const Average& value, const ReadableUnit& shown) {
  constexpr double many = 1e9;
  const std::string unit = after_number(shown.unit);
  const double mean = shown.factor * value.mean, error = shown.factor * value.error.value_or(0);
  if (!(error > 1e-6 * std::abs(mean))) return fmt::format("{:.4g}{}", mean, unit);
  if (!(std::abs(mean) + error < many)) return fmt::format("{:.4g} ± {:.1g}{}", mean, error, unit);
  const double decade = std::pow(10, std::floor(std::log10(error))), step = error < 2 * decade ? decade / 10 : decade;
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 0.5)));
  return fmt::format("{:.{}f} ± {:.{}f}{}", step * std::round(mean / step), decimals, step * std::round(error / step),
                     decimals, unit);
}

}  // namespace

std::vector<Fact> result_facts(const RunResults& run) {
  std::vector<Fact> facts;
  for (const std::string& name : curves_asked_for(run)) {
    const NamedChannel curve = run.find(name);
    if (!curve.is_scalar()) continue;
    const auto* against = curve.probe->channel("time");
    if (against == nullptr) continue;
    if (const NamedChannel x = run.abscissa_of(curve); x.probe == curve.probe) against = x.channel;
    const LastStage last = in_last_stage(run, curve, *against);
    if (last.values.empty()) continue;
    const auto size = [](double a, double b) { return std::abs(a) < std::abs(b); };
    const auto largest = static_cast<std::size_t>(std::ranges::max_element(last.values, size) - last.values.begin());
    const ReadableUnit shown = readable(curve.channel->sampled.unit, std::abs(last.values[largest])),
                       shown_place = readable(against->sampled.unit, std::abs(last.places[largest]));
    const Average end = average_at_the_end(last.values);
    const std::string place = against->label() + ' ' + written({last.places[largest]}, shown_place);
    facts.push_back({channel_label(curve.probe->name, curve.channel->name), written(end, shown),
                     last.values.size() == 1
                         ? "one sample in the last stage, at " + place
                         : fmt::format("{}; largest {} at {}",
                                       end.error ? "mean of the last tenth of the last stage" : "at the end",
                                       written({last.values[largest]}, shown), place)});
  }
  return facts;
}

std::string status_of(const RunResults& run) {
  const Description& status = run.at("/status");
  return status.is_string() ? status.get<std::string>() : "unknown";
}

std::string where_interrupted(const RunResults& run) {
  if (status_of(run) != "interrupted") return "";
  const Description &stage = run.at("/stage"), &all = run.at("/description/stages"), &ended = run.at("/stages");
  const auto time = number(run, "/time");
  if (!stage.is_string() || !all.is_array() || !ended.is_array() || !time) return "";
  return fmt::format("Interrupted in stage {} ({} of {}), {} after it began.", stage.get<std::string>(),
                     std::min(ended.size() + 1, all.size()), all.size(), written_time(*time - last_stage_began(run)));
}

std::vector<Fact> cost_facts(const RunResults& run) {
  std::vector<Fact> facts;
  if (const auto bodies = number(run, "/bodies")) {
    const auto contacts = number(run, "/contacts_per_body");
    facts.push_back({"bodies", count_text(*bodies), contacts ? fmt::format("{:.2f} contacts each", *contacts) : "",
                     false, count_text(*bodies) + " bodies"});
  }
  const bool has_progress = has_ended_a_stage(run);
  if (const auto time = number(run, "/time"); time && has_progress) {
    const auto steps = number(run, "/steps");
    facts.push_back({"simulated", written_time(*time), steps ? count_text(*steps) + " steps" : "", false,
                     written_time(*time) + " simulated"});
  }
  if (const auto wall = number(run, "/wall_s"); wall && has_progress) {
    const auto threads = number(run, "/threads");
    const double ranks = number(run, "/ranks").value_or(1);
    const auto imbalance = number(run, "/sharing/imbalance");
    facts.push_back({"run time", cost_text(*wall),
                     threads ? fmt::format("{}{:g} thread{}", ranks > 1 ? fmt::format("{:g} ranks of ", ranks) : "",
                                           *threads, *threads == 1 ? "" : "s") +
                                   (imbalance ? fmt::format(", imbalance {:.1f} %", 100 * *imbalance) : "")
                             : "",
                     false, "took " + cost_text(*wall)});
  }
  if (const auto speed = number(run, "/particle_steps_per_s"); speed && has_progress)
    facts.push_back({"speed", fmt::format("{:.3g} M", 1e-6 * *speed), "particle-steps per second", false,
                     fmt::format("{:.3g} million particle-steps/s", 1e-6 * *speed)});
  return facts;
}

std::vector<Fact> trust_facts(const RunResults& run, double mean_diameter) {
  std::vector<Fact> facts;
  if (const auto dt = number(run, "/time_step_s"); dt && has_ended_a_stage(run)) {
    const auto critical = number(run, "/critical_time_step_s");
    const double ratio = critical && *critical > 0 ? *dt / *critical : 0;
    facts.push_back({"time step", written_time(*dt),
                     ratio > 0 ? fmt::format("{:.2g} of the critical time step", ratio) : "", ratio > 1});
  }
  if (auto closure = closure_fact(run)) facts.push_back(std::move(*closure));
  const bool flows = has_engine(run, "gravity");
  const auto void_ratio = largest(run, "void_ratio");
  const bool is_specimen = !void_ratio || *void_ratio < most_void_ratio;  // else stresses are those of empty space
  if (const auto inertial = largest(run, "inertial_number"); inertial && *inertial > 0 && is_specimen)
    facts.push_back({"inertial number", fmt::format("{:.3g}", *inertial),
                     "largest of the last stage; quasi-static below 0.001", *inertial > 1e-3 * 1.005 && !flows});
  const auto modulus = least_modulus(run);
  const auto stress = largest(run, "mean_stress");
  if (is_specimen && modulus && stress && *stress > 0 && std::isfinite(*modulus / *stress))
    facts.push_back({"stiffness level", three_digits(*modulus / *stress),
                     "contact modulus over the largest mean stress of the last stage", false});
  if (const auto overlap = largest(run, "largest_overlap"); overlap && mean_diameter > 0)
    facts.push_back({"largest overlap", fmt::format("{:.2g} %", 100 * *overlap / mean_diameter),
                     "of the mean diameter, in the last stage", *overlap > 0.05 * mean_diameter});
  return facts;
}

}  // namespace grit
