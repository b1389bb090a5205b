#include "displacements.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "grit/plugin.hpp"
#include "grit/toolkit/specimen.hpp"

namespace grit {

namespace {

/// Its gradient; strips count from 1.
std::string strip_channel(std::int64_t strip) { return "gradient_strip_" + std::to_string(strip); }

}  // namespace

void Displacements::declare(Parameters& p) {
  p.add("along", along).one_of({"x", "y", "z"}).doc("component of the displacement");
  profile.declare(p);
  p.add("strips", strips)
      .at_least(0)
      .at_most(1000)
      .doc("number of strips of equal width, each with its own profile of the gradient; 0: none");
  p.add("strips_along", strips_along).one_of({"x", "y", "z"}).doc("axis along which the strips follow each other");
  p.check(
      [this](const Complain& complain) {
        if (strips > 0 && strips_along == profile.across)
          complain("strips_along", strips_along, "an axis other than across, the axis of the profiles");
      },
      {"strips", "strips_along", "across"});
}

std::vector<Channel> Displacements::channels() const {
  const std::vector<std::size_t> each{static_cast<std::size_t>(profile.points)};
  std::vector<Channel> channels{
      {"position", "m", "position of each value of the profiles, along " + profile.across, each},
      {"profile", "m",
       "displacement along " + along +
           " since the start of the stage, at each point, by a linear fit to the bodies around it; NaN without any",
       each, "position"},
      {"gradient", "1", "slope of that fit, along " + profile.across + "; NaN with too few bodies", each, "position"},
      {"fluctuation", "m",
       "root mean square of the displacements of bodies less the profiles of all three components, around each "
       "place; " +
           std::string("NaN without any"),
       each, "position"}};
  std::ranges::copy(zone_channels("gradient"), std::back_inserter(channels));
  for (std::int64_t strip = 1; strip <= strips; ++strip)
    channels.push_back({strip_channel(strip), "1",
                        "as gradient, for the bodies in strip " + std::to_string(strip) + " of " +
                            std::to_string(strips) + " along " + strips_along + "; NaN with too few bodies",
                        each, "position"});
  return channels;
}

Displacements::Profiles Displacements::profiles(const World& world) const {
  const auto of = [&](int axis) {
    return profile.fit(world, [&](std::size_t i) { return world.displacements()[i][axis]; });
  };
  return {of(0), of(1), of(2)};
}

std::vector<Vec3> Displacements::fluctuations(const World& world, const Profiles& mean) const {
  const auto nodes = profile.nodes(world);
  const double last = static_cast<double>(profile.points - 1), unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3> left(world.displacements().begin(), world.displacements().end());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const double x = xyz(world.positions()[i])[profile.across[0] - 'x'];
    const double place = std::min(std::max((x - nodes.first) / nodes.step, 0.0), last);
    if (!std::isfinite(x) || !std::isfinite(place)) {
      left[i].setConstant(unknown);
      continue;
    }
    const auto k = static_cast<std::size_t>(std::min(std::floor(place), last - 1));
    const double part = place - static_cast<double>(k);
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<double>& at = mean[static_cast<std::size_t>(axis)].value;
      left[i][axis] -= part == 0 ? at[k] : (1 - part) * at[k] + part * at[k + 1];
    }
  }
  return left;
}

void Displacements::fill_strips(const World& world, ChannelValues& values) const {
  const Region box = specimen_box(world);
  const int side = strips_along[0] - 'x', axis = along[0] - 'x';
  const double width = (box.high[side] - box.low[side]) / static_cast<double>(strips);
  for (std::int64_t strip = 0; strip < strips; ++strip) {
    const auto of_strip = [&](std::size_t i) {
      const double across = (world.cell().inside(xyz(world.positions()[i])[side], side) - box.low[side]) / width;
      // What lies beyond the outermost ones is theirs.
      const double place = std::clamp(std::floor(across), 0.0, static_cast<double>(strips - 1));
      return place == static_cast<double>(strip) ? world.displacements()[i][axis]
                                                 : std::numeric_limits<double>::quiet_NaN();
    };
    std::ranges::copy(profile.fit(world, of_strip).slope, values.list(strip_channel(strip + 1)).begin());
  }
}

void Displacements::sample(const World& world, ChannelValues& values) {
  const auto nodes = profile.nodes(world);
  const Profiles mean = profiles(world);
  const Profile::Lines& lines = mean[static_cast<std::size_t>(along[0] - 'x')];
  const auto left = fluctuations(world, mean);
  const auto squares = profile.fit(world, [&](std::size_t i) { return left[i].squaredNorm(); }).value;
  const auto places = values.list("position");
  const auto fluctuation = values.list("fluctuation");
  for (std::size_t k = 0; k < places.size(); ++k) {
    places[k] = nodes.at(k);
    fluctuation[k] = std::sqrt(squares[k] < 0 ? 0 : squares[k]);
  }
  std::ranges::copy(lines.value, values.list("profile").begin());
  std::ranges::copy(lines.slope, values.list("gradient").begin());
  fill_zone(shear_zone(nodes, lines.slope), world, values);
  fill_strips(world, values);
}

std::vector<Field> Displacements::fields(const World& world) {
  const auto left = fluctuations(world, profiles(world));
  std::vector<Field> fields{{"id", "1", "id of each body", 1, {}},
                            {"centre", "m", "present centre of each body", 3, {}},
                            {"size", "m", "diameter of each body, along all axes", 3, {}},
                            {"fluctuation",
                             "m",
                             "displacement less the profile, positive along the axis; NaN where the profile is unknown",
                             3,
                             {}}};
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Row& body = world.positions()[i];
    fields[0].values.push_back(world.ids()[i]);
    fields[1].values.insert(fields[1].values.end(), {body.x, body.y, body.z});
    fields[2].values.insert(fields[2].values.end(), 3, 2 * body.w);
    fields[3].values.insert(fields[3].values.end(), left[i].begin(), left[i].end());
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
