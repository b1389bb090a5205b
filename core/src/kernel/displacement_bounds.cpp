#include "kernel/displacement_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "format/number.hpp"
#include "kernel/failure.hpp"

namespace grit {
namespace {

/// Distance of the furthest surface of a body from `place` [m].
double furthest_from(const Vec3& place, const State& state) {
  double furthest = 0;
  for (std::size_t i = 0; i < state.bodies.count(); ++i)
    furthest = std::max(furthest, (xyz(state.bodies.position[i]) - place).norm());
  return furthest + state.statistics.largest_radius;
}

}  // namespace

void DisplacementBounds::rebuild(const State& state) {
  for (std::size_t w = 0; w < state.walls.size(); ++w)
    arms_[w] = state.walls.states()[w].spin.isZero(0.0) ? unknown : furthest_from(state.walls.reference(w), state);
}

void DisplacementBounds::advance(State& state, const Passes& passes) {
  const double dt = state.time.previous_dt;
  const double strained = dt * state.cell.cell().strain_rate.cwiseAbs().maxCoeff() * 2 *
                              (state.statistics.largest_radius + state.lists.skins().largest()) +
                          2 * grown_;
  const double furthest = state.lists.advance(dt, strained, passes);
  advance_walls(state, furthest);
  double fastest = 0;
  bool finite = true;
  for (const ChunkResult& chunk : passes.chunks())
    fastest = std::max(fastest, chunk.motion.largest_speed), finite = finite && chunk.motion.finite;
  last_approach_ = dt * std::max(2 * fastest, fastest + wall_closing_) + strained;
  if (!finite || dt * fastest > state.settings.guards.travel * state.statistics.smallest_radius) check_bodies(state);
}

void DisplacementBounds::advance_walls(State& state, double furthest) {
  const double dt = state.time.previous_dt, travel = state.settings.guards.travel,
               smallest = state.statistics.smallest_radius;
  double wall_speed = 0, wall_closing = 0;
  for (std::size_t w = 0; w < state.walls.size(); ++w) {
    const WallState& wall = state.walls.states()[w];
    double turning = 0;
    if (!wall.spin.isZero(0.0)) {
      if (arms_[w] == unknown) arms_[w] = furthest_from(state.walls.reference(w), state);
      turning =
          wall.spin.norm() * (arms_[w] + furthest + state.lists.strain_travel() + state.lists.skins().walls_gone());
    }
    const double speed = wall.velocity.norm() + turning;
    // A flat wall may move in its own plane at any speed.
    const Vec3 normal = wall.pose.turn * state.walls.geometry(w).normal();
    const double closing = (normal.isZero() ? wall.velocity.norm() : std::abs(wall.velocity.dot(normal))) + turning;
    if (!(dt * closing <= travel * smallest) && state.bodies.count() > 0)
      fail(state, Guard::travel, {"walls", state.walls.name(w), "motion"},
           "wall \"" + state.walls.name(w) + "\" moves " + number(dt * closing / smallest) +
               " of the smallest radius in one step, more than /guards/travel " + number(travel),
           "a wall this fast passes through bodies; reduce its velocity, increase the mass of a free wall, or "
           "reduce the time step");
    wall_speed = std::max(wall_speed, speed), wall_closing = std::max(wall_closing, closing);
  }
  wall_speed_ = wall_speed, wall_closing_ = wall_closing;
  state.lists.advance_walls(dt * wall_speed);
}

void DisplacementBounds::check_bodies(const State& state) const {
  const double dt = state.time.previous_dt, most = state.settings.guards.travel;
  for (std::size_t i = 0; i < state.bodies.count(); ++i) {
    const Vec3 v = xyz(state.bodies.velocity[i]), w = xyz(state.bodies.spin[i]);
    if (!v.allFinite() || !w.allFinite())
      fail_at_body(state, Guard::finite, group_keys(state, i), i, "has a velocity that is not a number",
                   "two bodies may have started at the same point, or the time step is too large");
    const double travel = dt * (v - state.cell.mean_flow(xyz(state.bodies.position[i]))).norm();
    const double radius = state.bodies.position[i].w;
    if (travel > most * radius)
      fail_at_body(
          state, Guard::travel, group_keys(state, i), i,
          "moves " + number(travel / radius) + " of its radius in one step, more than /guards/travel " + number(most),
          "bodies may overlap too much at the start, a wall may be too fast, or the time step too large");
  }
}

}  // namespace grit
