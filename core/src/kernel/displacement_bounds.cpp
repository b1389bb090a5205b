#include "kernel/displacement_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "format/number.hpp"
#include "kernel/completion.hpp"
#include "kernel/failure.hpp"
#include "kernel/passed_bodies.hpp"

namespace grit {
namespace {

/// Displacement per step, over a radius, below which no bound needs to be exact.
double harmless(const State& state) {
  const Settings& settings = state.settings;
  return std::min(settings.guards.travel, max_displacement(settings.time_step, settings.guards));
}

Vec3 own_velocity(const State& state, std::size_t body) {
  return xyz(state.bodies.velocity[body]) - state.cell.mean_flow(xyz(state.bodies.position[body]));
}

/// The largest speed over a body's own radius, relative to the mean flow [1/s]; infinite for a speed that is not
/// finite.
double rate_of_bodies(const State& state, Passes& passes) {
  const auto rates = passes.of_chunks([&](std::size_t chunk) {
    const ChunkRange range(chunk, state.bodies.count());
    double largest = 0;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const double rate = own_velocity(state, i).norm() / state.bodies.position[i].w;
      if (!(rate <= largest)) largest = std::isfinite(rate) ? rate : std::numeric_limits<double>::infinity();
    }
    return largest;
  });
  return rates.empty() ? 0 : *std::ranges::max_element(rates);
}

/// Throws for the first body that moves too far in a step of `dt` [s], or whose velocity is not finite.
void check_bodies(const State& state, double dt) {
  const double most = state.settings.guards.travel;
  for (std::size_t i = 0; i < state.bodies.count(); ++i) {
    const Vec3 v = xyz(state.bodies.velocity[i]), w = xyz(state.bodies.spin[i]);
    if (!v.allFinite() || !w.allFinite())
      fail_at_body(state, Guard::finite, group_keys(state, i), i, "has a velocity that is not a number",
                   "two bodies may have started at the same point, or the time step is too large");
    const double travel = dt * own_velocity(state, i).norm(), radius = state.bodies.position[i].w;
    if (travel > most * radius)
      fail_at_body(
          state, Guard::travel, group_keys(state, i), i,
          "moves " + number(travel / radius) + " of its radius in one step, more than /guards/travel " + number(most),
          "bodies may overlap too much at the start, a wall may be too fast, or the time step too large");
  }
}

/// Throws if a wall approaches a body by more than a step allows; `travel`: in one step, over the radius.
void check_wall(const State& state, std::size_t wall, double travel) {
  const double most = state.settings.guards.travel;
  if (travel <= most) return;
  fail(state, Guard::travel, {"walls", state.walls.name(wall), "motion"},
       "wall \"" + state.walls.name(wall) + "\" moves " + number(travel) +
           " of a radius towards a body in one step, more than /guards/travel " + number(most),
       "a wall this fast passes through bodies; reduce its velocity, increase the mass of a free wall, or reduce "
       "the time step");
}

}  // namespace

void DisplacementBounds::foresee(const State& state, double dt, Passes& passes) {
  rate_ = rate_of_bodies(state, passes);
  const double gone = state.lists.furthest(passes);
  for (std::size_t w = 0; w < state.walls.size(); ++w)
    rate_ = std::max(rate_, approach_of(state, w, state.walls.expected_motion(w), gone, dt, passes).rate);
}

void DisplacementBounds::check_foreseen(State& state, double dt, Passes& passes) {
  if (dt * rate_ <= state.settings.guards.travel) return;
  complete_bodies(state, passes);
  check_bodies(state, dt);
  const double gone = state.lists.furthest(passes);
  for (std::size_t w = 0; w < state.walls.size(); ++w)
    check_wall(state, w, dt * approach_of(state, w, state.walls.expected_motion(w), gone, dt, passes).rate);
}

void DisplacementBounds::advance(State& state, Passes& passes) {
  const double dt = state.time.previous_dt;
  const double strained =
      dt * state.cell.largest_rate() * 2 *
          (state.statistics.largest_radius + state.lists.skins().largest() + 0.5 * state.lists.skins().reach()) +
      2 * grown_;
  state.lists.advance(dt, strained, passes);
  const auto [overlap, fastest, gone, finite] = passes.extremes();
  rate_ = state.bodies.count() > 0 ? fastest / state.statistics.smallest_radius : 0;
  if (!finite || dt * rate_ > harmless(state)) {
    fetch_bodies(state, passes);
    rate_ = rate_of_bodies(state, passes);
  }
  const double rate_of_bodies_alone = rate_;
  advance_walls(state, gone, passes);
  if (!finite || dt * rate_of_bodies_alone > state.settings.guards.travel) {
    complete_bodies(state, passes);
    check_bodies(state, dt);
  }
  last_approach_ = dt * std::max(2 * fastest, fastest + wall_closing_) + strained;
}

void DisplacementBounds::advance_walls(State& state, double gone, Passes& passes) {
  const double dt = state.time.previous_dt;
  wall_speed_ = wall_closing_ = 0;
  for (std::size_t w = 0; w < state.walls.size(); ++w) {
    const WallMotion motion = state.walls.motion(w);
    const Approach found = approach_of(state, w, motion, gone, dt, passes);
    check_wall(state, w, dt * found.rate);
    wall_speed_ = std::max(wall_speed_, walls_.speed(state, w, motion, gone, passes.ranks()));
    wall_closing_ = std::max(wall_closing_, found.speed), rate_ = std::max(rate_, found.rate);
  }
  state.lists.advance_walls(dt * wall_speed_);
}

Approach DisplacementBounds::approach_of(const State& state, std::size_t wall, const WallMotion& motion, double gone,
                                         double dt, Passes& passes) {
  const double bound = walls_.normal_speed(state, wall, motion, gone, passes.ranks());
  if (state.bodies.count() == 0) return {bound, 0};
  const double smallest = state.statistics.smallest_radius;
  if (dt * bound <= harmless(state) * smallest) return {bound, bound / smallest};
  if (dt * bound > smallest && passes_bodies(state, wall, motion, dt, dt * bound, passes))
    return {bound, bound / smallest};
  return approach(state, wall, motion, dt, passes);
}

}  // namespace grit
