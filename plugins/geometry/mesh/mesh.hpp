// A surface of triangles out of a file.
#pragma once

#include <memory>
#include <numbers>
#include <string>

#include "surface.hpp"

namespace grit {

/// Solid behind its facets, or a sheet. A sphere touches each place where the surface is closest to it, once.
class Mesh : public Geometry {
 public:
  void declare(Parameters& p) override;
  /// Reads the file. Throws ParameterError for each defect of its surface.
  void prepare() override;
  Bounds bounds() const override { return surface_->bounds(); }
  bool hollow() const override { return options_.inside; }
  /// Of the flat sheet that an open surface has the rim of; none if it is closed.
  double area() const override { return surface_->area_vector().norm(); }
  Vec3 normal() const override;
  void touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override {
    return surface_->near(pose.to_local(centre), reach);
  }
  std::vector<Vec3> triangles() const override { return surface_->triangles(); }

 private:
  std::string path_;
  SurfaceOptions options_{.crease = std::numbers::pi / 12};
  std::shared_ptr<const Surface> surface_;  // after prepare()
};

}  // namespace grit
