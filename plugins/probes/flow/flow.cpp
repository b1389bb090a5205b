// Sums over World::departures(). See README.md.
#include "flow.hpp"

#include <algorithm>

#include "../grain_masses.hpp"
#include "../wall_names.hpp"
#include "grit/plugin.hpp"

namespace grit {

void FlowProbe::Outlet::declare(Parameters& parameters) {
  parameters.add("low", low).unit("m").required().doc("where it begins, along the axis");
  parameters.add("high", high).unit("m").required().doc("where it ends");
  parameters.check(
      [this](const Complain& complain) {
        if (!(low < high)) complain("high", std::to_string(high) + " m", "above low");
      },
      {"low", "high"});
}

void FlowProbe::declare(Parameters& parameters) {
  parameters.add("axis", axis).one_of({"x", "y", "z"}).doc("along which outlets lie");
  parameters.add("outlets", outlets)
      .doc(
          "ranges along the axis by name (snake_case), with channels of their own; what leaves elsewhere counts in the "
          "sums alone");
  parameters.add("window", window).unit("s").above(0).doc("rates are means over so much time before the sample");
  parameters.check(
      [this](const Complain& complain) {
        for (const auto& [name, outlet] : outlets) {
          if (!is_snake_case(name))
            complain("outlets", "the name \"" + name + "\"", "small letters, digits and _, a letter first");
          for (const auto& [other, range] : outlets)
            if (name < other && outlet.low < range.high && range.low < outlet.high)
              complain("outlets", "\"" + name + "\" and \"" + other + "\", which overlap",
                       "ranges that have at most an end in common");
        }
      },
      {"outlets"});
}

std::vector<Channel> FlowProbe::channels() const {
  std::vector<Channel> channels{
      {"mass", "kg", "that has left since the start of the run", {}},
      {"bodies", "1", "number of spheres and clumps that have left", {}},
      {"mass_left", "kg", "of the bodies that are still there", {}},
      {"rate", "kg s-1", "mass that left in the window before the sample, over its time", {}}};
  for (const auto& [name, outlet] : outlets) {
    channels.push_back({name + "_mass", "kg", "that has left through this outlet", {}});
    channels.push_back({name + "_rate", "kg s-1", "through this outlet, as rate", {}});
  }
  return channels;
}

void FlowProbe::sample(const World& world, std::span<const std::span<double>> values) {
  for (const auto& value : values) value.front() = 0;
  // What left at the very beginning of a window counts in the one before.
  const double since = world.time() - window, over = std::min(window, world.time());
  const auto k = static_cast<int>(axis.front() - 'x');
  for (const Departure& gone : world.departures()) {
    const double recent = gone.time > since && over > 0 ? gone.mass / over : 0;
    values[0].front() += gone.mass, values[1].front() += 1, values[3].front() += recent;
    std::size_t channel = 4;
    for (const auto& [name, outlet] : outlets) {
      if (gone.position[k] >= outlet.low && gone.position[k] < outlet.high)
        values[channel].front() += gone.mass, values[channel + 1].front() += recent;
      channel += 2;
    }
  }
  values[2].front() = mass_of(world);
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "flow",
                                     .version = "1.0.0",
                                     .doc = "mass, number and rate of bodies that leave through open sides, by outlet",
                                     .make_probe = []() -> grit::Probe* { return new grit::FlowProbe; }};
  return &info;
}
