#include "kernel/wall_speeds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace grit {
namespace {

/// Distances from an axis and positions along it.
struct AxialRange {
  Vec3 origin, axis;
  double from = 0, to = 0;  // along the axis [m]
  double radius = 0;        // m

  double along(const Vec3& point) const { return axis.dot(point - origin); }
  double away(const Vec3& point) const { return axis.cross(point - origin).norm(); }
};

/// The volume that a wall sweeps when it rotates about `axis` through its reference point.
AxialRange swept(const State& state, std::size_t wall, const Vec3& axis) {
  const Pose& pose = state.walls.pose(wall);
  const Bounds bounds = state.walls.geometry(wall).bounds();
  AxialRange range{state.walls.reference(wall), axis};
  if (!bounds.low.allFinite() || !bounds.high.allFinite()) {
    range.from = -std::numeric_limits<double>::infinity();
    range.to = range.radius = std::numeric_limits<double>::infinity();
    return range;
  }
  range.from = std::numeric_limits<double>::infinity(), range.to = -range.from;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 local;
    for (int k = 0; k < 3; ++k) local[k] = (corner >> k & 1 ? bounds.high : bounds.low)[k];
    const Vec3 place = pose.to_world(local);
    range.from = std::min(range.from, range.along(place)), range.to = std::max(range.to, range.along(place));
    range.radius = std::max(range.radius, range.away(place));
  }
  return range;
}

/// Largest distance from the axis at which the wall may touch a body before candidates are found again, if bodies were
/// at rest [m]. `gone`: as in WallSpeeds::speed().
double arm(const State& state, std::size_t wall, const Vec3& axis, double gone, Ranks& ranks) {
  const AxialRange range = swept(state, wall, axis);
  const Skins& skins = state.lists.skins();
  // Bodies may move back, and by their skins in the other direction. Skins are exceeded by less than one step.
  const double moves = skins.largest() + gone + skins.of_walls() + skins.reach() +
                       2 * state.settings.guards.travel * state.statistics.largest_radius;
  double longest = 0;
  const std::size_t first = ChunkRange(ranks.first(), state.bodies.count()).first,
                    last = ChunkRange(ranks.last(), state.bodies.count()).first;
  for (std::size_t i = first; i < last; ++i) {
    if (!state.surfaces[wall].acts_on(state.group, i)) continue;
    const Vec3 place = xyz(state.bodies.position[i]);
    const double radius = state.bodies.position[i].w, reach = radius + moves, along = range.along(place),
                 away = range.away(place);
    if (away > range.radius + reach || along < range.from - reach || along > range.to + reach) continue;
    longest = std::max(longest, away + radius);
  }
  for (const double of_rank : ranks.each(longest)) longest = std::max(longest, of_rank);
  return std::min(longest, range.radius);
}

}  // namespace

void WallSpeeds::rebuild(const State& state, double gone, Ranks& ranks) {
  for (std::size_t w = 0; w < state.walls.size(); ++w) {
    arms_[w] = {};  // bodies have moved
    const Vec3& spin = state.walls.states()[w].spin;
    if (!spin.isZero(0.0)) turning(state, w, spin, gone, ranks);
  }
}

double WallSpeeds::turning(const State& state, std::size_t wall, const Vec3& spin, double gone, Ranks& ranks) {
  if (spin.isZero(0.0)) return 0;
  const Vec3 axis = spin.normalized();
  Arm& known = arms_[wall];
  constexpr double rounding = 1e-12;
  if (known.axis.cross(axis).norm() > rounding || known.axis.isZero(0.0))
    known = {axis, arm(state, wall, axis, gone, ranks) + gone};
  return spin.norm() * (known.length + gone + state.lists.strain_travel() + state.lists.skins().walls_gone());
}

double WallSpeeds::speed(const State& state, std::size_t wall, const WallMotion& motion, double gone, Ranks& ranks) {
  return motion.velocity.norm() + turning(state, wall, motion.spin, gone, ranks);
}

double WallSpeeds::normal_speed(const State& state, std::size_t wall, const WallMotion& motion, double gone,
                                Ranks& ranks) {
  const Geometry& geometry = state.walls.geometry(wall);
  const Vec3 normal = state.walls.pose(wall).turn * geometry.normal();
  const double all = turning(state, wall, motion.spin, gone, ranks);
  if (!geometry.flat() || normal.isZero()) return motion.velocity.norm() + all;
  const double spin = motion.spin.norm();
  return std::abs(motion.velocity.dot(normal)) + (spin > 0 ? all * motion.spin.cross(normal).norm() / spin : 0);
}

Approach approach(const State& state, std::size_t wall, const WallMotion& motion, double dt, Passes& passes) {
  const Skins& skins = state.lists.skins();
  // Also after half a step, as a groove may have passed a body after a whole one.
  std::array<WallSurface, 3> surfaces;
  constexpr std::array<double, 3> parts{0, 0.5, 1};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    surfaces[k] = state.surfaces[wall];
    surfaces[k].pose = moved(state.walls.pose(wall), motion, parts[k] * dt);
  }
  const auto found = passes.of_chunks([&](std::size_t chunk) {
    Approach fastest_here;
    const double near = skins.at_walls(chunk) + skins.of_walls();
    std::map<std::uint32_t, std::array<double, parts.size()>> deepest;  // by body [m]
    for (std::size_t k = 0; k < parts.size(); ++k)
      state.wall_contacts.each_near(chunk, state.bodies, surfaces[k], wall, near, [&](const SurfaceContact& contact) {
        double& overlap = deepest[contact.body][k];
        overlap = std::max(overlap, contact.overlap);
      });
    for (const auto& [body, overlaps] : deepest) {
      const double speed = std::max(2 * (overlaps[1] - overlaps[0]), overlaps[2] - overlaps[0]) / dt;
      fastest_here.speed = std::max(fastest_here.speed, speed);
      fastest_here.rate = std::max(fastest_here.rate, speed / state.bodies.position[body].w);
    }
    return fastest_here;
  });
  Approach fastest;
  for (const Approach& one : found) fastest = {std::max(fastest.speed, one.speed), std::max(fastest.rate, one.rate)};
  return fastest;
}

}  // namespace grit
