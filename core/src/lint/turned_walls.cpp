#include "lint/turned_walls.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "description/wall_ways.hpp"
#include "input/places.hpp"
#include "lint/all_stages.hpp"

namespace grit {
namespace {

/// Where the bodies are, seen from a wall.
struct Sides {
  std::size_t behind = 0, in_front = 0;     ///< numbers of bodies over its face
  std::optional<std::size_t> nearest = {};  ///< of those behind
  std::optional<Clearance> from_nearest = {};
};

/// Length within which all bodies and the wall are [m]; infinite for a wall without ends.
double extent(const World& world, const WallView& wall) {
  const Bounds bounds = wall.geometry->bounds();
  Vec3 low = wall.pose.to_world(bounds.low), high = low;
  const double size = (bounds.high - bounds.low).norm();
  for (const Row& x : world.positions()) low = low.cwiseMin(xyz(x)), high = high.cwiseMax(xyz(x));
  return (high - low).norm() + size;
}

Sides sides_of(const World& world, std::size_t index) {
  const WallView& wall = world.walls()[index];
  const double reach = extent(world, wall);
  const auto positions = world.positions();
  Sides sides;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto clear = world.clearance(index, xyz(positions[i]), reach);
    if (!clear) continue;
    constexpr double oblique = 1e-6;  // over an edge the normal is not that of the face
    const bool over_face = wall.normal.isZero() || 1 + clear->normal.dot(wall.normal) < oblique;
    if (clear->distance >= 0) {
      sides.in_front += over_face && !wall.normal.isZero() ? 1 : 0;
      continue;
    }
    ++sides.behind;
    if (!sides.from_nearest || clear->distance > sides.from_nearest->distance)
      sides.nearest = i, sides.from_nearest = clear;
  }
  return sides;
}

/// Whether another wall lies between the nearest body and the wall: its back is then inside an obstacle.
bool is_hidden(const World& world, std::size_t index, const Sides& sides) {
  const Row& body = world.positions()[*sides.nearest];
  constexpr double most_places = 4000;
  const double distance = -sides.from_nearest->distance, step = std::max(0.25 * body.w, distance / most_places);
  for (double gone = 0; gone < distance; gone += step) {
    const Vec3 place = xyz(body) - gone * sides.from_nearest->normal;
    for (std::size_t other = 0; other < world.walls().size(); ++other)
      if (other != index && world.clearance(other, place, step)) return true;
  }
  return false;
}

/// Whether the side of each body is that of one face: planes with ends, cylinders and cones. A mesh or box has several
/// faces, and a plane face that turns may face the bodies later.
bool has_one_face(const WallView& wall, const WallDescription& written) {
  const bool plane_face = wall.flat && !wall.normal.isZero();
  return wall.geometry != nullptr && !wall.geometry->is_triangulated() && written.groups.empty() &&
         (plane_face ? !turns(written.motion) : !wall.flat && wall.normal.isZero());
}

}  // namespace

std::vector<UnusedSetting> turned_walls(const Scene& described, const World& world) {
  std::vector<UnusedSetting> all;
  const std::size_t count = world.positions().size();
  const auto walls = world.walls();
  if (bodies_come_later(*described.description)) return all;  // they may come to the front
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const WallView& wall = walls[w];
    const auto written = described.description->walls.find(wall.name);
    if (written == described.description->walls.end() || !has_one_face(wall, written->second) ||
        !std::isfinite(extent(world, wall)))
      continue;
    const Sides sides = sides_of(world, w);
    if (2 * sides.behind <= count || sides.in_front > 0 || is_hidden(world, w, sides)) continue;
    all.push_back(
        {"/walls/" + pointer_token(wall.name),
         fmt::format("{} of {} bodies are behind it, none is in front: it holds only bodies in front of it; {}",
                     sides.behind, count,
                     wall.normal.isZero() ? "set its \"inside\" to the side of the bodies"
                                          : "exchange edge_a and edge_b, or reverse its normal")});
  }
  return all;
}

}  // namespace grit
