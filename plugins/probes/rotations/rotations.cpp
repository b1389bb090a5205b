#include "rotations.hpp"

#include <algorithm>
#include <cmath>

#include "grit/plugin.hpp"

namespace grit {

void Rotations::declare(Parameters& p) {
  p.add("about", about)
      .one_of({"x", "y", "z"})
      .doc("axis of rotation; about y, clockwise is positive where x is right and z up");
  profile.declare(p);
}

std::vector<Channel> Rotations::channels() const {
  const std::string sign = ", right-handed about " + about;
  return {{"place", "m", "of each value of the profile, along " + profile.across, {profile.places()}},
          {"profile", "rad", "mean cumulative rotation of the bodies around each place" + sign, {profile.places()}},
          {"mean", "rad", "mean cumulative rotation of all bodies" + sign, {}},
          {"mean_size", "rad", "mean magnitude of the bodies' cumulative rotations about " + about, {}},
          {"zone_low", "m", "where the profile rises to its peak the fastest", {}},
          {"zone_high", "m", "where it falls off the fastest", {}},
          {"zone_thickness", "m", "distance between the two, the thickness of the shear zone", {}},
          {"zone_diameters", "1", "the same over the mean diameter; 0 without bodies", {}}};
}

void Rotations::sample(const World& world, std::span<const std::span<double>> values) {
  const auto nodes = profile.nodes(world);
  const auto means = profile.mean(world, [&](std::size_t i) { return turned(world, i); });
  for (std::size_t k = 0; k < means.size(); ++k) values[0][k] = nodes.at(k), values[1][k] = means[k];
  const std::size_t bodies = world.rotations().size();
  double sum = 0, sizes = 0;
  for (std::size_t i = 0; i < bodies; ++i) sum += turned(world, i), sizes += std::abs(turned(world, i));
  const double count = std::max<double>(1, static_cast<double>(bodies));
  values[2][0] = sum / count, values[3][0] = sizes / count;
  const ShearZone zone = shear_zone(nodes, means);
  values[4][0] = zone.low, values[5][0] = zone.high, values[6][0] = zone.thickness();
  values[7][0] = world.mean_diameter() > 0 ? zone.thickness() / world.mean_diameter() : 0;
}

std::vector<Field> Rotations::fields(const World& world) {
  std::vector<Field> fields{{"id", "1", "of each body", 1, {}},
                            {"rotation", "rad", "its cumulative rotation, right-handed about " + about, 1, {}}};
  for (std::size_t i = 0; i < world.rotations().size(); ++i)
    fields[0].values.push_back(world.ids()[i]), fields[1].values.push_back(turned(world, i));
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "rotations",
                                     .version = "1.0.0",
                                     .doc = "rotations of bodies, their profile and the shear zone in it",
                                     .make_probe = []() -> grit::Probe* { return new grit::Rotations; }};
  return &info;
}
