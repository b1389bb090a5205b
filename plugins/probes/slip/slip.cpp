#include "slip.hpp"

#include <cmath>

#include "../specimen.hpp"
#include "../wall_names.hpp"
#include "grit/plugin.hpp"

namespace grit {

void Slip::declare(Parameters& p) {
  p.add("wall", wall).required().doc("along which bodies slip");
  p.add("driven_by", driven_by).required().doc("wall whose displacement relative to that one is all of it");
  p.add("axis", axis).one_of({"x", "y", "z"}).doc("of the slip");
  p.add("thickness", thickness)
      .above(0)
      .doc(
          "of the layer at the wall, over the mean diameter: bodies count whose centres were in it, or behind it, when "
          "the stage began");
}

void Slip::prepare(const World& world) {
  const std::string who = "probe slip";
  wall_ = wall_index(world, wall, who + ", /wall");
  driver_ = wall_index(world, driven_by, who + ", /driven_by");
  axis_ = axis.front() - 'x';
  const Vec3& normal = world.walls()[wall_].normal;
  if (!(normal.cwiseAbs().maxCoeff(&across_) > 1 - 1e-9))
    throw Error(who + ", /wall: wall \"" + wall + "\" is not perpendicular to x, y or z");
  if (across_ == axis_)
    throw Error(who + ", /axis: wall \"" + wall + "\" is perpendicular to " + axis +
                "; slip is along a wall, so name another axis");
}

std::vector<Channel> Slip::channels() const {
  return {{"displacement",
           "m",
           "mean displacement along " + axis + " of the layer at the wall, relative to it, since the stage began",
           {}},
          {"share", "1", "the same over that of " + driven_by + "; 0 before it moves", {}},
          {"bodies", "1", "number of bodies in the layer", {}}};
}

void Slip::sample(const World& world, std::span<const std::span<double>> values) {
  const WallView &surface = world.walls()[wall_], &driver = world.walls()[driver_];
  const Region specimen = specimen_box(world);
  const bool below = surface.normal[across_] > 0;
  const double face = (below ? specimen.low : specimen.high)[across_] - surface.stage_position[across_];
  const double reach = thickness * world.mean_diameter();
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < world.positions().size(); ++i) {
    const Vec3& moved = world.displacements()[i];
    const double above = xyz(world.positions()[i])[across_] - moved[across_] - face;
    if ((below ? above : -above) > reach) continue;
    sum += moved[axis_], ++count;
  }
  const double mean = count > 0 ? sum / static_cast<double>(count) - surface.stage_position[axis_] : 0;
  const double driven = driver.stage_position[axis_] - surface.stage_position[axis_];
  values[0][0] = mean;
  values[1][0] = driven == 0 ? 0 : mean / driven;
  values[2][0] = static_cast<double>(count);
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
