#include "kernel/periodic_walls.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "format/number.hpp"
#include "kernel/failure.hpp"

namespace grit {
namespace {

/// Relative difference of lengths that count as equal.
constexpr double wall_rounding = 1e-6;

/// The box around a wall at its present pose; empty if it cannot be told for a wall that has turned.
std::optional<Bounds> bounds_now(const Geometry& geometry, const Pose& pose) {
  const Bounds at_start = geometry.bounds();
  if (!pose.turned()) return Bounds{at_start.low + pose.shift, at_start.high + pose.shift};
  if (!at_start.low.allFinite() || !at_start.high.allFinite()) return std::nullopt;
  const Vec3 half = 0.5 * (at_start.high - at_start.low), reach = pose.turn.cwiseAbs() * half,
             middle = pose.to_world(at_start.low + half);
  return Bounds{middle - reach, middle + reach};
}

/// Whether the wall lies outside the domain, where no body is.
bool is_out_of_reach(const Bounds& wall, const Cell& cell, double reach) {
  for (int k = 0; k < 3; ++k)
    if (wall.high[k] < cell.low[k] - reach || wall.low[k] > cell.high[k] + reach) return true;
  return false;
}

/// Distance from its centre at which the largest body acts [m].
double reach_of_largest(const State& state) {
  return state.statistics.largest_radius + NeighbourLists::largest_reach(state.reaches());
}

/// The largest overlap of a sphere with a wall.
double overlap_at(const Geometry& geometry, const Pose& pose, const Vec3& centre, double radius) {
  const Sphere sphere{centre, radius, 0};
  std::vector<SurfaceContact> contacts;
  geometry.find_contacts(pose, {&sphere, 1}, contacts);
  double largest = 0;
  for (const SurfaceContact& contact : contacts) largest = std::max(largest, contact.overlap);
  return largest;
}

/// Whether a wall is the same all along an axis, as the grooves that run along it are: judged by spheres on a grid.
bool is_uniform_along(int axis, const Geometry& geometry, const Pose& pose, const Bounds& bounds, double radius) {
  if (geometry.flat()) return true;
  constexpr int grid = 12, along = 4;
  const int one = (axis + 1) % 3, other = (axis + 2) % 3;
  const Vec3 size = bounds.high - bounds.low;
  // An irrational part of the length, so that the places are not all alike in a pattern that repeats.
  constexpr double step = 0.1618033988749895;
  for (int i = 0; i < grid; ++i)
    for (int j = 0; j < grid; ++j) {
      Vec3 place;
      place[one] = bounds.low[one] + (i + 0.5) / grid * size[one];
      place[other] = bounds.low[other] + (j + 0.5) / grid * size[other];
      double first = 0;
      for (int k = 0; k < along; ++k) {
        place[axis] = bounds.low[axis] + (0.25 + k * step) * size[axis];
        const double overlap = overlap_at(geometry, pose, place, radius);
        if (k == 0) first = overlap;
        else if (std::abs(overlap - first) > wall_rounding * radius) return false;
      }
    }
  return true;
}

[[noreturn]] void fail_not_uniform(const State& state, std::size_t wall, int axis) {
  const std::string name(1, "xyz"[axis]);
  fail(state, Guard::period, {"walls", state.walls.name(wall)},
       "wall \"" + state.walls.name(wall) + "\" is one period long along " + name +
           ", where it is periodic, but its surface changes along " + name,
       "only plane walls, and grooves that run along the axis, go on at periodic sides: extend the wall beyond both "
       "sides by at "
       "least the largest radius, " +
           number(state.statistics.largest_radius) + " m, and by the distance that it will move");
}

[[noreturn]] void fail_at_end(const State& state, std::size_t wall, int axis, double low, double high) {
  const Cell& cell = state.cell.cell();
  const std::string reach = number(reach_of_largest(state));
  fail(state, Guard::period, {"walls", state.walls.name(wall)},
       "wall \"" + state.walls.name(wall) + "\" extends from " + number(low) + " to " + number(high) + " m along " +
           "xyz"[axis] + " and so ends near a periodic side (" + number(cell.low[axis]) + " or " +
           number(cell.high[axis]) + " m)",
       "walls have no images: make it exactly one period long, extend it beyond both sides by at least the largest "
       "radius, " +
           reach + " m, or keep it as far from both");
}

}  // namespace

void repeat_walls(State& state) {
  const Cell& cell = state.cell.cell();
  const double reach = (1 - wall_rounding) * reach_of_largest(state);
  for (WallSurface& surface : state.surfaces) surface.period.setZero();
  if (!cell.periodic_anywhere() || state.bodies.count() == 0) return;
  for (std::size_t w = 0; w < state.walls.size(); ++w) {
    const Pose& pose = state.walls.pose(w);
    const std::optional<Bounds> bounds = bounds_now(state.walls.geometry(w), pose);
    if (!bounds || is_out_of_reach(*bounds, cell, reach)) continue;
    for (int k = 0; k < 3; ++k) {
      if (!cell.periodic[static_cast<std::size_t>(k)]) continue;
      const double low = bounds->low[k], high = bounds->high[k], from = cell.low[k], to = cell.high[k];
      const double period = to - from;
      const bool inside = low > from + reach && high < to - reach, across = low <= from - reach && high >= to + reach;
      const bool keeps_axis =
          (pose.turn * Vec3::Unit(k) - Vec3::Unit(k)).norm() <= wall_rounding;  // such as a drum along it
      if (keeps_axis && std::abs(high - low - period) <= wall_rounding * period) {
        const Geometry* geometry = &state.walls.geometry(w);
        const Geometry*& uniform = state.surfaces[w].uniform[static_cast<std::size_t>(k)];
        if (uniform != geometry && !is_uniform_along(k, *geometry, pose, *bounds, state.statistics.largest_radius))
          fail_not_uniform(state, w, k);
        uniform = geometry;
        state.surfaces[w].period[k] = period;
      } else if (!inside && !across) fail_at_end(state, w, k, low, high);
    }
  }
}

}  // namespace grit
