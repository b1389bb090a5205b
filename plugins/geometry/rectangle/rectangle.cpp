// A flat rectangle in space. See README.md.
#include "rectangle.hpp"

#include <algorithm>

#include "grit/plugin.hpp"

namespace grit {

void Rectangle::declare(Parameters& p) {
  sheet_.declare(p);
  p.add("two_sided", two_sided_)
      .doc("whether bodies may be on either side; if not, a centre up to one radius behind the face is pushed back");
}

/// From the closest point of the sheet to `centre`, along a, b and the normal; above the face the first two are
/// exactly 0.
Vec3 Rectangle::offset(const Sheet::Frame& at, const Vec3& centre) const {
  const Vec3 local = at.local(centre);
  return {local.x() - std::clamp(local.x(), 0.0, sheet_.length_a),
          local.y() - std::clamp(local.y(), 0.0, sheet_.length_b), local.z()};
}

void Rectangle::find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                              std::vector<SurfaceContact>& contacts) const {
  const Sheet::Frame at = sheet_.at(pose);
  for (const Sphere& sphere : spheres) {
    const Vec3 away = offset(at, sphere.centre);
    if (!(away.squaredNorm() < sphere.radius * sphere.radius)) continue;
    if (away.x() == 0 && away.y() == 0) {
      const double side = two_sided_ && away.z() < 0 ? -1 : 1;
      contacts.push_back({-side * at.axes.col(2), sphere.radius - side * away.z(), sphere.body, 0});
    } else {
      contacts.push_back({-(at.axes * away).normalized(), sphere.radius - away.norm(), sphere.body, 0});
    }
  }
}

bool Rectangle::near(const Pose& pose, const Vec3& centre, double reach) const {
  return offset(sheet_.at(pose), centre).squaredNorm() <= reach * reach;
}

std::vector<Vec3> Rectangle::triangles() const {
  const Vec3 a = sheet_.corner, b = a + sheet_.edge_a, c = b + sheet_.edge_b, d = a + sheet_.edge_b;
  return {a, b, c, a, c, d};
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "rectangle",
                                     .version = "1.0.0",
                                     .doc = "flat rectangle with face, edges and corners",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Rectangle; }};
  return &info;
}
