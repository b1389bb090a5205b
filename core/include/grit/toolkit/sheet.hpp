// The base rectangle of flat and rough walls.
#pragma once

#include <cmath>
#include <string>

#include "grit/geometry.hpp"

namespace grit {

/// A corner and two perpendicular edges [m]; a × b points towards the bodies.
struct Sheet {
  /// Current position: the corner, and unit columns along a, along b and towards the bodies.
  struct Frame {
    Vec3 corner;
    Mat3 axes;
    /// Coordinates from the corner along the columns.
    Vec3 local(const Vec3& centre) const { return axes.transpose() * (centre - corner); }
  };

  Vec3 corner = Vec3::Zero(), edge_a = Vec3::UnitX(), edge_b = Vec3::UnitY();
  double length_a = 1, length_b = 1;  ///< m, after prepare()
  Mat3 axes = Mat3::Identity();       ///< as in a Frame, after prepare()

  void declare(Parameters& p) {
    p.add("corner", corner).unit("m").required().doc("corner at which both edges start");
    p.add("edge_a", edge_a).unit("m").required().doc("first edge, from the corner");
    p.add("edge_b", edge_b)
        .unit("m")
        .required()
        .doc("second edge, perpendicular to the first; a × b points towards the bodies");
    p.check([this](const Complain& complain) { check(complain); });
  }

  void prepare() {
    length_a = edge_a.norm();
    const Vec3 along_a = edge_a / length_a;
    edge_b -= along_a.dot(edge_b) * along_a;
    length_b = edge_b.norm();
    axes << along_a, edge_b / length_b, along_a.cross(edge_b).normalized();
  }

  Frame at(const Pose& pose) const { return {pose.to_world(corner), (pose.turn * axes).colwise().normalized()}; }

  Bounds bounds() const {
    const Vec3 b = corner + edge_a, c = b + edge_b, d = corner + edge_b;
    return {corner.cwiseMin(b).cwiseMin(c).cwiseMin(d), corner.cwiseMax(b).cwiseMax(c).cwiseMax(d)};
  }

 private:
  static constexpr double square_enough = 1e-6;  // cosine between the edges; allows for rounded decimals

  void check(const Complain& complain) const {
    const double a = edge_a.norm(), b = edge_b.norm();
    if (!(a > 0)) complain("edge_a", "a vector of length 0", "a vector of non-zero length");
    if (!(b > 0)) complain("edge_b", "a vector of length 0", "a vector of non-zero length");
    if (!(a > 0 && b > 0)) return;
    const double cosine = edge_a.dot(edge_b) / (a * b);
    if (std::abs(cosine) > square_enough)
      complain("edge_b", "an edge whose angle to edge_a has the cosine " + std::to_string(cosine),
               "an edge perpendicular to edge_a");
  }
};

}  // namespace grit
