#include "kernel/periodic_walls.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "format/number.hpp"
#include "kernel/failure.hpp"

namespace grit {
namespace {

/// Relative difference of lengths that count as equal.
constexpr double rounding = 1e-6;

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
  const double reach = (1 - rounding) * reach_of_largest(state);
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
      if (!pose.turned() && std::abs(high - low - period) <= rounding * period) state.surfaces[w].period[k] = period;
      else if (!inside && !across) fail_at_end(state, w, k, low, high);
    }
  }
}

}  // namespace grit
