// A box along the axes: an open or closed container, or a solid block.
#pragma once

#include <array>
#include <string>

#include "grit/geometry.hpp"

namespace grit {

/// A sphere has one contact per face of a container, or one contact with a block, at its closest point.
class Box : public Geometry {
 public:
  /// The faces in the order of their features.
  static constexpr std::array<const char*, 6> face_names{"x_low", "x_high", "y_low", "y_high", "z_low", "z_high"};

  void declare(Parameters& p) override;
  void prepare() override;
  Bounds bounds() const override { return {low_, high_}; }
  bool hollow() const override { return inside_; }
  /// Zero: pressure has no single direction on a box.
  double area() const override { return 0; }
  Vec3 normal() const override { return Vec3::Zero(); }
  bool flat() const override { return true; }
  void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                     std::vector<SurfaceContact>& contacts) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  std::vector<Vec3> triangles() const override;

 private:
  struct Frame;
  Frame frame(const Pose& pose) const;
  void container_contacts(const Frame& at, const Sphere& sphere, std::vector<SurfaceContact>& contacts) const;
  void block_contacts(const Frame& at, const Sphere& sphere, std::vector<SurfaceContact>& contacts) const;
  double height(int face, const Vec3& local) const {
    return face % 2 == 0 ? local[face / 2] : size_[face / 2] - local[face / 2];
  }

  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Ones(), size_ = Vec3::Ones();
  std::vector<std::string> open_;
  bool inside_ = true;
  std::array<bool, 6> closed_{true, true, true, true, true, true};
};

}  // namespace grit
