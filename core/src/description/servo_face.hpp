// What the servo of a wall presses with.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "description/description.hpp"

namespace grit {

inline bool presses_on_specimen(const MotionDescription& motion) {
  return motion.servo && motion.servo->area == "specimen";
}

/// Whether walls or the domain bound the specimen on all four sides across the axis. That a wall which it names has no
/// end there, or that nothing lies between them, the run alone sees.
inline bool specimen_ends_across(const SceneDescription& scene, const std::string& axis) {
  const auto ends = [](const std::vector<std::string>& walls, const std::optional<Vec3>& bound, std::size_t k) {
    return (walls.size() == 3 && !walls[k].empty()) || (bound && std::isfinite((*bound)[static_cast<int>(k)]));
  };
  for (std::size_t k = 0; k < 3; ++k)
    if (k != static_cast<std::size_t>(axis.front() - 'x') &&
        !(ends(scene.specimen.low, scene.domain.low, k) && ends(scene.specimen.high, scene.domain.high, k)))
      return false;
  return true;
}

inline std::string lacks_cross_section(const std::string& axis) {
  return "found a servo that presses on the specimen's cross-section, which is open or empty; allowed is one "
         "between walls that /specimen names or bounds of the domain, across " +
         axis;
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
