// Whether points and spheres are inside the regions of descriptions. Inline: random placement compiles it without
// contraction, so that a seed gives the same bodies on every machine.
#pragma once

#include "description/description.hpp"

namespace grit {

// ---- a point, inside or on the boundary

inline bool contains(const BoxRegion& region, const Vec3& point) {
  return (point.array() >= region.low.array()).all() && (point.array() <= region.high.array()).all();
}
inline bool contains(const SphereRegion& region, const Vec3& point) {
  return (point - region.centre).squaredNorm() <= region.radius * region.radius;
}
inline bool contains(const CylinderRegion& region, const Vec3& point) {
  const Vec3 axis = region.end - region.start, arm = point - region.start;
  const double along = arm.dot(axis) / axis.squaredNorm();
  return along >= 0 && along <= 1 && (arm - along * axis).squaredNorm() <= region.radius * region.radius;
}
inline bool contains(const HalfSpaceRegion& region, const Vec3& point) {
  return (point - region.point).dot(region.normal) <= 0;
}

// ---- a sphere as a whole

inline bool contains_sphere(const SphereRegion& region, const Vec3& centre, double radius) {
  return radius <= region.radius && (centre - region.centre).norm() <= region.radius - radius;
}
/// `endless`: spheres may cross the ends.
inline bool contains_sphere(const CylinderRegion& region, bool endless, const Vec3& centre, double radius) {
  const Vec3 way = region.end - region.start, arm = centre - region.start;
  const double length = way.norm();
  const Vec3 axis = way / length;
  const double along = arm.dot(axis);
  if (!endless && !(along >= radius && along <= length - radius)) return false;
  return radius <= region.radius && (arm - along * axis).norm() <= region.radius - radius;
}

}  // namespace grit
