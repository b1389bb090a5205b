#include "displacements.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "grit/plugin.hpp"

namespace grit {

void Displacements::declare(Parameters& p) {
  p.add("along", along).one_of({"x", "y", "z"}).doc("component whose profile is taken");
  profile.declare(p);
}

std::vector<Channel> Displacements::channels() const {
  const std::vector<std::size_t> each{static_cast<std::size_t>(profile.places)};
  std::vector<Channel> channels{
      {"place", "m", "of each value of the profiles, along " + profile.across, each},
      {"profile", "m",
       "displacement along " + along +
           " at each place, by the line that fits the bodies around it, since the stage began; " + "NaN without any",
       each, "place"},
      {"gradient", "1", "slope of that line, along " + profile.across + "; NaN where bodies are too few", each,
       "place"},
      {"fluctuation", "m",
       "root of the mean square of the bodies' displacements less the profiles of all three components, around each "
       "place; " +
           std::string("NaN without any"),
       each, "place"}};
  std::ranges::copy(zone_channels("gradient"), std::back_inserter(channels));
  return channels;
}

std::vector<Vec3> Displacements::fluctuations(const World& world) const {
  const auto nodes = profile.nodes(world);
  const double last = static_cast<double>(profile.places - 1), unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> left(world.displacements().begin(), world.displacements().end());
  for (int axis = 0; axis < 3; ++axis) {
    const auto mean = profile.fit(world, [&](std::size_t i) { return world.displacements()[i][axis]; }).value;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const double x = xyz(world.positions()[i])[profile.across[0] - 'x'];
      const double place = std::min(std::max((x - nodes.first) / nodes.step, 0.0), last);
      if (!std::isfinite(x) || !std::isfinite(place)) {
        left[i][axis] = unknown;
        continue;
      }
      const auto k = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
      const double part = place - static_cast<double>(k);
      left[i][axis] -= part == 0 ? mean[k] : (1 - part) * mean[k] + part * mean[k + 1];
    }
  }
  return left;
}

void Displacements::sample(const World& world, std::span<const std::span<double>> values) {
  const auto nodes = profile.nodes(world);
  const int axis = along[0] - 'x';
  const auto lines = profile.fit(world, [&](std::size_t i) { return world.displacements()[i][axis]; });
  const auto left = fluctuations(world);
  const auto squares = profile.fit(world, [&](std::size_t i) { return left[i].squaredNorm(); }).value;
  for (std::size_t k = 0; k < lines.value.size(); ++k) {
    values[0][k] = nodes.at(k), values[1][k] = lines.value[k], values[2][k] = lines.slope[k];
    values[3][k] = std::sqrt(squares[k] < 0 ? 0 : squares[k]);
  }
  fill_zone(shear_zone(nodes, lines.slope), world, values.subspan(4));
}

std::vector<Field> Displacements::fields(const World& world) {
  std::vector<Field> fields{
      {"id", "1", "of each body", 1, {}},
      {"fluctuation", "m", "its displacement less the profile; NaN where that is unknown", 3, {}}};
  const auto left = fluctuations(world);
  for (std::size_t i = 0; i < left.size(); ++i) {
    fields[0].values.push_back(world.ids()[i]);
    fields[1].values.insert(fields[1].values.end(), left[i].begin(), left[i].end());
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
