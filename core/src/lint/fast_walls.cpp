#include "lint/fast_walls.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "description/current_scene.hpp"
#include "format/number.hpp"
#include "input/places.hpp"

namespace grit {
namespace {

/// Largest velocity of a wall's reference point, without servos: they are fast only where they meet no bodies [m/s].
Vec3 largest_velocity(const MotionDescription& motion, const Vec3& towards) {
  Vec3 velocity = motion.velocity;
  if (motion.oscillation) {
    const Vec3 swing = 2 * std::numbers::pi * motion.oscillation->frequency * motion.oscillation->amplitude;
    for (int k = 0; k < 3; ++k) velocity[k] += std::copysign(swing[k], towards[k]);
  }
  return velocity;
}

/// Distance of the furthest point of the bounds from the axis' point; 0 if they are infinite [m].
double arm(const Bounds& bounds, const std::optional<Vec3>& about) {
  const Vec3 size = bounds.high - bounds.low, centre = bounds.low + 0.5 * size;
  return size.allFinite() ? 0.5 * size.norm() + (about.value_or(centre) - centre).norm() : 0;
}

/// Speed at which the surface of a wall approaches bodies [m/s]. A plane face may move along itself at any speed.
double approach_speed(const MotionDescription& motion, const Geometry& geometry) {
  const Vec3 normal = geometry.normal();
  if (!geometry.flat() || normal.isZero()) return largest_velocity(motion, motion.velocity).norm();
  return std::max(largest_velocity(motion, normal).dot(normal), 0.0) +
         motion.spin.cross(normal).norm() * arm(geometry.bounds(), motion.about);
}

}  // namespace

std::vector<UnusedSetting> fast_walls(const Scene& described,
                                      const std::map<std::string, std::shared_ptr<const Geometry>>& geometries,
                                      double smallest_radius) {
  std::vector<UnusedSetting> all;
  std::set<std::string> reported;
  through_stages(
      *described.description, described.stages, [&](const SceneDescription& now, std::optional<std::size_t> stage) {
        if (!stage || !now.time_step.value || !(smallest_radius > 0)) return true;
        const double dt = *now.time_step.value;
        for (const auto& [name, wall] : now.walls) {
          const auto geometry = geometries.find(name);
          if (geometry == geometries.end() || reported.contains(name)) continue;
          const double distance = dt * approach_speed(wall.motion, *geometry->second);
          if (!(distance > now.guards.travel * smallest_radius)) continue;
          reported.insert(name);
          all.push_back(
              {"/walls/" + pointer_token(name) + "/motion",
               fmt::format("in stage \"{}\" the wall moves by {} m in a time step of {} s, {} of the smallest "
                           "radius and more than /guards/travel {}: the run stops where it meets bodies; "
                           "reduce its speed or /time_step/value",
                           described.description->stages[*stage].name, number(distance), number(dt),
                           number(distance / smallest_radius), number(now.guards.travel))});
        }
        return true;
      });
  return all;
}

}  // namespace grit
