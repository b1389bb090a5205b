// What the servo of a wall presses with.
#pragma once

#include <cmath>
#include <string>

#include "scene/description.hpp"

namespace grit {

inline bool presses_on_specimen(const MotionDescription& motion) {
  return motion.servo && motion.servo->area == "specimen";
}

/// Why a servo that keeps a pressure cannot have one, on a wall whose normal is `normal` now; "" if it can.
inline std::string presses_with_nothing(const MotionDescription& motion, const Geometry& geometry, const Vec3& normal) {
  constexpr double aslant = 1e-6;
  if (!presses_on_specimen(motion) && !(geometry.area() > 0))
    return "found a servo's pressure on a geometry that has no area; allowed is one with an area (a rectangle, or area "
           "where the geometry takes it), or a force in place of the pressure";
  if (normal.isZero(0.0))
    return "found a servo's pressure on a geometry that has no normal of its own; allowed is one that is flat or "
           "grooved, or a force in place of the pressure";
  const std::string& axis = motion.servo->axis;
  if (std::abs(normal[axis.front() - 'x']) < aslant)
    return "found a servo's pressure along " + axis +
           ", to which the wall's normal is perpendicular; allowed is an axis that the normal has a part of, or a "
           "force in place of the pressure";
  return "";
}

}  // namespace grit
