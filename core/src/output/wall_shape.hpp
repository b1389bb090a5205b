// The triangles of walls.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "grit/archive.hpp"
#include "grit/world.hpp"

namespace grit {

/// The shape of a wall at its initial position.
struct WallShape {
  std::string name;
  std::vector<Vec3> triangles;  ///< three corners each [m]
  std::string stage = {};       ///< stage with this shape; empty: all stages without a shape of their own
  bool clipped = false;         ///< an unbounded plane, drawn in a box that may be that of the first bodies
  void serialize(Archive& archive) { archive(name, triangles, stage, clipped); }
};

/// The triangles of a wall at its present position; none if no shape has its name.
std::vector<Vec3> triangles_of(const WallView& wall, std::span<const WallShape> shapes, const std::string& stage);

}  // namespace grit
