// Six channels a wall. See README.md.
#include "walls.hpp"

#include "grit/plugin.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

namespace {

/// One channel of a wall.
struct Quantity {
  const char *suffix, *unit, *doc;
  std::size_t size;  ///< 1: a number, 3: a vector
  void (*fill)(const WallView&, double*);
};

template <Vec3 WallView::*member>
void fill_vector(const WallView& wall, double* value) {
  for (int k = 0; k < 3; ++k) value[k] = (wall.*member)[k];
}

constexpr Quantity quantities[] = {
    {"_position", "m", "displacement since the start of the run, along x, y, z", 3, fill_vector<&WallView::position>},
    {"_velocity", "m s-1", "velocity along x, y, z", 3, fill_vector<&WallView::velocity>},
    {"_force", "N", "force that the bodies exert on the wall, along x, y, z", 3, fill_vector<&WallView::force>},
    {"_moment", "N m", "moment of that force about the wall's reference point, right-handed about x, y, z", 3,
     fill_vector<&WallView::moment>},
    {"_pressure", "Pa", "normal force over area, positive in compression; 0 where the geometry has no area", 1,
     [](const WallView& wall, double* value) { *value = wall.pressure; }},
    {"_touches", "1", "number of touching points between bodies and the wall", 1,
     [](const WallView& wall, double* value) { *value = wall.touches; }},
};

}  // namespace

void WallsProbe::declare(Parameters& parameters) {
  parameters.add("walls", walls).doc("names of the walls to report, in this order; empty: all walls");
}

void WallsProbe::prepare(const World& world) {
  reported_.clear();
  for (const auto& name : walls.empty() ? wall_names(world) : walls) {
    const Reported wall{wall_stem(name), wall_index(world, name, "probe walls, /walls")};
    for (const auto& other : reported_)
      if (other.stem == wall.stem)
        throw Error("probe walls, /walls: walls \"" + world.walls()[other.index].name + "\" and \"" + name +
                    "\" would both be reported as \"" + wall.stem + "_…\"; report one of them, or rename it");
    reported_.push_back(wall);
  }
}

std::vector<Channel> WallsProbe::channels() const {
  std::vector<Channel> channels;
  for (const auto& wall : reported_)
    for (const auto& quantity : quantities)
      channels.push_back({wall.stem + quantity.suffix, quantity.unit, quantity.doc,
                          quantity.size == 1 ? std::vector<std::size_t>{} : std::vector{quantity.size}});
  return channels;
}

void WallsProbe::sample(const World& world, std::span<const std::span<double>> values) {
  auto value = values.begin();
  for (const auto& wall : reported_)
    for (const auto& quantity : quantities) quantity.fill(world.walls()[wall.index], (value++)->data());
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "walls",
                                     .version = "1.0.0",
                                     .doc = "displacement, velocity, force, moment, pressure and touches of walls",
                                     .make_probe = []() -> grit::Probe* { return new grit::WallsProbe; }};
  return &info;
}
