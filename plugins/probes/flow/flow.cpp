#include "flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "grit/plugin.hpp"
#include "grit/toolkit/cell_contents.hpp"
#include "grit/toolkit/grain_masses.hpp"
#include "grit/toolkit/specimen.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

namespace {

std::string mass_channel(const std::string& outlet) { return outlet + "_discharged_mass"; }
std::string rate_channel(const std::string& outlet) { return outlet + "_discharge_rate"; }

}  // namespace

void FlowProbe::Outlet::declare(Parameters& parameters) {
  parameters.add("low", low).unit("m").required().doc("lower end of the range along the axis");
  parameters.add("high", high).unit("m").required().doc("upper end of the range along the axis");
  parameters.check(
      [this](const Complain& complain) {
        if (!(low < high)) complain("high", std::to_string(high) + " m", "above low");
      },
      {"low", "high"});
}

void FlowPattern::declare(Parameters& parameters) {
  Averaging::declare(parameters, "of the specimen");
  parameters.add("wall_zone", wall_zone).above(0).doc("width of the zones next to the walls, over the mean diameter");
  parameters.add("moving_fraction", moving_fraction)
      .above(0)
      .below(1)
      .doc("fraction of the mean speed of a slice above which a zone next to a wall counts as moving");
}

void FlowProbe::declare(Parameters& parameters) {
  parameters.add("axis", axis).one_of({"x", "y", "z"}).doc("axis along which the outlets lie");
  parameters.add("outlets", outlets)
      .doc(
          "ranges along the axis by name (snake_case), each with its own channels; discharge elsewhere counts in the "
          "totals only");
  parameters.add("window", window).unit("s").above(0).doc("time before a sample over which rates are averaged");
  parameters.add("pattern", pattern)
      .doc("flow pattern in the silo: profile along the height, type of flow, map of velocities; default: none");
  parameters.check(
      [this](const Complain& complain) {
        for (const auto& [name, outlet] : outlets) {
          if (!is_snake_case(name))
            complain("outlets", "the name \"" + name + "\"",
                     "lower-case letters, digits and _, starting with a letter");
          for (const auto& [other, range] : outlets)
            if (name < other && outlet.low < range.high && range.low < outlet.high)
              complain("outlets", "\"" + name + "\" and \"" + other + "\", which overlap",
                       "ranges that share at most an end");
        }
      },
      {"outlets"});
  parameters.check(
      [this](const Complain& complain) {
        if (pattern && pattern->along == axis)
          complain("pattern", "a profile along " + axis + ", where outlets lie", "another `along`, the height");
      },
      {"pattern", "axis"});
}

std::vector<Channel> FlowProbe::channels() const {
  std::vector<Channel> channels{
      {"discharged_mass", "kg", "mass discharged since the start of the run", {}},
      {"discharged_bodies", "1", "number of spheres and clumps discharged", {}},
      {"remaining_mass", "kg", "mass of the bodies in the domain", {}},
      {"discharge_rate", "kg s-1", "mass discharged in the window before the sample, over its length", {}}};
  for (const auto& [name, outlet] : outlets) {
    channels.push_back(
        {mass_channel(name), "kg", "mass discharged through this outlet since the start of the run", {}});
    channels.push_back({rate_channel(name), "kg s-1", "discharge rate through this outlet", {}});
  }
  if (pattern) {
    const auto slices = static_cast<std::size_t>(pattern->slices);
    channels.push_back(pattern->position_channel());
    channels.push_back(
        {"speed", "m s-1", "mean speed downwards of each slice; NaN without bodies", {slices}, "position"});
    channels.push_back(
        {"wall_speed_ratio",
         "1",
         "lower mean speed of the two zones next to the walls over that of the slice; NaN without bodies in "
         "both zones, or if the slice does not sink",
         {slices},
         "position"});
    channels.push_back(
        {"transition_height",
         "m",
         "height above which the zones next to the walls move: effective transition; NaN without flow, or "
         "if the uppermost slice does not move at the walls",
         {}});
    channels.push_back(
        {"flow_type",
         "1",
         "type of flow of EN 1991-4: 0 no discharge in the window, 1 pipe flow, 2 mixed flow, 3 mass flow",
         {}});
  }
  return channels;
}

void FlowProbe::sample(const World& world, ChannelValues& values) {
  double mass = 0, bodies = 0, rate = 0;
  struct Through {
    double &mass, &rate;
  };
  std::vector<Through> through;  // each outlet
  for (const auto& outlet : outlets) {
    through.push_back({values[mass_channel(outlet.first)], values[rate_channel(outlet.first)]});
    through.back().mass = through.back().rate = 0;
  }
  // What left at the very beginning of a window counts in the one before.
  const double since = world.time() - window, over = std::min(window, world.time());
  const auto k = static_cast<int>(axis.front() - 'x');
  for (const Departure& gone : world.departures()) {
    const double recent = gone.time > since && over > 0 ? gone.mass / over : 0;
    mass += gone.mass, ++bodies, rate += recent;
    auto own = through.begin();
    for (const auto& [name, outlet] : outlets) {
      if (gone.position[k] >= outlet.low && gone.position[k] < outlet.high) own->mass += gone.mass, own->rate += recent;
      ++own;
    }
  }
  values["discharged_mass"] = mass;
  values["discharged_bodies"] = bodies;
  values["remaining_mass"] = mass_of(world);
  values["discharge_rate"] = rate;
  if (pattern) sample_pattern(world, rate > 0, values);
}

void FlowProbe::sample_pattern(const World& world, bool flows, ChannelValues& values) const {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const Region box = pattern->region(specimen_box(world));
  const int up = pattern->along[0] - 'x', side = axis[0] - 'x';
  const double low = box.low[up], height = box.high[up] - low, rim = pattern->wall_zone * world.mean_diameter();
  struct Sum {
    double volume = 0, sunk = 0;  // m³, m⁴/s
    double speed() const { return sunk / volume; }
  };
  struct Slice {
    Sum all;
    std::array<Sum, 2> walls;
  };
  std::vector<Slice> slices(static_cast<std::size_t>(pattern->slices));
  const auto shares = world.volume_fractions();
  for (std::size_t i = 0; i < world.positions().size(); ++i) {
    const Vec3 centre = xyz(world.positions()[i]);
    const double part = (centre[up] - low) / height;
    if (!centre.allFinite() || !(part >= 0 && part < 1)) continue;
    Slice& slice = slices[static_cast<std::size_t>(part * static_cast<double>(slices.size()))];
    const double radius = world.positions()[i].w, volume = radius * radius * radius * (shares.empty() ? 1 : shares[i]),
                 sunk = -volume * xyz(world.velocities()[i])[up];
    const auto count = [&](Sum& sum) { sum.volume += volume, sum.sunk += sunk; };
    count(slice.all);
    if (centre[side] < box.low[side] + rim) count(slice.walls[0]);
    if (centre[side] > box.high[side] - rim) count(slice.walls[1]);
  }
  pattern->fill_places(box, values);
  const auto speed = values.list("speed");
  const auto wall_speed = values.list("wall_speed_ratio");
  double transition = unknown;
  bool all_the_way = flows;
  for (std::size_t s = slices.size(); s-- > 0;) {
    const auto& [all, walls] = slices[s];
    const bool tells = walls[0].volume > 0 && walls[1].volume > 0;
    speed[s] = all.volume > 0 ? all.speed() : unknown;
    wall_speed[s] = tells && all.sunk > 0 ? std::min(walls[0].speed(), walls[1].speed()) / all.speed() : unknown;
    if (!tells) continue;  // above the surface
    all_the_way = all_the_way && wall_speed[s] > pattern->moving_fraction;
    if (all_the_way) transition = low + height * static_cast<double>(s) / static_cast<double>(slices.size());
  }
  values["transition_height"] = transition;
  values["flow_type"] = !flows ? 0 : std::isnan(transition) ? 1 : !all_the_way ? 2 : 3;
}

void FlowProbe::check_fields(const World& world) const {
  if (pattern) pattern->check_cells(world, pattern->region(specimen_box(world)), "pattern/cell_step");
}

std::vector<Field> FlowProbe::fields(const World& world) {
  if (!pattern) return {};
  const Region box = pattern->region(specimen_box(world));
  const AveragingCells cells = pattern->cells(world, box);
  struct Sums {
    double volume = 0;
    Vec3 flux = Vec3::Zero();
    Sums& operator+=(const Sums& other) { return volume += other.volume, flux += other.flux, *this; }
  };
  std::vector<Sums> parts(cells.parts());
  share_out_solids(world, cells, [&](std::size_t part, double volume, std::size_t body) {
    parts[part].volume += volume, parts[part].flux += volume * xyz(world.velocities()[body]);
  });
  std::vector<Field> fields = map_of(cells);
  fields.push_back({"velocity",
                    "m s-1",
                    "mean velocity of the grains in the cell, by volume; NaN without any",
                    3,
                    {},
                    {"x", "y", "z"}});
  for (const Sums& sums : cells.sum_up(parts)) {
    const Vec3 velocity = sums.flux / sums.volume;  // 0 / 0 without any
    fields.back().values.insert(fields.back().values.end(), velocity.begin(), velocity.end());
  }
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "flow",
                                     .version = "1.0.0",
                                     .doc = "discharge through open sides, by outlet, and the flow pattern",
                                     .make_probe = []() -> grit::Probe* { return new grit::FlowProbe; }};
  return &info;
}
