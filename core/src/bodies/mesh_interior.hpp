// The inside of a closed surface of triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "description/description.hpp"
#include "grit/world.hpp"

namespace grit {

class MeshInterior {
 public:
  /// Reads the file. Throws ParameterError at region/path for a file at fault and for a surface that is not closed.
  explicit MeshInterior(const MeshRegion& region);

  Region bounds() const { return bounds_; }
  double volume() const { return volume_; }  ///< m³
  /// Whether a sphere lies inside as a whole.
  bool holds(const Vec3& centre, double radius) const;

 private:
  using Triangle = std::array<Vec3, 3>;

  void check_closed(const std::string& path) const;
  void sort_into_columns();
  /// First and last column along y or z that a range meets.
  std::array<int, 2> columns(int axis, double low, double high) const;
  const std::vector<std::uint32_t>& column(int y, int z) const {
    return columns_[static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[0]) + static_cast<std::size_t>(y)];
  }

  std::vector<Triangle> triangles_;
  Region bounds_{Vec3::Zero(), Vec3::Zero()};
  double volume_ = 0;
  std::array<int, 2> count_{};                       // of columns along y and z
  std::vector<std::vector<std::uint32_t>> columns_;  // along x: the triangles that meet each
};

/// Distance of a point from a triangle.
double distance_to_triangle(const Vec3& point, const std::array<Vec3, 3>& corners);

}  // namespace grit
