#include "rotations.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "grit/plugin.hpp"

namespace grit {

void Rotations::declare(Parameters& p) {
  p.add("about", about)
      .one_of({"x", "y", "z"})
      .doc("axis of rotation; about y, clockwise is positive where x is right and z up");
  profile.declare(p);
}

std::vector<Channel> Rotations::channels() const {
  const std::string sign =
      ", right-handed about " + about + (about == "y" ? ", clockwise where x is right and z up" : "");
  const std::vector<std::size_t> each{static_cast<std::size_t>(profile.points)};
  std::vector<Channel> channels{
      {"position", "m", "position of each value of the profile, along " + profile.across, each},
      {"profile", "rad",
       "rotation in the stage at each point, by a linear fit to the bodies around it" + sign + "; NaN without any",
       each, "position"},
      {"mean", "rad", "mean rotation of all bodies in the stage" + sign + "; 0 without any", {}},
      {"mean_magnitude", "rad", "mean magnitude of the rotations about " + about + " in the stage; 0 without any", {}}};
  std::ranges::copy(zone_channels("profile"), std::back_inserter(channels));
  return channels;
}

void Rotations::sample(const World& world, ChannelValues& values) {
  const int axis = about[0] - 'x';
  const auto turned = world.rotations();
  const auto nodes = profile.nodes(world);
  const auto lines = profile.fit(world, [&](std::size_t i) { return turned[i][axis]; });
  const auto places = values.list("position");
  for (std::size_t k = 0; k < places.size(); ++k) places[k] = nodes.at(k);
  std::ranges::copy(lines.value, values.list("profile").begin());
  double sum = 0, magnitudes = 0;
  for (const Vec3& body : turned)
    if (const double one = body[axis]; std::isfinite(one)) sum += one, magnitudes += std::abs(one);
  const double count = std::max<double>(1, static_cast<double>(turned.size()));
  values["mean"] = sum / count;
  values["mean_magnitude"] = magnitudes / count;
  fill_zone(shear_zone(nodes, lines.value), world, values);
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
