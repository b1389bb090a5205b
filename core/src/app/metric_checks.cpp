#include "app/metric_checks.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iterator>
#include <ranges>
#include <set>
#include <utility>
#include <vector>

#include "app/run_setup.hpp"
#include "description/placed_error.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "kernel/kernel.hpp"
#include "output/reference_curve.hpp"
#include "run/observer.hpp"
#include "simulation/prepared_sample.hpp"

namespace grit {
namespace {

std::string pointer_of(const MetricsToCheck& of, const std::string& metric, const std::string& key) {
  return of.section + '/' + pointer_token(metric) + '/' + key;
}

/// `; did you mean "color"? Allowed is one of color, view`
std::string one_of(const std::string& found, const std::vector<std::string>& names) {
  return did_you_mean(found, names, fmt::format("allowed is one of {}", fmt::join(names, ", ")));
}

}  // namespace

void check_curves(const MetricsToCheck& of) {
  std::vector<Problem> problems;
  for (const auto& [name, metric] : *of.metrics)
    if (metric.curve) try {
        read_reference(*metric.curve);
      } catch (const FileError& error) {
        problems.push_back(
            of.written->problem(pointer_of(of, name, "curve/file"), missing_file_text(error, metric.curve->file)));
      }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
}

void check_probes(const MetricsToCheck& of, const SceneDescription& scene) {
  std::vector<Problem> problems;
  const auto probes = std::views::keys(scene.probes);
  for (const auto& [name, metric] : *of.metrics)
    for (const auto& [key, channel] : {std::pair("of", &metric.of), std::pair("against", &metric.against)}) {
      const std::string probe = channel->substr(0, channel->find('/'));
      if (probe.empty() || scene.probes.contains(probe)) continue;
      problems.push_back(of.written->problem(pointer_of(of, name, key),
                                             fmt::format("found the probe \"{}\", which is not in the scene", probe) +
                                                 one_of(probe, {probes.begin(), probes.end()})));
    }
  if (!problems.empty()) throw DescriptionError(std::move(problems));
}

std::map<std::string, std::string> check_channels(const MetricsToCheck& of, const LiveScene& live,
                                                  const Registry& registry) try {
  const SceneDescription& scene = live.now();
  const Components& components = live.components();
  const Kernel kernel(scene, components, prepare(live, registry, run_state(scene, components)), 1);
  std::map<std::string, std::string> units;
  std::set<std::string> wide;  // several values per sample
  for (const auto& [name, probe] : scene.probes) {
    units[name + "/time"] = "s", units[name + "/step"] = "1";
    for (const Channel& channel : Observer(name, probe, components.probes.at(name), kernel.world()).group().channels) {
      units[name + '/' + channel.name] = channel.unit;
      if (std::ranges::any_of(channel.shape, [](std::size_t n) { return n != 1; }))
        wide.insert(name + '/' + channel.name);
    }
  }
  std::vector<Problem> problems;
  for (const auto& [name, metric] : *of.metrics) {
    const bool profile = std::holds_alternative<ProfileMetric>(metric.what.value());
    for (const auto& [key, channel] : {std::pair("of", metric.of), std::pair("against", metric.against)}) {
      if (channel.empty()) continue;
      const std::string probe = channel.substr(0, channel.find('/') + 1);
      std::vector<std::string> own;
      std::ranges::copy_if(std::views::keys(units), std::back_inserter(own),
                           [&](const auto& one) { return one.starts_with(probe); });
      if (std::ranges::find(own, channel) == own.end())
        problems.push_back(of.written->problem(
            pointer_of(of, name, key),
            fmt::format("found \"{}\", which is not a channel of the probe", channel) + one_of(channel, own)));
      else if (!profile && wide.contains(channel))
        problems.push_back(of.written->problem(
            pointer_of(of, name, key),
            fmt::format("found \"{}\", which has several values per sample; allowed is a channel with "
                        "one value, or the type profile",
                        channel)));
    }
  }
  for (const auto& [name, metric] : *of.metrics)
    MetricDescription(metric).find_numbers(
        units, [&](std::string_view key, std::string_view found, std::string_view allowed) {
          problems.push_back(of.written->problem(pointer_of(of, name, std::string(key)),
                                                 fault_text(std::string(found), std::string(allowed))));
        });
  if (!problems.empty()) throw DescriptionError(std::move(problems));
  return units;
} catch (const NumericsError&) {
  return {};
}

}  // namespace grit
