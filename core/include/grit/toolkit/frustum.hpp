// The lateral surface of a cone that is cut across its axis, which a cylinder is too.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grit/geometry.hpp"

namespace grit {

/// A surface without thickness, open at both ends: in the half plane through its axis and a centre it is a straight
/// line, touched where that is closest, on the line or on one of the rims at its ends. A sphere too large to fit inside
/// is touched on both sides of the axis.
class Frustum : public Geometry {
 public:
  void prepare() override {
    const Vec3 way = end_ - start_;
    length_ = way.norm();
    axes_.col(2) = way / length_;
    axes_.col(0) = axes_.col(2).unitOrthogonal();
    axes_.col(1) = axes_.col(2).cross(axes_.col(0));
    slant_ = std::hypot(end_radius_ - start_radius_, length_);
    outward_ = (end_radius_ - start_radius_) / slant_, forward_ = length_ / slant_;
  }
  Bounds bounds() const override {
    // Of a circle across a unit vector e: its radius times √(1 − e²), axis by axis.
    const Vec3 across = (Vec3::Ones() - axes_.col(2).cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    return {(start_ - start_radius_ * across).cwiseMin(end_ - end_radius_ * across),
            (start_ + start_radius_ * across).cwiseMax(end_ + end_radius_ * across)};
  }
  bool hollow() const override { return inside_; }
  /// None: no single pressure acts all round.
  double area() const override { return 0; }
  Vec3 normal() const override { return Vec3::Zero(); }

  void touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const override {
    const Frame at = frame(pose);
    for (const Sphere& sphere : spheres) {
      const Place place = at.place(sphere.centre);
      const Foot near = foot(place.off_axis, place.along), far = foot(-place.off_axis, place.along);
      const auto touched = [&](const Foot& foot, double side, std::uint32_t feature) {
        if (!(std::abs(foot.distance) < sphere.radius)) return;
        const Vec3 away = side * foot.out * place.out + foot.on * at.axes.col(2);
        touches.push_back({-away.normalized(), sphere.radius - foot.distance, sphere.body, feature});
      };
      touched(near, 1, 0);
      // From outside, and from behind, the near side hides the far one. At the tip of a cone they are one.
      if ((near.on_rim || near.inside) && !far.at_tip && (far.on_rim || far.distance > 0)) touched(far, -1, 1);
    }
  }
  bool near(const Pose& pose, const Vec3& centre, double reach) const override {
    const Place place = frame(pose).place(centre);
    return std::abs(foot(place.off_axis, place.along).distance) <= reach;
  }
  std::vector<Vec3> triangles() const override {
    constexpr int facets = 64;
    std::vector<Vec3> corners;
    const auto corner = [&](int i, const Vec3& centre, double radius) -> Vec3 {
      const double angle = 2 * std::numbers::pi * (i % facets) / facets;
      return centre + radius * (std::cos(angle) * axes_.col(0) + std::sin(angle) * axes_.col(1));
    };
    for (int i = 0; i < facets; ++i) {
      const int here = inside_ ? i + 1 : i, there = inside_ ? i : i + 1;  // counter-clockwise as the bodies see it
      const Vec3 a = corner(here, start_, start_radius_), b = corner(there, start_, start_radius_),
                 c = corner(there, end_, end_radius_), d = corner(here, end_, end_radius_);
      if (start_radius_ > 0) corners.insert(corners.end(), {a, b, c});
      if (end_radius_ > 0) corners.insert(corners.end(), {a, c, d});
    }
    return corners;
  }

 protected:
  void declare_axis(Parameters& p) {
    p.add("start", start_).unit("m").required().doc("where the axis starts: centre of one open end");
    p.add("end", end_).unit("m").required().doc("where it ends: centre of the other");
    p.check([this](const Complain& complain) {
      if (!((end_ - start_).norm() > 0)) complain("end", "the place of start", "another place than start");
    });
  }
  void declare_sides(Parameters& p) {
    p.add("inside", inside_).doc("whether bodies are inside, or outside");
    p.add("two_sided", two_sided_)
        .doc("whether bodies may be on either side; if not, a centre up to one radius behind the face is pushed back");
  }

  double start_radius_ = 1, end_radius_ = 1;

 private:
  /// A centre in the half plane of its own, and what is outward there.
  struct Place {
    Vec3 out;
    double off_axis, along;
  };
  struct Frame {
    Vec3 start;
    Mat3 axes;  // unit columns, the last along the axis

    Place place(const Vec3& centre) const {
      const Vec3 way = centre - start;
      const double along = axes.col(2).dot(way);
      const Vec3 across = way - along * axes.col(2);
      const double off_axis = across.norm();
      return {off_axis > 0 ? Vec3(across / off_axis) : Vec3(axes.col(0)), off_axis, along};
    }
  };
  /// Where the line is closest to a centre: which way the centre is from there, outward and on along the axis, and how
  /// far; less than 0 behind a face.
  struct Foot {
    double out, on, distance;
    bool on_rim, inside, at_tip;
  };

  Frame frame(const Pose& pose) const { return {pose.to_world(start_), (pose.turn * axes_).colwise().normalized()}; }

  Foot foot(double off_axis, double along) const {
    const double from_start = off_axis - start_radius_;
    const double slid = outward_ * from_start + forward_ * along, height = outward_ * along - forward_ * from_start;
    const double past = slid - std::clamp(slid, 0.0, slant_);
    if (past != 0) {
      const double radius = past < 0 ? start_radius_ : end_radius_;
      const double out = off_axis - radius, on = past < 0 ? along : along - length_;
      return {out, on, std::hypot(out, on), true, height > 0, radius == 0};
    }
    // On a face the normal is that of the face, however close the centre is.
    const double side = two_sided_ ? (height < 0 ? -1 : 1) : (inside_ ? 1 : -1);
    return {-side * forward_, side * outward_, side * height, false, side > 0 && height > 0, false};
  }

  Vec3 start_ = Vec3::Zero(), end_ = Vec3::UnitZ();
  bool inside_ = true, two_sided_ = false;
  Mat3 axes_ = Mat3::Identity();
  double length_ = 1, slant_ = 1, outward_ = 0, forward_ = 1;  // the latter two: direction of the line, unit
};

}  // namespace grit
