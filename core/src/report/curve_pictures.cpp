#include "report/curve_pictures.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "format/duration.hpp"
#include "format/number.hpp"
#include "format/symbols.hpp"
#include "output/picture.hpp"
#include "output/scale.hpp"
#include "report/facts.hpp"
#include "report/references.hpp"

namespace grit {
namespace {

/// "probe/channel" of each.
std::vector<std::string> curves_wanted(const RunResults& run) {
  std::vector<std::string> names;
  for (const Description& name : run.at("/description/output/picture/y"))
    if (name.is_string()) names.push_back(name.get<std::string>());
  if (!names.empty() || run.probes.empty()) return names;
  const ProbeSeries& probe = run.probes.front();  // "test" where there is one
  for (const auto& channel : probe.channels)
    if (const std::string name = probe.name + '/' + channel.name;
        channel.width() == 1 && channel.name != "time" && (!channel.zero_throughout() || run.asks_for(name)))
      names.push_back(name);
  return names;
}

/// The points at which both were sampled.
Curve curve_of(const std::string& name, const NamedChannel& x, const NamedChannel& y) {
  const auto *x_time = x.probe->channel("time"), *y_time = y.probe->channel("time");
  Curve curve{.name = name, .x = {}, .y = {}};
  if (!x_time || !y_time) return curve;
  const auto &s = x_time->sampled.values, &t = y_time->sampled.values;
  for (std::size_t i = 0, j = 0; i < std::min(s.size(), x.channel->sampled.values.size()) &&
                                 j < std::min(t.size(), y.channel->sampled.values.size());) {
    if (s[i] == t[j]) {
      curve.x.push_back(x.channel->sampled.values[i++]);
      curve.y.push_back(y.channel->sampled.values[j++]);
    } else {
      s[i] < t[j] ? ++i : ++j;
    }
  }
  return curve;
}

std::string facts_line(std::span<const RunResults> runs) {
  std::vector<std::string> parts;
  if (runs.size() == 1) {
    parts.push_back(status_of(runs[0]));
    for (const Fact& fact : cost_facts(runs[0])) parts.push_back(fact.in_line);
  } else {
    for (const RunResults& run : runs) parts.push_back(run.name + ": " + status_of(run));
  }
  return fmt::format("{}", fmt::join(parts, "  ·  "));
}

/// The curve of a reference in a panel: a value extends over its whole width.
Curve drawn(const Reference& reference, const Panel& panel) {
  Curve curve{.name = reference.name, .x = reference.x, .y = reference.y, .reference = true};
  if (!reference.value) return curve;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Curve& one : panel.curves)
    for (const double x : one.x)
      if (drawable(x)) low = std::min(low, x), high = std::max(high, x);
  if (low <= high) curve.x = {low, high}, curve.y = {*reference.value, *reference.value};
  return curve;
}

/// A panel of the channel, with the curves of all runs over the same abscissa; empty if there is no point.
std::optional<Panel> panel_of(const std::string& wanted, std::span<const RunResults> runs,
                              const std::vector<std::vector<Reference>>& references) {
  std::optional<Panel> panel;
  NamedChannel x;
  for (const RunResults& run : runs) {
    const NamedChannel y = run.find(wanted);
    if (!y.is_scalar()) continue;
    const NamedChannel own = run.abscissa_of(y);
    if (!own.channel) continue;
    if (!panel) {
      x = own;
      panel = Panel{{channel_label(x.probe->name, x.channel->name), x.channel->sampled.unit},
                    {channel_label(y.probe->name, y.channel->name), y.channel->sampled.unit},
                    {}};
    }
    const bool alike = own.channel->name == x.channel->name && own.channel->sampled.unit == panel->x.unit &&
                       y.channel->sampled.unit == panel->y.unit;
    if (alike) panel->curves.push_back(curve_of(runs.size() > 1 ? run.name : "", own, y));
  }
  const auto has_a_point = [](const Curve& curve) {
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (drawable(curve.x[i]) && drawable(curve.y[i])) return true;
    return false;
  };
  if (!panel || std::ranges::none_of(panel->curves, has_a_point)) return std::nullopt;
  std::vector<Curve> drawn_references;
  for (const auto& of_run : references)
    for (const Reference& reference : of_run) {
      const bool over_time = reference.against.empty() && x.channel->name == "time";
      if (reference.of != wanted || (!reference.value && !over_time && !x.is(reference.against))) continue;
      Curve curve = drawn(reference, *panel);
      const auto same = [&](const Curve& one) {
        return one.name == curve.name && one.x == curve.x && one.y == curve.y;
      };
      if (std::ranges::none_of(drawn_references, same)) drawn_references.push_back(std::move(curve));
    }
  std::ranges::move(drawn_references, std::back_inserter(panel->curves));
  return panel;
}

/// Whether a channel is a list over a coordinate in one of these units.
bool is_list_over(const std::vector<std::string>& units, const ProbeSeries& probe,
                  const ProbeSeries::Channel& channel) {
  const auto* place = channel.sampled.coordinate.empty() ? nullptr : probe.channel(channel.sampled.coordinate);
  return place && place->width() == channel.width() && place->sampled.samples == channel.sampled.samples &&
         channel.sampled.samples > 0 && std::ranges::find(units, place->sampled.unit) != units.end();
}

std::vector<double> row(const SampledChannel& list, std::size_t sample) {
  const std::size_t width = list.values.size() / list.samples;
  const auto first = list.values.begin() + static_cast<std::ptrdiff_t>(sample * width);
  return {first, first + static_cast<std::ptrdiff_t>(width)};
}

/// The value at an instant of the abscissa in the description's picture: ": settlement 3.2 mm"; empty for time.
std::string abscissa_at(const RunResults& run, double instant) {
  const Description& wanted = run.at("/description/output/picture/x");
  if (!wanted.is_string()) return "";
  const NamedChannel x = run.find(wanted.get<std::string>());
  const auto* time = x.is_scalar() && x.channel->name != "time" ? x.probe->channel("time") : nullptr;
  if (!time) return "";
  const auto &times = time->sampled.values, &values = x.channel->sampled.values;
  const auto after = static_cast<std::size_t>(std::ranges::upper_bound(times, instant) - times.begin());
  if (after == 0 || after > values.size() || !drawable(values[after - 1])) return "";
  double largest = 0;
  for (const double value : values)
    if (drawable(value)) largest = std::max(largest, std::abs(value));
  const auto [factor, unit] = readable(x.channel->sampled.unit, largest);
  const std::string number = short_number(values[after - 1] * factor);
  return ": " + spelled(x.channel->name) + ' ' + number + after_number(unit);
}

/// A picture per probe, with a panel for each of its lists over such units.
std::vector<NamedPicture> list_pictures(const RunResults& run, const std::string& what,
                                        const std::vector<std::string>& units, bool polar) {
  std::vector<NamedPicture> pictures;
  for (const ProbeSeries& probe : run.probes) {
    const auto* time = probe.channel("time");
    if (!time) continue;
    Picture picture{run.title(), what + " of " + probe.name, {}, {}};
    for (const auto& channel : probe.channels) {
      if (!is_list_over(units, probe, channel) || channel.zero_throughout()) continue;
      const auto& place = *probe.channel(channel.sampled.coordinate);
      Panel panel{{place.label(), place.sampled.unit}, {spelled(channel.name), channel.sampled.unit}, {}, false, polar};
      const std::size_t last = std::min(channel.sampled.samples, time->sampled.values.size());
      std::size_t drawn = last;
      for (const std::size_t sample : {(last - 1) / 3, 2 * (last - 1) / 3, last - 1}) {
        if (last == 0 || sample == drawn) continue;
        drawn = sample;
        panel.curves.push_back(
            {.name = written_time(time->sampled.values[sample]) + abscissa_at(run, time->sampled.values[sample]),
             .x = row(place.sampled, sample),
             .y = row(channel.sampled, sample)});
      }
      picture.panels.push_back(std::move(panel));
    }
    if (!picture.panels.empty()) pictures.push_back({what + '-' + probe.name, draw(picture)});
  }
  return pictures;
}

}  // namespace

std::optional<std::string> curves_picture(std::span<RunResults> runs) {
  if (runs.empty()) return std::nullopt;
  std::vector<std::string> wanted;
  std::vector<std::vector<Reference>> references;
  for (RunResults& run : runs) {
    for (std::string& name : curves_wanted(run))
      if (std::ranges::find(wanted, name) == wanted.end()) wanted.push_back(std::move(name));
    references.push_back(references_of(run));
    if (runs.size() == 1) continue;
    // Other runs may have another reference of that name.
    for (Reference& reference : references.back())
      for (const auto& before : references)
        for (const Reference& other : before)
          if (&before != &references.back() && other.name == reference.name && other.of == reference.of &&
              (other.value != reference.value || other.x != reference.x || other.y != reference.y))
            reference.name = run.name + ", " + reference.name;
  }
  Picture picture{runs.size() == 1 ? runs[0].title() : "Runs side by side", facts_line(runs), {}, {}};
  for (const std::string& name : wanted)
    if (auto panel = panel_of(name, runs, references)) picture.panels.push_back(std::move(*panel));
  if (picture.panels.empty()) return std::nullopt;
  return draw(picture);
}

std::vector<NamedPicture> profile_pictures(const RunResults& run) {
  return list_pictures(run, "profiles", {"m"}, false);
}

std::vector<NamedPicture> direction_pictures(const RunResults& run) {
  return list_pictures(run, "directions", {"rad", "degree"}, true);
}

}  // namespace grit
