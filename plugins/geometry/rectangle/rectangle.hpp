// A flat rectangle in space.
#pragma once

#include "grit/geometry.hpp"

namespace grit {

/// A sheet without thickness: it is touched where it is closest, on its face, an edge or a corner, once a sphere.
class Rectangle : public Geometry {
 public:
  void declare(Parameters& p) override;
  void prepare() override;
  Bounds bounds() const override;
  double area() const override { return length_a_ * length_b_; }
  Vec3 normal() const override { return normal_; }
  void touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  std::vector<Vec3> triangles() const override;

 private:
  struct Frame;
  Frame frame(const Pose& pose) const;

  Vec3 corner_ = Vec3::Zero(), edge_a_ = Vec3::UnitX(), edge_b_ = Vec3::UnitY();
  bool two_sided_ = true;
  Vec3 along_a_ = Vec3::UnitX(), along_b_ = Vec3::UnitY(), normal_ = Vec3::UnitZ();  // unit
  double length_a_ = 1, length_b_ = 1;
};

}  // namespace grit
