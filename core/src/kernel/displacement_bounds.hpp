// Upper bounds of the displacements of bodies and walls in one step.
#pragma once

#include <vector>

#include "kernel/passes.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Bounds for the skins, the travel guard and the time step.
class DisplacementBounds {
 public:
  double wall_speed() const { return wall_speed_; }
  /// The same, but for flat walls only along their normals.
  double wall_closing_speed() const { return wall_closing_; }
  /// Maximum approach of two surfaces in the last step [m].
  double last_approach() const { return last_approach_; }
  /// The same as a speed [m/s].
  double closing_speed(double previous_dt) const { return previous_dt > 0 ? last_approach_ / previous_dt : 0; }

  /// After a rebuild: distances of bodies from the axes of walls that spin.
  void rebuild(const State& state);
  /// The number or kind of walls may have changed.
  void resize_walls(std::size_t walls) { arms_.resize(walls, unknown); }
  /// Radii grew by up to `distance` [m] in this step.
  void grown(double distance) { grown_ = distance; }
  /// After bodies and walls have moved by one step. Throws NumericsError if a wall or body moved too far.
  void advance(State& state, const Passes& passes);

  void serialize(Archive& archive) { archive(arms_, wall_speed_, wall_closing_, last_approach_, grown_); }

 private:
  static constexpr double unknown = -1;

  void advance_walls(State& state, double furthest);
  void check_bodies(const State& state) const;

  std::vector<double> arms_;  // by wall: distance of the furthest body from its reference point, if it spins [m]
  double wall_speed_ = 0, wall_closing_ = 0;  // m/s, in the last step
  double last_approach_ = 0, grown_ = 0;      // m
};

}  // namespace grit
