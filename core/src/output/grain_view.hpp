// The grains of a world as drawn in a picture.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "output/body_values.hpp"
#include "output/frames.hpp"
#include "output/picture.hpp"

namespace grit {

/// The body state that is drawn. Rotations and displacements are empty if they are not tracked.
struct SeenBodies {
  std::span<const Row> positions, velocities;
  std::span<const Vec3> rotations, displacements;
  Region specimen{Vec3::Zero(), Vec3::Zero()};  ///< its middle is the section through walls if there is no body
  std::span<const int> layers = {};             ///< from 1, 0 for none; for the colour "layer"
  std::span<const std::int32_t> groups = {};    ///< index of each body's group; for the colour "group"
  std::span<const std::string> group_names = {};
  const BodyValues* values = nullptr;  ///< for a colour that names a field of a probe
};

/// Number of layers in pictures and on the page of a run.
inline constexpr int layer_count = 10;

/// Grains as seen in a direction, with the meaning of the colours.
///
/// `view`: "xz" (from the front, y into the page), "xy" (from above), "yz" (from the side); first axis to the right,
/// second upwards. `color`: "rotation" about the line of sight, positive clockwise as seen; "displacement" along the
/// first axis; "speed"; "radius"; "group" and "layer" if they are given; "PROBE/FIELD", see BodyValues. Grains are grey
/// if the state is not tracked.
///
/// Grains whose centres lie in the middle third of the depth are shown, back to front; all of them if the depth is less
/// than three mean diameters. Outliers (far_to_draw) are counted, not shown. Walls, as triangles of three corners each
/// [m], are cut at mid-depth. Throws Error for another view or colour.
GrainView grain_view(const SeenBodies& bodies, std::span<const std::vector<Vec3>> walls, const std::string& view,
                     const std::string& color);

/// The same for a world, with walls in their present positions.
GrainView grain_view(const World& world, std::span<const WallShape> walls, const std::string& view,
                     const std::string& color, const BodyValues* values = nullptr);

/// Section of walls with a plane normal to the line of sight at `depth` [m]. Throws Error for another view.
std::vector<Segment> cut_walls(std::span<const std::vector<Vec3>> walls, const std::string& view, double depth);

}  // namespace grit
