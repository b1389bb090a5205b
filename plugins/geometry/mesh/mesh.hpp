// A surface of triangles from a file.
#pragma once

#include <memory>
#include <numbers>
#include <string>

#include "surface.hpp"

namespace grit {

/// Solid behind its facets, or a sheet. A sphere has one contact at each local minimum of distance.
class Mesh : public Geometry {
 public:
  void declare(Parameters& p) override;
  /// Reads the file. Throws ParameterError with every defect of its surface.
  void prepare() override;
  Bounds bounds() const override { return surface_->bounds(); }
  bool hollow() const override { return options_.inside; }
  /// Of the flat sheet with the same rim; 0 for a closed surface.
  double area() const override { return surface_->area_vector().norm(); }
  Vec3 normal() const override;
  void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                     std::vector<SurfaceContact>& contacts) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override {
    return surface_->near(pose.to_local(centre), reach);
  }
  std::vector<Vec3> triangles() const override { return surface_->triangles(); }
  std::optional<std::uint32_t> triangle_of(std::uint32_t feature) const override { return Surface::facet_of(feature); }

 private:
  std::string path_;
  Vec3 orientation_ = Vec3::Zero();
  SurfaceOptions options_{.feature_angle = std::numbers::pi / 12};
  std::shared_ptr<const Surface> surface_;  // after prepare()
};

}  // namespace grit
