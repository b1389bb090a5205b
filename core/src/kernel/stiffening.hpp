// The overlap for which the time step is set where springs stiffen with overlap, as Hertz's do.
#pragma once

#include "kernel/displacement_bounds.hpp"
#include "kernel/state.hpp"

namespace grit {

/// The time step is set for the overlap that springs will reach: the largest now, or that of the fastest impact.
class Stiffening {
 public:
  /// Finds up to which overlap springs are linear; after settings or bodies have changed.
  void update(const State& state);
  /// Whether springs stiffen at all.
  bool is_there() const;
  /// Whether contacts at this overlap, over a radius, or impacts at the present speeds, are so much stiffer than what
  /// the time step was set for that it must be set again.
  bool exceeds(double overlap, const State& state, const DisplacementBounds& bounds) const;
  /// The same for the overlap that the next evaluation may find. Asked before each evaluation, whoever needs it, so
  /// that the time step does not depend on who does.
  bool may_exceed(const State& state, const DisplacementBounds& bounds) const;
  /// Sets the overlap to expect.
  void expect(const State& state, const DisplacementBounds& bounds);
  /// Largest overlap over a radius that is expected; 0 where springs do not stiffen.
  double expected_overlap() const { return is_there() ? expected_ : 0; }

  void remember(Memory& memory) { memory(linear_until_, pressed_, expected_, expected_speed_); }

 private:
  double linear_until_ = 0;  // overlap over a radius; infinite where springs do not stiffen
  double pressed_ = 0;       // the largest overlap when the time step was set, or linear_until_
  double expected_ = 0;
  double expected_speed_ = 0;  // closing speed above which the time step must be set again [m/s]
};

}  // namespace grit
