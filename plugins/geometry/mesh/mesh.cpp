// A surface of triangles from a file. See README.md.
#include "mesh.hpp"

#include <Eigen/Geometry>

#include "grit/error.hpp"
#include "grit/plugin.hpp"

namespace grit {

void Mesh::declare(Parameters& p) {
  p.add("path", path_).file().required().doc("STL file, ASCII or binary");
  p.add("scale", options_.scale).unit("m").required().above(0).doc("length of one file unit, e.g. \"1 mm\"");
  p.add("stretch", options_.stretch).above(0).doc("further factors along the axes of the file, for unequal scales");
  p.add("orientation", orientation_)
      .unit("rad")
      .doc("rotation vector about the file's origin, right-handed, after scale and before position");
  p.add("position", options_.position).unit("m").doc("position of the file's origin in the scene");
  p.add("merge_distance", options_.merge_distance).unit("m").at_least(0).doc("corners closer than this are merged");
  p.add("open", options_.open).doc("whether the surface may have a rim, such as a sheet or a container without a lid");
  p.add("two_sided", options_.two_sided)
      .doc("whether bodies may be on either side; if not, a centre up to one radius behind the surface is pushed back");
  p.add("inside", options_.inside).doc("whether bodies are behind the facets as drawn, such as inside a container");
  p.add("feature_angle", options_.feature_angle)
      .unit("rad")
      .at_least(0)
      .at_most(std::numbers::pi / 2)
      .doc("facets that meet at less than this form one curved surface with a single contact");
  p.add("skip_degenerate", options_.skip_degenerate).doc("whether facets without area are skipped rather than refused");
  p.add("ignore_normals", options_.ignore_normals)
      .doc("whether normals in the file may contradict the order of corners, which is used");
  p.check([this](const Complain& complain) {
    if (path_.empty()) complain("path", "an empty text", "the path of a file");
  });
}

void Mesh::prepare() {
  if (const double angle = orientation_.norm(); angle > 0)
    options_.turn = Eigen::AngleAxisd(angle, orientation_ / angle).toRotationMatrix();
  surface_ = std::make_shared<const Surface>(read_stl(path_), options_);
  std::vector<ParameterError::Fault> faults;
  for (const Defect& defect : surface_->defects()) faults.push_back({"path", defect.found, defect.allowed});
  if (!faults.empty()) throw ParameterError(std::move(faults));
}

Vec3 Mesh::normal() const {
  const Vec3& vector = surface_->area_vector();
  return vector.isZero(0.0) ? vector : vector.normalized();
}

void Mesh::find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                         std::vector<SurfaceContact>& contacts) const {
  std::vector<std::uint32_t> facets;
  std::vector<Surface::Nearest> found;
  for (const Sphere& sphere : spheres) {
    surface_->nearest(pose.to_local(sphere.centre), sphere.radius, facets, found);
    for (const Surface::Nearest& one : found)
      contacts.push_back(
          {-(pose.turn * one.away).normalized(), sphere.radius - one.distance, sphere.body, one.feature});
  }
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "mesh",
                                     .version = "1.0.0",
                                     .doc = "surface of triangles from an STL file",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Mesh; }};
  return &info;
}
