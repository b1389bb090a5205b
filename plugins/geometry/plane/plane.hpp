// An infinite plane: the surface of a half-space.
#pragma once

#include <optional>

#include "grit/geometry.hpp"

namespace grit {

/// Everything behind the plane is solid: overlap = radius − signed distance, however deep the centre lies.
class Plane : public Geometry {
 public:
  void declare(Parameters& p) override;
  void prepare() override { normal_.normalize(); }
  /// Infinite, but flat along the axis that the normal points along, if it does.
  Bounds bounds() const override;
  double area() const override { return area_; }
  Vec3 normal() const override { return normal_; }
  bool flat() const override { return true; }
  void touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  /// A square about `point`; none if neither extent nor area says how large.
  std::vector<Vec3> triangles() const override;

 private:
  Vec3 point_ = Vec3::Zero(), normal_ = Vec3::UnitZ();
  double area_ = 0;
  std::optional<double> extent_;
};

}  // namespace grit
