// Whether a servo can turn a pressure into a force: area and normal of its wall.
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

/// Whether walls or the domain bound the specimen on all four sides across the axis. Only the run detects a wall of the
/// specimen without a bound there, or a cross-section that is empty.
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
  return "found a servo on the cross-section of the specimen, which is open or empty; allowed is a cross-section "
         "bounded by walls of /specimen or by the domain, across " +
         axis;
}

/// Why a servo cannot keep a pressure on a wall whose present normal is `normal`; "" if it can.
inline std::string presses_with_nothing(const MotionDescription& motion, const Geometry& geometry, const Vec3& normal) {
  constexpr double perpendicular = 1e-6;
  if (!presses_on_specimen(motion) && !(geometry.area() > 0))
    return "found a servo pressure on a geometry without an area; allowed is a geometry with an area (a rectangle, "
           "or its parameter area), or a force instead of the pressure";
  if (normal.isZero(0.0))
    return "found a servo pressure on a geometry without a mean normal; allowed is a flat or grooved geometry, or a "
           "force instead of the pressure";
  const std::string& axis = motion.servo->axis;
  if (std::abs(normal[axis.front() - 'x']) < perpendicular)
    return "found a servo pressure along " + axis +
           ", perpendicular to the normal of the wall; allowed is an axis along which the normal has a component, or "
           "a force instead of the pressure";
  return "";
}

}  // namespace grit
