// The lateral surface of a truncated cone; base of cone and cylinder.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grit/geometry.hpp"

namespace grit {

/// A surface without thickness, open at both ends. In the half plane through its axis and a centre it is a straight
/// line. The contact point is the closest point of that line, rims included. A sphere too large to fit inside has a
/// contact on either side of the axis.
class Frustum : public Geometry {
 public:
  void prepare() override {
    const Vec3 axis = end_ - start_;
    length_ = axis.norm();
    axes_.col(2) = axis / length_;
    axes_.col(0) = axes_.col(2).unitOrthogonal();
    axes_.col(1) = axes_.col(2).cross(axes_.col(0));
    slant_ = std::hypot(end_radius_ - start_radius_, length_);
    outward_ = (end_radius_ - start_radius_) / slant_, forward_ = length_ / slant_;
  }
  Bounds bounds() const override {
    // A circle normal to a unit vector e extends by its radius times √(1 − e²) along each axis.
    const Vec3 across = (Vec3::Ones() - axes_.col(2).cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    return {(start_ - start_radius_ * across).cwiseMin(end_ - end_radius_ * across),
            (start_ + start_radius_ * across).cwiseMax(end_ + end_radius_ * across)};
  }
  bool hollow() const override { return inside_; }
  /// Zero: pressure has no single direction on a curved wall.
  double area() const override { return 0; }
  Vec3 normal() const override { return Vec3::Zero(); }

  void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                     std::vector<SurfaceContact>& contacts) const override {
    const Frame at = frame(pose);
    for (const Sphere& sphere : spheres) {
      const Local local = at.local(sphere.centre);
      const Foot near = foot(local.off_axis, local.along), far = foot(-local.off_axis, local.along);
      const auto add = [&](const Foot& foot, double side, std::uint32_t feature) {
        if (!(std::abs(foot.distance) < sphere.radius)) return;
        const Vec3 away = side * foot.out * local.out + foot.on * at.axes.col(2);
        contacts.push_back({-away.normalized(), sphere.radius - foot.distance, sphere.body, feature});
      };
      add(near, 1, 0);
      // From outside, and from behind, the near side hides the far one. At the tip of a cone both are the same point.
      if ((near.on_rim || near.inside) && !far.at_tip && (far.on_rim || far.distance > 0)) add(far, -1, 1);
    }
  }
  bool near(const Pose& pose, const Vec3& centre, double reach) const override {
    const Local local = frame(pose).local(centre);
    return std::abs(foot(local.off_axis, local.along).distance) <= reach;
  }
  std::vector<Vec3> triangles() const override {
    constexpr int facets = 64;
    std::vector<Vec3> corners;
    const auto corner = [&](int i, const Vec3& centre, double radius) -> Vec3 {
      const double angle = 2 * std::numbers::pi * (i % facets) / facets;
      return centre + radius * (std::cos(angle) * axes_.col(0) + std::sin(angle) * axes_.col(1));
    };
    for (int i = 0; i < facets; ++i) {
      const int here = inside_ ? i + 1 : i, there = inside_ ? i : i + 1;  // counter-clockwise as seen by the bodies
      const Vec3 a = corner(here, start_, start_radius_), b = corner(there, start_, start_radius_),
                 c = corner(there, end_, end_radius_), d = corner(here, end_, end_radius_);
      if (start_radius_ > 0) corners.insert(corners.end(), {a, b, c});
      if (end_radius_ > 0) corners.insert(corners.end(), {a, c, d});
    }
    return corners;
  }

 protected:
  void declare_axis(Parameters& p) {
    p.add("start", start_).unit("m").required().doc("start of the axis: centre of one open end");
    p.add("end", end_).unit("m").required().doc("end of the axis: centre of the other open end");
    p.check([this](const Complain& complain) {
      if (!((end_ - start_).norm() > 0)) complain("end", "the same point as start", "a different point");
    });
  }
  void declare_sides(Parameters& p) {
    p.add("inside", inside_).doc("whether bodies are inside rather than outside");
    p.add("two_sided", two_sided_)
        .doc("true: bodies on both sides; false: a centre up to one radius behind the face is pushed back");
  }

  double start_radius_ = 1, end_radius_ = 1;

 private:
  /// A centre in its half plane, and the outward direction there.
  struct Local {
    Vec3 out;
    double off_axis, along;
  };
  struct Frame {
    Vec3 start;
    Mat3 axes;  // unit columns, the last along the axis

    Local local(const Vec3& centre) const {
      const Vec3 from_start = centre - start;
      const double along = axes.col(2).dot(from_start);
      const Vec3 across = from_start - along * axes.col(2);
      const double off_axis = across.norm();
      return {off_axis > 0 ? Vec3(across / off_axis) : Vec3(axes.col(0)), off_axis, along};
    }
  };
  /// Closest point of the line to a centre: offset of the centre from it, outward and along the axis, and distance;
  /// below 0 behind a face.
  struct Foot {
    double out, on, distance;
    bool on_rim, inside, at_tip;
  };

  Frame frame(const Pose& pose) const { return {pose.to_world(start_), (pose.turn * axes_).colwise().normalized()}; }

  Foot foot(double off_axis, double along) const {
    const double from_start = off_axis - start_radius_;
    const double on_line = outward_ * from_start + forward_ * along, height = outward_ * along - forward_ * from_start;
    const double past = on_line - std::clamp(on_line, 0.0, slant_);
    if (past != 0) {
      const double radius = past < 0 ? start_radius_ : end_radius_;
      const double out = off_axis - radius, on = past < 0 ? along : along - length_;
      return {out, on, std::hypot(out, on), true, height > 0, radius == 0};
    }
    // On a face the normal of the face is used: the offset may be 0.
    const double side = two_sided_ ? (height < 0 ? -1 : 1) : (inside_ ? 1 : -1);
    return {-side * forward_, side * outward_, side * height, false, side > 0 && height > 0, false};
  }

  Vec3 start_ = Vec3::Zero(), end_ = Vec3::UnitZ();
  bool inside_ = true, two_sided_ = false;
  Mat3 axes_ = Mat3::Identity();
  double length_ = 1, slant_ = 1, outward_ = 0, forward_ = 1;  // outward_, forward_: unit direction of the line
};

}  // namespace grit
