// The overlap for which the time step is set if stiffness grows with overlap, as for Hertzian springs.
#pragma once

#include "kernel/displacement_bounds.hpp"
#include "kernel/state.hpp"

namespace grit {

/// The time step is set for the expected overlap: the present maximum, or that of the fastest impact.
class Stiffening {
 public:
  /// Finds the overlap up to which springs are linear; call after a change of settings or bodies.
  void update(const State& state);
  /// Whether stiffness grows with overlap at all.
  bool is_there() const;
  /// Whether contacts at this overlap (over a radius), or impacts at the present speeds, are so much stiffer than
  /// expected that the time step must be set again.
  bool exceeds(double overlap, const State& state, const DisplacementBounds& bounds) const;
  /// The same for the overlap that the next evaluation may find. Called before every evaluation, so that the time step
  /// does not depend on the reason of the evaluation.
  bool may_exceed(const State& state, const DisplacementBounds& bounds) const;
  /// Sets the expected overlap.
  void expect(const State& state, const DisplacementBounds& bounds, Passes& passes);
  /// The least overlap over a radius at which a packing may need a shorter step; infinite if springs do not stiffen.
  double least_overlap() const;
  /// Expected maximum overlap over a radius; 0 if springs do not stiffen.
  double expected_overlap() const { return is_there() ? expected_ : 0; }

  void serialize(Archive& archive) { archive(linear_until_, expected_, expected_speed_); }

 private:
  double linear_until_ = 0;  // overlap over a radius; infinite if springs do not stiffen
  double expected_ = 0;
  double expected_speed_ = 0;  // closing speed above which the time step must be set again [m/s]
};

}  // namespace grit
