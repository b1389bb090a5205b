// A box along the axes: a container that may be open, or a solid block.
#pragma once

#include <array>
#include <string>

#include "grit/geometry.hpp"

namespace grit {

/// A container, touched once a face; or a block, touched once where it is closest.
class Box : public Geometry {
 public:
  /// The faces in the order of their features.
  static constexpr std::array<const char*, 6> face_names{"x_low", "x_high", "y_low", "y_high", "z_low", "z_high"};

  void declare(Parameters& p) override;
  void prepare() override;
  Bounds bounds() const override { return {low_, high_}; }
  bool hollow() const override { return inside_; }
  /// None: no single pressure acts on all faces.
  double area() const override { return 0; }
  Vec3 normal() const override { return Vec3::Zero(); }
  bool flat() const override { return true; }
  void touch(const Pose& pose, std::span<const Sphere> spheres, std::vector<Touch>& touches) const override;
  bool near(const Pose& pose, const Vec3& centre, double reach) const override;
  std::vector<Vec3> triangles() const override;

 private:
  struct Frame;
  Frame frame(const Pose& pose) const;
  void touch_container(const Frame& at, const Sphere& sphere, std::vector<Touch>& touches) const;
  void touch_block(const Frame& at, const Sphere& sphere, std::vector<Touch>& touches) const;
  double height(int face, const Vec3& place) const {
    return face % 2 == 0 ? place[face / 2] : size_[face / 2] - place[face / 2];
  }

  Vec3 low_ = Vec3::Zero(), high_ = Vec3::Ones(), size_ = Vec3::Ones();
  std::vector<std::string> open_;
  bool inside_ = true;
  std::array<bool, 6> closed_{true, true, true, true, true, true};
};

}  // namespace grit
