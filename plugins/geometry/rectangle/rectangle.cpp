// A flat rectangle in space. See README.md.
#include "rectangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "grit/plugin.hpp"

namespace grit {

namespace {
constexpr double square_enough = 1e-6;  // cosine between the edges: room for decimals written by hand
}

/// Where the rectangle has moved to.
struct Rectangle::Frame {
  Vec3 corner, along_a, along_b, normal;
  double length_a, length_b;

  /// From the closest point of the sheet to `centre`, along a, b and the normal. Above the face the first two are
  /// exactly 0.
  Vec3 offset(const Vec3& centre) const {
    const Vec3 from_corner = centre - corner;
    const double a = along_a.dot(from_corner), b = along_b.dot(from_corner);
    return {a - std::clamp(a, 0.0, length_a), b - std::clamp(b, 0.0, length_b), normal.dot(from_corner)};
  }
};

Rectangle::Frame Rectangle::frame(const Pose& pose) const {
  return {pose.to_world(corner_),
          (pose.turn * along_a_).normalized(),
          (pose.turn * along_b_).normalized(),
          (pose.turn * normal_).normalized(),
          length_a_,
          length_b_};
}

void Rectangle::declare(Parameters& p) {
  p.add("corner", corner_).unit("m").required().doc("the corner where both edges start");
  p.add("edge_a", edge_a_).unit("m").required().doc("first edge, from the corner");
  p.add("edge_b", edge_b_)
      .unit("m")
      .required()
      .doc("second edge, perpendicular to the first; a × b points to the bodies");
  p.add("two_sided", two_sided_)
      .doc("whether bodies may be on either side; if not, a centre up to one radius behind the face is pushed back");
  p.check([this](const Complain& complain) {
    const double a = edge_a_.norm(), b = edge_b_.norm();
    if (!(a > 0)) complain("edge_a", "a vector of length 0", "a vector that has a direction");
    if (!(b > 0)) complain("edge_b", "a vector of length 0", "a vector that has a direction");
    if (!(a > 0 && b > 0)) return;
    const double cosine = edge_a_.dot(edge_b_) / (a * b);
    if (std::abs(cosine) > square_enough)
      complain("edge_b", "an edge whose angle to edge_a has the cosine " + std::to_string(cosine),
               "an edge perpendicular to edge_a");
  });
}

void Rectangle::prepare() {
  length_a_ = edge_a_.norm();
  along_a_ = edge_a_ / length_a_;
  edge_b_ -= along_a_.dot(edge_b_) * along_a_;
  length_b_ = edge_b_.norm();
  along_b_ = edge_b_ / length_b_;
  normal_ = along_a_.cross(along_b_).normalized();
}

Bounds Rectangle::bounds() const {
  const Vec3 b = corner_ + edge_a_, c = b + edge_b_, d = corner_ + edge_b_;
  return {corner_.cwiseMin(b).cwiseMin(c).cwiseMin(d), corner_.cwiseMax(b).cwiseMax(c).cwiseMax(d)};
}

void Rectangle::touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const {
  const Frame at = frame(pose);
  for (const Sphere& sphere : spheres) {
    const Vec3 offset = at.offset(sphere.centre);
    if (!(offset.squaredNorm() < sphere.radius * sphere.radius)) continue;
    if (offset.x() == 0 && offset.y() == 0) {
      const double side = two_sided_ && offset.z() < 0 ? -1 : 1;
      touches.push_back({-side * at.normal, sphere.radius - side * offset.z(), sphere.body, 0});
    } else {
      const Vec3 away = offset.x() * at.along_a + offset.y() * at.along_b + offset.z() * at.normal;
      touches.push_back({-away.normalized(), sphere.radius - offset.norm(), sphere.body, 0});
    }
  }
}

bool Rectangle::near(const Pose& pose, const Vec3& centre, double reach) const {
  return frame(pose).offset(centre).squaredNorm() <= reach * reach;
}

std::vector<Vec3> Rectangle::triangles() const {
  const Vec3 b = corner_ + edge_a_, c = b + edge_b_, d = corner_ + edge_b_;
  return {corner_, b, c, corner_, c, d};
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "rectangle",
                                     .version = "1.0.0",
                                     .doc = "flat rectangle with face, edges and corners",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Rectangle; }};
  return &info;
}
