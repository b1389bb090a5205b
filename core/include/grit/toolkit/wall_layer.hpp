// The bodies that lay at a wall when the stage began, and how far they slip along it.
#pragma once

#include <algorithm>
#include <string>

#include "grit/error.hpp"
#include "grit/parameters.hpp"
#include "grit/probe.hpp"
#include "grit/toolkit/specimen.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

/// A layer of bodies by their centres, from within `thickness` of the specimen's face and behind it. Needs
/// BodyState::displacement.
class WallLayer {
 public:
  std::string wall, driven_by, axis = "x";
  double thickness = 0.5;  ///< mean diameters

  void declare(Parameters& p) {
    p.add("wall", wall).required().doc("along which bodies slip");
    p.add("driven_by", driven_by).required().doc("wall whose displacement relative to that one is all of it");
    p.add("axis", axis).one_of({"x", "y", "z"}).doc("of the slip");
    p.add("thickness", thickness)
        .above(0)
        .doc(
            "of the layer at the wall, over the mean diameter: bodies count whose centres were in it, or behind it, "
            "when the stage began");
  }
  /// Throws Error, beginning with `who`, for a wall that does not exist, that is not perpendicular to an axis, along
  /// whose normal the slip would be, or at which the specimen does not end.
  void prepare(const World& world, const std::string& who) {
    wall_ = wall_index(world, wall, who + ", /wall");
    driver_ = wall_index(world, driven_by, who + ", /driven_by");
    along_ = axis.front() - 'x';
    const Vec3& normal = world.walls()[wall_].normal;
    if (!(normal.cwiseAbs().maxCoeff(&across_) > 1 - 1e-9))
      throw Error(who + ", /wall: wall \"" + wall + "\" is not perpendicular to x, y or z");
    if (across_ == along_)
      throw Error(who + ", /axis: wall \"" + wall + "\" is perpendicular to " + axis +
                  "; slip is along a wall, so name another axis");
    if (!bounds_specimen(world))
      throw Error(who + ", /wall: the specimen does not end at wall \"" + wall + "\"; name it in /specimen");
  }

  std::size_t index() const { return wall_; }  ///< of the wall, in World::walls()
  int along() const { return along_; }         ///< 0, 1, 2: x, y, z
  int across() const { return across_; }
  const WallView& surface(const World& world) const { return world.walls()[wall_]; }
  /// Where the specimen begins at the wall, now [m]; of a grooved or wavy wall at its tips.
  double face(const World& world) const {
    const Region specimen = specimen_box(world);
    return (surface(world).normal[across_] > 0 ? specimen.low : specimen.high)[across_];
  }
  /// How far the other wall has gone, relative to the wall, since the stage began [m].
  double driven(const World& world) const {
    return world.walls()[driver_].stage_position[along_] - surface(world).stage_position[along_];
  }
  /// Calls visit(index) for each body of the layer.
  template <class Visit>
  void for_bodies(const World& world, Visit visit) const {
    const bool below = surface(world).normal[across_] > 0;
    const double start = face(world) - surface(world).stage_position[across_],
                 reach = thickness * world.mean_diameter();
    for (std::size_t i = 0; i < world.positions().size(); ++i) {
      const double above = xyz(world.positions()[i])[across_] - world.displacements()[i][across_] - start;
      if (!((below ? above : -above) > reach)) visit(i);
    }
  }

  struct Slip {
    double mean = 0, bodies = 0;  ///< m; how many
  };
  /// Mean displacement of the layer relative to the wall since the stage began; 0 without bodies.
  Slip slip(const World& world) const {
    Slip layer;
    for_bodies(world, [&](std::size_t i) { layer.mean += world.displacements()[i][along_], ++layer.bodies; });
    if (layer.bodies > 0) layer.mean = layer.mean / layer.bodies - surface(world).stage_position[along_];
    return layer;
  }

 private:
  /// Whether the wall is where the face is, as far as can be told from the middle of the face: there the surface may
  /// lie behind, in a groove, but not before. Without bodies it cannot be told.
  bool bounds_specimen(const World& world) const {
    const double diameter = world.mean_diameter();
    if (!(diameter > 0)) return true;
    const Region specimen = specimen_box(world);
    Vec3 point = 0.5 * (specimen.low + specimen.high);
    point[across_] = face(world) + 0.5 * diameter * surface(world).normal[across_];
    const Region all = closed_box(world.envelope(), world);
    const double depth = std::max(specimen.low[across_] - all.low[across_], all.high[across_] - specimen.high[across_]);
    const auto clear = world.clearance(wall_, point, diameter + std::max(0.0, depth));
    return clear && clear->distance > (0.5 - 1e-6) * diameter;
  }

  std::size_t wall_ = 0, driver_ = 0;
  int along_ = 0, across_ = 2;
};

}  // namespace grit
