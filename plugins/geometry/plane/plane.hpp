// An infinite plane: the surface of a half-space.
#pragma once

#include <optional>

#include "grit/geometry.hpp"

namespace grit {

/// Solid behind the plane at any depth: overlap = radius − signed distance.
class Plane : public Geometry {
 public:
  void declare(Parameters& p) override;
  void prepare() override { normal_.normalize(); }
  /// Infinite, except along an axis parallel to the normal.
  Bounds bounds() const override;
  double area() const override { return area_; }
  Vec3 normal() const override { return normal_; }
  bool flat() const override { return true; }
  void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                     std::vector<SurfaceContact>& contacts) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  /// A square about `point`; none if neither extent nor area is set.
  std::vector<Vec3> triangles() const override;

 private:
  Vec3 point_ = Vec3::Zero(), normal_ = Vec3::UnitZ();
  double area_ = 0;
  std::optional<double> extent_;
};

}  // namespace grit
