#include "output/wall_shape.hpp"

#include <algorithm>

namespace grit {

std::vector<Vec3> triangles_of(const WallView& wall, std::span<const WallShape> shapes, const std::string& stage) {
  const auto in = [&](const std::string& when) {
    return std::ranges::find_if(shapes, [&](const WallShape& s) { return s.name == wall.name && s.stage == when; });
  };
  auto shape = in(stage);
  if (shape == shapes.end()) shape = in("");
  if (shape == shapes.end()) return {};
  auto triangles = shape->triangles;
  for (auto& corner : triangles) corner = wall.pose.turned() ? wall.pose.to_world(corner) : corner + wall.position;
  return triangles;
}

}  // namespace grit
