// Six channels a wall, or seven. See README.md.
#include "walls.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "grit/plugin.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

namespace {

/// One channel of a wall.
struct Quantity {
  const char *suffix, *unit, *doc;
  std::size_t size;  ///< 1: a number, 3: a vector
  void (*fill)(const WallView&, std::span<double>);
};

template <Vec3 WallView::*member>
void fill_vector(const WallView& wall, std::span<double> value) {
  std::ranges::copy(wall.*member, value.begin());
}

constexpr Quantity quantities[] = {
    {"_position", "m", "displacement since the start of the run, along x, y, z", 3, fill_vector<&WallView::position>},
    {"_velocity", "m s-1", "velocity along x, y, z", 3, fill_vector<&WallView::velocity>},
    {"_force", "N", "force that the bodies exert on the wall, along x, y, z", 3, fill_vector<&WallView::force>},
    {"_moment", "N m", "moment of that force about the wall's reference point, right-handed about x, y, z", 3,
     fill_vector<&WallView::moment>},
    {"_pressure", "Pa", "normal force over area, positive in compression; 0 where the geometry has no area", 1,
     [](const WallView& wall, std::span<double> value) { value.front() = wall.pressure; }},
    {"_contacts", "1", "number of contacts between bodies and the wall", 1,
     [](const WallView& wall, std::span<double> value) { value.front() = wall.contacts; }},
    {"_spin", "rad s-1", "angular velocity, right-handed about x, y, z", 3, fill_vector<&WallView::spin>},
};

/// The last only if it is wanted.
std::span<const Quantity> reported(bool spin) {
  return std::span(quantities).first(std::size(quantities) - (spin ? 0 : 1));
}

}  // namespace

void WallsProbe::declare(Parameters& parameters) {
  parameters.add("walls", walls).doc("names of the walls to report, in this order; empty: all walls");
  parameters.add("spin", spin).doc("whether to report angular velocities, too");
}

void WallsProbe::prepare(const World& world) {
  reported_.clear();
  for (const auto& name : walls.empty() ? wall_names(world) : walls) {
    Reported wall{wall_stem(name), wall_index(world, name, "walls"), {}};
    for (const auto& other : reported_)
      if (other.stem == wall.stem)
        throw ParameterError({{"walls",
                               "walls \"" + world.walls()[other.index].name + "\" and \"" + name +
                                   "\", whose channels would both be \"" + wall.stem + "_…\"",
                               "one of the two; remove one, or rename it"}});
    for (const auto& quantity : reported(spin)) wall.channels.push_back(wall.stem + quantity.suffix);
    reported_.push_back(std::move(wall));
  }
}

std::vector<Channel> WallsProbe::channels() const {
  std::vector<Channel> channels;
  for (const auto& wall : reported_)
    for (std::size_t i = 0; const auto& quantity : reported(spin))
      channels.push_back({wall.channels[i++], quantity.unit, quantity.doc,
                          quantity.size == 1 ? std::vector<std::size_t>{} : std::vector{quantity.size}});
  return channels;
}

void WallsProbe::sample(const World& world, ChannelValues& values) {
  for (const auto& wall : reported_)
    for (std::size_t i = 0; const auto& quantity : reported(spin))
      quantity.fill(world.walls()[wall.index], values.list(wall.channels[i++]));
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "walls",
                                     .version = "1.0.0",
                                     .doc = "displacement, velocity, force, moment, pressure and wall contacts",
                                     .make_probe = []() -> grit::Probe* { return new grit::WallsProbe; }};
  return &info;
}
