// An infinite plane. See README.md.
#include "plane.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "grit/plugin.hpp"

namespace grit {

void Plane::declare(Parameters& p) {
  p.add("point", point_).unit("m").doc("any point of the plane");
  p.add("normal", normal_).doc("normal towards the bodies; any length above 0");
  p.add("area", area_)
      .unit("m^2")
      .symbol("A")
      .at_least(0)
      .doc("area for pressures; 0: none, and no servo for pressure");
  p.add("extent", extent_)
      .unit("m")
      .above(0)
      .doc("side of the square drawn in pictures; default: that of the area, else the extent of the scene");
  p.check([this](const Complain& complain) {
    if (!(normal_.norm() > 0)) complain("normal", "a vector of length 0", "a vector of non-zero length");
  });
}

Bounds Plane::bounds() const {
  const Vec3 infinite = Vec3::Constant(std::numeric_limits<double>::infinity());
  Bounds bounds{-infinite, infinite};
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(normal_[axis]) == 1) bounds.low[axis] = bounds.high[axis] = point_[axis];
  return bounds;
}

void Plane::find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                          std::vector<SurfaceContact>& contacts) const {
  const Vec3 point = pose.to_world(point_), normal = (pose.turn * normal_).normalized();
  for (const Sphere& sphere : spheres) {
    const double overlap = sphere.radius - normal.dot(sphere.centre - point);
    if (overlap > 0) contacts.push_back({-normal, overlap, sphere.body, 0});
  }
}

bool Plane::near(const Pose& pose, const Vec3& centre, double reach) const {
  return (pose.turn * normal_).normalized().dot(centre - pose.to_world(point_)) <= reach;
}

std::vector<Vec3> Plane::triangles() const {
  const double half = 0.5 * extent_.value_or(std::sqrt(area_));
  if (half == 0) return {};
  int least;  // axis closest to the plane; keeps squares on axis-aligned planes axis-aligned
  normal_.cwiseAbs().minCoeff(&least);
  const Vec3 axis = Vec3::Unit(least), u = half * (axis - normal_.dot(axis) * normal_).normalized(),
             v = normal_.cross(u);
  const Vec3 a = point_ - u - v, b = point_ + u - v, c = point_ + u + v, d = point_ - u + v;
  return {a, b, c, a, c, d};
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "plane",
                                     .version = "1.0.0",
                                     .doc = "infinite plane, solid behind",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Plane; }};
  return &info;
}
