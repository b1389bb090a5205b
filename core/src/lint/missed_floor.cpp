#include "lint/missed_floor.hpp"

#include <algorithm>
#include <cmath>

#include "format/number.hpp"
#include "lint/all_stages.hpp"
#include "run/conditions.hpp"

namespace grit {
namespace {

/// The gravity of all bodies [m/s²]; none if groups differ, bodies are held, or other forces act.
std::optional<Vec3> only_gravity(const SceneDescription& start) {
  LiveEngines engines;
  engines.follow(start);
  std::optional<Vec3> gravity;
  const bool alike = all_settings(start, engines.all(), [&](const MotionSettings& group) {
    if (!gravity) gravity = group.gravity;
    return group.gravity == *gravity && !group.holds() && !group.flat;
  });
  return alike && !has_forces(engines.all()) ? gravity : std::nullopt;
}

/// Length beyond which there are neither bodies nor ends of walls [m].
double length_of(const World& world) {
  Vec3 low = xyz(world.positions().front()), high = low;
  const auto extend = [&](const Vec3& point) {
    for (int k = 0; k < 3; ++k)
      if (std::isfinite(point[k])) low[k] = std::min(low[k], point[k]), high[k] = std::max(high[k], point[k]);
  };
  for (const Row& x : world.positions()) extend(xyz(x));
  for (const WallView& wall : world.walls())
    for (const Vec3& end : {wall.geometry->bounds().low, wall.geometry->bounds().high}) extend(wall.pose.to_world(end));
  return (high - low).norm();
}

/// Whether a body that falls from `place` along the unit vector `down` reaches a wall within `length` [m].
bool meets_wall(const World& world, const Row& body, const Vec3& down, double length) {
  constexpr double most_places = 1000, near = 0.01;
  const double reach = std::max(10 * body.w, length / most_places);
  for (double gone = 0; gone < length;) {
    double clear = reach;
    for (std::size_t wall = 0; wall < world.walls().size(); ++wall)
      if (const auto found = world.clearance(wall, xyz(body) + gone * down, reach))
        clear = std::min(clear, std::abs(found->distance));
    if (clear < near * body.w) return true;
    gone += clear;
  }
  return false;
}

/// Whether a plane without ends faces bodies that fall.
bool is_endless_floor(const WallView& wall, const Vec3& down) {
  return wall.flat && wall.normal.dot(down) < 0 && !wall.geometry->bounds().low.allFinite();
}

/// Whether a body that leaves one side may come back on the other.
bool repeats_along(const Cell& cell, const Vec3& down) {
  const bool oblique = (down.array() != 0).count() > 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (cell.periodic[axis] && (oblique || down[static_cast<int>(axis)] != 0)) return true;
  return false;
}

}  // namespace

std::optional<UnusedSetting> missed_floor(const Scene& described, const World& world) {
  const SceneDescription& start = *described.description;
  const auto waits = [](const StageDescription& stage) { return waits_for_contacts(stage.until); };
  const auto walls = world.walls();
  const auto bodies = world.positions();
  const auto gravity = only_gravity(start);
  if (bodies.empty() || !gravity || gravity->isZero() || !std::ranges::any_of(start.stages, waits)) return std::nullopt;
  const Vec3 down = gravity->normalized();
  if (repeats_along(world.cell(), down) ||
      std::ranges::any_of(walls, [&](const WallView& wall) { return is_endless_floor(wall, down); }))
    return std::nullopt;
  const double length = length_of(world);
  constexpr std::size_t most_bodies = 50;
  for (std::size_t i = 0; i < bodies.size(); i += 1 + bodies.size() / most_bodies)
    if (meets_wall(world, bodies[i], down, length)) return std::nullopt;
  return UnusedSetting{"/engines", "gravity is (" + number(gravity->x()) + ", " + number(gravity->y()) + ", " +
                                       number(gravity->z()) +
                                       ") m/s^2, and no wall is on the way of the bodies that fall so, but a stage "
                                       "waits for them to rest; reverse gravity, or add a floor where it points to"};
}

}  // namespace grit
