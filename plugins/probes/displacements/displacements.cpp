#include "displacements.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "grit/plugin.hpp"

namespace grit {

void Displacements::declare(Parameters& p) {
  p.add("along", along).one_of({"x", "y", "z"}).doc("component whose profile is taken");
  profile.declare(p);
}

std::vector<Channel> Displacements::channels() const {
  const std::vector<std::size_t> each{profile.places()};
  return {
      {"place", "m", "of each value of the profiles, along " + profile.across, each},
      {"profile", "m", "mean displacement along " + along + " of the bodies around each place, since the stage began",
       each},
      {"gradient", "1", "change of that along " + profile.across, each},
      {"fluctuation", "m",
       "root of the mean square of the bodies' displacements less the mean ones around them, around each place", each},
      {"zone_low", "m", "where the gradient rises to its peak the fastest", {}},
      {"zone_high", "m", "where it falls off the fastest", {}},
      {"zone_thickness", "m", "distance between the two, the thickness of the shear zone", {}},
      {"zone_diameters", "1", "the same over the mean diameter; 0 without bodies", {}}};
}

std::vector<Vec3> Displacements::fluctuations(const World& world) const {
  std::array<std::vector<double>, 3> mean;
  for (int axis = 0; axis < 3; ++axis)
    mean[static_cast<std::size_t>(axis)] =
        profile.mean(world, [&](std::size_t i) { return world.displacements()[i][axis]; });
  const auto nodes = profile.nodes(world);
  const double last = static_cast<double>(profile.places() - 1);
  std::vector<Vec3> left(world.displacements().begin(), world.displacements().end());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const double x = xyz(world.positions()[i])[profile.across[0] - 'x'];
    const double place = nodes.step > 0 ? std::clamp((x - nodes.first) / nodes.step, 0.0, last) : 0;
    const auto k = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
    const double part = place - static_cast<double>(k);
    for (int axis = 0; axis < 3; ++axis) {
      const auto& m = mean[static_cast<std::size_t>(axis)];
      left[i][axis] -= (1 - part) * m[k] + part * m[k + 1];
    }
  }
  return left;
}

void Displacements::sample(const World& world, std::span<const std::span<double>> values) {
  const auto nodes = profile.nodes(world);
  const int axis = along[0] - 'x';
  const auto means = profile.mean(world, [&](std::size_t i) { return world.displacements()[i][axis]; });
  const auto left = fluctuations(world);
  const auto squares = profile.mean(world, [&](std::size_t i) { return left[i].squaredNorm(); });
  std::vector<double> gradient(means.size(), 0.0);
  for (std::size_t k = 0; k < means.size() && nodes.step > 0; ++k) {
    const std::size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, means.size() - 1);
    gradient[k] = (means[after] - means[before]) / (static_cast<double>(after - before) * nodes.step);
  }
  for (std::size_t k = 0; k < means.size(); ++k)
    values[0][k] = nodes.at(k), values[1][k] = means[k], values[2][k] = gradient[k],
    values[3][k] = std::sqrt(squares[k]);
  const ShearZone zone = shear_zone(nodes, gradient);
  values[4][0] = zone.low, values[5][0] = zone.high, values[6][0] = zone.thickness();
  values[7][0] = world.mean_diameter() > 0 ? zone.thickness() / world.mean_diameter() : 0;
}

std::vector<Field> Displacements::fields(const World& world) {
  std::vector<Field> fields{{"id", "1", "of each body", 1, {}},
                            {"displacement", "m", "since the stage began", 3, {}},
                            {"fluctuation", "m", "the same less the mean around the body", 3, {}}};
  const auto left = fluctuations(world);
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Vec3& moved = world.displacements()[i];
    fields[0].values.push_back(world.ids()[i]);
    fields[1].values.insert(fields[1].values.end(), moved.begin(), moved.end());
    fields[2].values.insert(fields[2].values.end(), left[i].begin(), left[i].end());
  }
  return fields;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "displacements",
                                     .version = "1.0.0",
                                     .doc = "displacements of bodies, their profile, fluctuations and the shear zone",
                                     .make_probe = []() -> grit::Probe* { return new grit::Displacements; }};
  return &info;
}
