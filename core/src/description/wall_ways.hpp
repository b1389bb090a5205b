// Directions in which a wall may move.
#pragma once

#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "description/description.hpp"

namespace grit {

inline bool stands_still(const MotionDescription& motion) {
  return motion.velocity.isZero(0.0) && motion.spin.isZero(0.0) && !motion.oscillation && !motion.servo &&
         !motion.follow && !motion.free && !motion.free_rotation && !motion.surface_moves();
}

/// Whether the normals of a wall may change.
inline bool turns(const MotionDescription& motion) {
  return !motion.spin.isZero(0.0) || motion.free_rotation ||
         (motion.oscillation && !motion.oscillation->angle.isZero(0.0));
}

/// Whether a wall's reference point may move in the positive and negative direction of an axis, and how fast.
struct Ways {
  bool along = false, against = false;
  double speed = 0;  ///< at most [m/s]; infinite if only the run knows
  bool none() const { return !along && !against; }
};

/// Requires that walls do not follow each other in a cycle.
inline Ways ways(const std::map<std::string, WallDescription>& walls, const std::string& name, char axis) {
  const MotionDescription& motion = walls.at(name).motion;
  const auto has = [axis](const std::string& axes) { return axes.find(axis) != std::string::npos; };
  if (motion.follow && has(motion.follow->axes)) return ways(walls, motion.follow->wall, axis);
  const bool swings = motion.oscillation && motion.oscillation->amplitude[axis - 'x'] != 0;
  const bool both = swings || (motion.servo && has(motion.servo->axis)) || (motion.free && has(motion.free->axes));
  const double velocity = motion.velocity[axis - 'x'];
  return {both || velocity > 0, both || velocity < 0,
          both || turns(motion) ? std::numeric_limits<double>::infinity() : std::abs(velocity)};
}

}  // namespace grit
