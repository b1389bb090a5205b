// The grains of a world as a picture shows them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "output/frames.hpp"
#include "output/picture.hpp"

namespace grit {

/// What is seen of bodies. Rotations and displacements are empty where they are not kept.
struct SeenBodies {
  std::span<const Row> positions, velocities;
  std::span<const Vec3> rotations, displacements;
  Region specimen{Vec3::Zero(), Vec3::Zero()};  ///< where walls are cut through if there is no body
  std::span<const int> layers = {};             ///< from 1, 0 for none; for the colour "layer"
};

/// Of as many layers the pictures of a run are; the page has as many.
inline constexpr int layer_count = 10;

/// Which way to look, and what the colours say.
///
/// `view`: "xz" (from the front, y into the page), "xy" (from above), "yz" (from the side); first axis to the right,
/// second upwards. `color`: "rotation" about the line of sight, positive clockwise as seen; "displacement" along the
/// first axis; "speed"; "layer" where layers are told. Where the world does not keep the state, grains are grey.
///
/// Grains whose centres lie in the middle third of the depth are shown, back to front; all of them where the depth is
/// less than three mean diameters. Those that are far from all others (far_to_draw) are counted, not shown. Walls, as
/// triangles of three corners each [m], are cut at mid-depth. Throws Error for another view or colour.
GrainView grain_view(const SeenBodies& bodies, std::span<const std::vector<Vec3>> walls, const std::string& view,
                     const std::string& color);

/// The same of a world, whose walls are where they have moved to.
GrainView grain_view(const World& world, std::span<const WallShape> walls, const std::string& view,
                     const std::string& color);

/// Where a plane across the line of sight cuts walls, `depth` along the third axis [m]. Throws Error for another view.
std::vector<Segment> cut_walls(std::span<const std::vector<Vec3>> walls, const std::string& view, double depth);

}  // namespace grit
