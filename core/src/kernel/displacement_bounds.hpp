// Upper bounds of the displacements of bodies and walls in one step.
#pragma once

#include "kernel/passes.hpp"
#include "kernel/state.hpp"
#include "kernel/wall_speeds.hpp"

namespace grit {

/// Bounds for the skins, the travel guard and the time step.
class DisplacementBounds {
 public:
  double wall_speed() const { return wall_speed_; }
  /// The same along the normals of the walls.
  double wall_closing_speed() const { return wall_closing_; }
  /// Maximum approach of two surfaces in the last step [m].
  double last_approach() const { return last_approach_; }
  /// The same as a speed [m/s].
  double closing_speed(double previous_dt) const { return previous_dt > 0 ? last_approach_ / previous_dt : 0; }

  /// Upper bound of the rate at which bodies and walls move, relative to a body's radius [1/s].
  double displacement_rate() const { return rate_; }

  /// After a neighbour search, or one at walls only.
  void rebuild(const State& state, Passes& passes) {
    walls_.rebuild(state, state.lists.furthest(passes), passes.ranks());
  }
  /// After a change of walls or of their motions.
  void reset_walls(std::size_t walls) { walls_.reset(walls); }
  /// Takes into account how fast bodies are, and how fast walls will be. The rate is exact where it matters in a step
  /// of `dt` [s].
  void foresee(const State& state, double dt, Passes& passes);
  /// Throws NumericsError if a body or wall moves too far in a step of `dt` [s], as foreseen.
  void check_foreseen(State& state, double dt, Passes& passes);
  /// Radii grew by up to `distance` [m] in this step.
  void grown(double distance) { grown_ = distance; }
  /// After bodies and walls have moved by one step. Throws NumericsError if a wall or body moved too far.
  void advance(State& state, Passes& passes);

  void check_restored(std::size_t walls) const { walls_.check_restored(walls); }
  void serialize(Archive& archive) { archive(walls_, wall_speed_, wall_closing_, last_approach_, grown_, rate_); }

 private:
  void advance_walls(State& state, double gone, Passes& passes);
  /// The approach of a wall: an upper bound, or exact where it matters in a step of `dt` [s].
  Approach approach_of(const State& state, std::size_t wall, const WallMotion& motion, double gone, double dt,
                       Passes& passes);

  WallSpeeds walls_;
  double wall_speed_ = 0, wall_closing_ = 0;  // m/s, in the last step
  double last_approach_ = 0, grown_ = 0;      // m
  double rate_ = 0;                           // 1/s
};

}  // namespace grit
