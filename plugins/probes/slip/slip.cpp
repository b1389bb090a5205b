#include "slip.hpp"

#include "grit/plugin.hpp"

namespace grit {

std::vector<Channel> Slip::channels() const {
  return {{"displacement",
           "m",
           "mean displacement along " + layer.axis +
               " of the layer at the wall, relative to the wall, since the start of the stage",
           {}},
          {"fraction", "1", "displacement over that of " + layer.driven_by + "; 0 before it moves", {}},
          {"bodies", "1", "number of bodies in the layer", {}}};
}

void Slip::sample(const World& world, ChannelValues& values) {
  const WallLayer::Slip slip = layer.slip(world);
  const double driven = layer.driven(world);
  values["displacement"] = slip.mean;
  values["fraction"] = driven == 0 ? 0 : slip.mean / driven;
  values["bodies"] = slip.bodies;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "slip",
                                     .version = "1.0.0",
                                     .doc = "slip of a specimen along a wall",
                                     .make_probe = []() -> grit::Probe* { return new grit::Slip; }};
  return &info;
}
