// The layer of bodies that was next to a wall at the start of the stage, and its slip along the wall.
#pragma once

#include <algorithm>
#include <string>

#include "grit/error.hpp"
#include "grit/parameters.hpp"
#include "grit/probe.hpp"
#include "grit/toolkit/specimen.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

/// The bodies whose centres were within `thickness` of the specimen's face, or behind it, at the start of the stage.
/// Needs BodyState::displacement.
class WallLayer {
 public:
  std::string wall, driven_by, axis = "x";
  double thickness = 0.5;  ///< mean diameters

  void declare(Parameters& p) {
    p.add("wall", wall).required().doc("wall along which bodies slip");
    p.add("driven_by", driven_by)
        .required()
        .doc("moving wall, whose displacement relative to `wall` is the whole displacement");
    p.add("axis", axis).one_of({"x", "y", "z"}).doc("axis of the slip");
    p.add("thickness", thickness)
        .above(0)
        .doc(
            "thickness of the layer over the mean diameter; it contains bodies whose centres were in it, or behind it, "
            "at the start of the stage");
  }
  /// Throws ParameterError for a wall that does not exist, is not perpendicular to an axis, is perpendicular to the
  /// axis of the slip, or does not bound the specimen.
  void prepare(const World& world) {
    wall_ = wall_index(world, wall, "wall");
    driver_ = wall_index(world, driven_by, "driven_by");
    along_ = axis.front() - 'x';
    const Vec3& normal = world.walls()[wall_].normal;
    if (!(normal.cwiseAbs().maxCoeff(&across_) > 1 - 1e-9))
      throw ParameterError({{"wall", "wall \"" + wall + '"', "a wall perpendicular to x, y or z"}});
    if (across_ == along_)
      throw ParameterError({{"axis", axis + ", to which wall \"" + wall + "\" is perpendicular",
                             "an axis in the plane of the wall, along which bodies slip"}});
    if (!bounds_specimen(world))
      throw ParameterError({{"wall", "wall \"" + wall + "\", at which the specimen does not end",
                             "a wall that bounds the specimen; name it in /specimen"}});
  }

  std::size_t index() const { return wall_; }  ///< of the wall, in World::walls()
  int along() const { return along_; }         ///< 0, 1, 2: x, y, z
  int across() const { return across_; }
  const WallView& surface(const World& world) const { return world.walls()[wall_]; }
  /// Present position of the specimen's face at the wall [m]; for a grooved or sinusoidal wall, at its crests.
  double face(const World& world) const {
    const Region specimen = specimen_box(world);
    return (surface(world).normal[across_] > 0 ? specimen.low : specimen.high)[across_];
  }
  /// Displacement of the moving wall relative to the wall since the start of the stage [m].
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

  /// Displacement of bodies relative to a wall.
  struct Slip {
    double mean = 0, bodies = 0;  ///< mean [m]; number of bodies
  };
  /// Mean displacement of the layer relative to the wall since the start of the stage; 0 without bodies.
  Slip slip(const World& world) const {
    Slip layer;
    for_bodies(world, [&](std::size_t i) { layer.mean += world.displacements()[i][along_], ++layer.bodies; });
    if (layer.bodies > 0) layer.mean = layer.mean / layer.bodies - surface(world).stage_position[along_];
    return layer;
  }

 private:
  /// Whether the wall is at the face, tested at the middle of the face: the surface there may be behind the face, in a
  /// groove, but not in front of it. True without bodies.
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
