// A flat rectangle in space.
#pragma once

#include "grit/toolkit/sheet.hpp"

namespace grit {

/// A sheet without thickness. A sphere has at most one contact, at the closest point of face, edges and corners.
class Rectangle : public Geometry {
 public:
  void declare(Parameters& p) override;
  void prepare() override { sheet_.prepare(); }
  Bounds bounds() const override { return sheet_.bounds(); }
  double area() const override { return sheet_.length_a * sheet_.length_b; }
  Vec3 normal() const override { return sheet_.axes.col(2); }
  bool flat() const override { return true; }
  void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                     std::vector<SurfaceContact>& contacts) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  std::vector<Vec3> triangles() const override;

 private:
  Vec3 offset(const Sheet::Frame& at, const Vec3& centre) const;

  Sheet sheet_;
  bool two_sided_ = true;
};

}  // namespace grit
