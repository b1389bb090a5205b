#include "interface.hpp"

#include <algorithm>
#include <limits>

#include "grit/plugin.hpp"
#include "grit/toolkit/specimen.hpp"

namespace grit {

namespace {

double ratio(double above, double below) {
  return below == 0 ? std::numeric_limits<double>::quiet_NaN() : above / below;
}

/// Of the wall, where the specimen is: a wall may reach beyond it, so that there is sand above it all the way [m²].
double covered_area(const WallView& wall, const World& world, int across) {
  const Region specimen = specimen_box(world);
  Vec3 size = specimen.high - specimen.low;
  size[across] = 1;
  return wall.area > 0 ? std::min(wall.area, size.prod()) : size.prod();
}

}  // namespace

std::vector<Channel> Interface::channels() const {
  const std::string forward = ", positive like that of a wheel rolling along the wall towards +" + layer.axis;
  return {
      {"slip", "m", "u: mean displacement along " + layer.axis + " of the layer relative to the wall in the stage", {}},
      {"rotation", "rad", "omega: mean rotation of the layer in the stage" + forward, {}},
      {"bodies", "1", "number of bodies in the layer", {}},
      {"shear_traction",
       "Pa",
       "t: force on the wall along " + layer.axis + " over its area below or above the specimen",
       {}},
      {"couple_traction", "N m-1", "m: couple on the wall about the specimen's face, over the same area" + forward, {}},
      {"rotation_ratio", "1", "A = omega d50 / u; NaN before the layer slips", {}},
      {"slip_ratio", "1", "B = u over the displacement of " + layer.driven_by + "; NaN before it moves", {}},
      {"traction_ratio", "1", "C = t d50 / m; NaN without a couple", {}}};
}

double Interface::rotation(const World& world, const Vec3& about) const {
  double sum = 0, bodies = 0;
  layer.for_bodies(world, [&](std::size_t i) { sum += world.rotations()[i].dot(about), ++bodies; });
  return bodies > 0 ? sum / bodies : 0;
}

void Interface::sample(const World& world, ChannelValues& values) {
  const WallView& wall = layer.surface(world);
  const Vec3 normal = wall.normal, about = normal.cross(Vec3::Unit(layer.along()));
  const WallLayer::Slip slip = layer.slip(world);
  const double turned = rotation(world, about), d50 = world.mean_diameter();

  // n × f about `about` is f along the slip, so that a force `height` above the face has the couple height · f.
  const int along = layer.along(), across = layer.across();
  const double face = layer.face(world);
  double force = 0, couple = 0;
  for (const Contact& contact : world.contacts_with_walls()) {
    if (contact.b != layer.index()) continue;
    const double point = xyz(world.positions()[contact.a])[across] + contact.branch[across];
    force += contact.force[along];
    couple += contact.moment.dot(about) + (point - face) * normal[across] * contact.force[along];
  }

  const double area = covered_area(wall, world, across);
  values["slip"] = slip.mean;
  values["rotation"] = turned;
  values["bodies"] = slip.bodies;
  values["shear_traction"] = ratio(force, area);
  values["couple_traction"] = ratio(couple, area);
  values["rotation_ratio"] = ratio(turned * d50, slip.mean);
  values["slip_ratio"] = ratio(slip.mean, layer.driven(world));
  values["traction_ratio"] = ratio(force * d50, couple);
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "probe",
                                     .name = "interface",
                                     .version = "1.0.0",
                                     .doc = "slip, rotation and tractions at a wall, and their ratios",
                                     .make_probe = []() -> grit::Probe* { return new grit::Interface; }};
  return &info;
}
