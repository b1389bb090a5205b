// From forces to positions: one pass over the bodies damps and integrates.
#pragma once

#include "bodies/bodies.hpp"
#include "contact/search.hpp"
#include "grit/contact/batch.hpp"
#include "grit/engine.hpp"

namespace grit {

/// One step of the leap-frog.
struct MotionStep {
  MotionSettings settings;
  double kick;         ///< s: from the last mid-step to the next, the time over which forces act
  double drift;        ///< s: the step
  double flowed;       ///< s: the step before, in which bodies went with the mean flow
  Vec3 strain_rate;    ///< of a deforming cell [1/s]: damping and travel refer to its mean flow
  Vec3 centre;         ///< where that flow is zero [m]
  Vec3 period;         ///< of the cell after the step [m], 0 along axes that are not periodic
  Vec3 period_growth;  ///< m/s
  bool energies;       ///< whether Motion's are asked for

  bool flows() const { return !strain_rate.isZero(0.0); }
  /// 1 along axes along, or about, which bodies are free to move, 0 along others.
  Vec3 free_translation() const;
  Vec3 free_rotation() const;
};

/// What a chunk's bodies did.
struct Motion {
  double largest_speed = 0;  ///< upper bound of the speeds against the mean flow, m/s
  bool finite = true;        ///< no velocity is inf or NaN
  double damped = 0;         ///< what local damping took away [J]
  double fallen = 0;         ///< work of gravity [J]
  double carried = 0;        ///< work of what has bodies go with the mean flow of a deforming cell [J]
};

/// Moves the bodies of one chunk under `sum`, by index; those of clumps are where these have moved them.
Motion move_bodies(std::size_t chunk, Bodies& bodies, const BodySum* sum, const MotionStep& step);

}  // namespace grit
