// Regions that bodies fill, enter through or leave by.
#pragma once

#include <string>

#include "grit/parameters.hpp"
#include "grit/vec.hpp"

namespace grit {

struct RectangleRegion {
  static constexpr const char* type_name = "rectangle";
  static constexpr const char* type_doc = "a parallelogram";
  Vec3 corner = Vec3::Zero(), edge_a = Vec3::Zero(), edge_b = Vec3::Zero();
  void declare(Parameters& p);
};
struct DiscRegion {
  static constexpr const char* type_name = "disc";
  static constexpr const char* type_doc = "a circular disc";
  Vec3 centre = Vec3::Zero(), normal = Vec3::UnitZ();
  double radius = 0;
  void declare(Parameters& p);
};
struct BoxRegion {
  static constexpr const char* type_name = "box";
  static constexpr const char* type_doc = "a box along the axes";
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  void declare(Parameters& p);
};
struct SphereRegion {
  static constexpr const char* type_name = "sphere";
  static constexpr const char* type_doc = "a sphere";
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  void declare(Parameters& p);
};
struct CylinderRegion {
  static constexpr const char* type_name = "cylinder";
  static constexpr const char* type_doc = "a circular cylinder";
  Vec3 start = Vec3::Zero(), end = Vec3::Zero();
  double radius = 0;
  void declare(Parameters& p);
};
struct HalfSpaceRegion {
  static constexpr const char* type_name = "half-space";
  static constexpr const char* type_doc = "all that is behind a plane";
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
  void declare(Parameters& p);
};
/// The inside of a closed surface.
struct MeshRegion {
  static constexpr const char* type_name = "mesh";
  static constexpr const char* type_doc = "the inside of a closed surface from an STL file";
  std::string path;
  double scale = 0;  ///< m
  Vec3 position = Vec3::Zero();
  void declare(Parameters& p);
};

/// Reports each axis along which low is not below high.
void check_box(const Vec3& low, const Vec3& high, const Complain& complain);

}  // namespace grit
