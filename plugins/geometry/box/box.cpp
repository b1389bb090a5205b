// A box along the axes. See README.md.
#include "box.hpp"

#include <algorithm>
#include <cmath>

#include "grit/plugin.hpp"

namespace grit {

/// Current position of the box.
struct Box::Frame {
  Vec3 low;
  Mat3 axes;  // unit columns

  /// Coordinates from the low corner along the box's own axes.
  Vec3 local(const Vec3& centre) const { return axes.transpose() * (centre - low); }
};

namespace {

/// Sign of the outward direction of a face along its axis.
double outward(int face) { return face % 2 == 0 ? -1 : 1; }

/// From the closest point of a solid box [0, size] to `local`.
Vec3 offset(const Vec3& local, const Vec3& size) { return local - local.cwiseMax(0.0).cwiseMin(size); }

}  // namespace

Box::Frame Box::frame(const Pose& pose) const { return {pose.to_world(low_), pose.turn.colwise().normalized()}; }

void Box::declare(Parameters& p) {
  p.add("low", low_).unit("m").required().doc("corner with the smallest x, y and z");
  p.add("high", high_).unit("m").required().doc("corner with the largest x, y and z");
  p.add("open", open_)
      .one_of({face_names.begin(), face_names.end()})
      .doc("faces without a wall, e.g. [\"z_high\"]; containers only");
  p.add("inside", inside_).doc("true: a container with bodies inside; false: a solid block");
  p.check([this](const Complain& complain) {
    for (int axis = 0; axis < 3; ++axis)
      if (!(high_[axis] > low_[axis])) {
        const char name = "xyz"[axis];
        complain("high", std::string(1, name) + " = " + std::to_string(high_[axis]) + " m",
                 "above that of low, " + std::to_string(low_[axis]) + " m");
      }
    for (auto face = open_.begin(); face != open_.end(); ++face) {
      if (std::find(face_names.begin(), face_names.end(), *face) == face_names.end())
        complain("open", '"' + *face + '"', "x_low, x_high, y_low, y_high, z_low, z_high");
      if (std::find(open_.begin(), face, *face) != face) complain("open", '"' + *face + "\" twice", "each face once");
    }
    if (!inside_ && !open_.empty())
      complain("open", "an open face of a solid block", "open faces only where inside is true");
    if (open_.size() >= face_names.size()) complain("open", "all six faces", "at most five faces");
  });
}

void Box::prepare() {
  size_ = high_ - low_;
  for (std::size_t face = 0; face < face_names.size(); ++face)
    closed_[face] = std::find(open_.begin(), open_.end(), face_names[face]) == open_.end();
}

void Box::find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                        std::vector<SurfaceContact>& contacts) const {
  const Frame at = frame(pose);
  for (const Sphere& sphere : spheres) {
    if (inside_) container_contacts(at, sphere, contacts);
    else block_contacts(at, sphere, contacts);
  }
}

void Box::container_contacts(const Frame& at, const Sphere& sphere, std::vector<SurfaceContact>& contacts) const {
  const Vec3 local = at.local(sphere.centre), out = offset(local, size_);
  bool past_rim = false;                  // the centre has left through an open face
  std::array<int, 3> behind{-1, -1, -1};  // the closed face that it lies behind, along each axis
  for (int axis = 0; axis < 3; ++axis) {
    if (out[axis] == 0) continue;
    if (std::abs(out[axis]) >= sphere.radius) return;
    const int face = 2 * axis + (out[axis] > 0);
    if (closed_[as_index(face)]) behind[as_index(axis)] = face;
    else past_rim = true;
  }
  for (int face = 0; face < 6; ++face) {
    if (!closed_[as_index(face)]) continue;
    const int axis = face / 2;
    const double above = height(face, local);
    if (!past_rim) {
      // Faces continue behind closed edges, so that a centre pressed out there is pushed back.
      if (above < sphere.radius)
        contacts.push_back(
            {outward(face) * at.axes.col(axis), sphere.radius - above, sphere.body, static_cast<std::uint32_t>(face)});
      continue;
    }
    // Over the rim the closest point of a face may lie on an edge shared with a closed face of another axis. It
    // counts only if it is the closest point of that face too, and then for the first of them.
    const bool shared = std::any_of(behind.begin(), behind.end(), [&](int other) {
      return other >= 0 && other / 2 != axis && (above > 0 || other < face);
    });
    if (shared) continue;
    Vec3 away = out;
    away[axis] = -outward(face) * above;
    const double distance = away.norm();
    if (distance < sphere.radius)
      contacts.push_back(
          {-(at.axes * away).normalized(), sphere.radius - distance, sphere.body, static_cast<std::uint32_t>(face)});
  }
}

void Box::block_contacts(const Frame& at, const Sphere& sphere, std::vector<SurfaceContact>& contacts) const {
  const Vec3 local = at.local(sphere.centre), out = offset(local, size_);
  const double distance = out.norm();
  if (distance >= sphere.radius) return;
  if (distance > 0) {
    contacts.push_back({-(at.axes * out).normalized(), sphere.radius - distance, sphere.body, 0});
    return;
  }
  int nearest = 0;
  for (int face = 1; face < 6; ++face)
    if (height(face, local) < height(nearest, local)) nearest = face;
  contacts.push_back(
      {-outward(nearest) * at.axes.col(nearest / 2), sphere.radius + height(nearest, local), sphere.body, 0});
}

bool Box::near(const Pose& pose, const Vec3& centre, double reach) const {
  const Vec3 local = frame(pose).local(centre), out = offset(local, size_);
  if (!inside_) return out.norm() <= reach;
  if (out.cwiseAbs().maxCoeff() > reach) return false;
  for (int face = 0; face < 6; ++face)
    if (closed_[as_index(face)] && height(face, local) <= reach) return true;
  return false;
}

std::vector<Vec3> Box::triangles() const {
  std::vector<Vec3> corners;
  for (int face = 0; face < 6; ++face) {
    if (!closed_[as_index(face)]) continue;
    const int axis = face / 2;
    Vec3 a = low_;
    if (face % 2 == 1) a[axis] = high_[axis];
    Vec3 u = Vec3::Zero(), v = Vec3::Zero();
    u[(axis + 1) % 3] = size_[(axis + 1) % 3];
    v[(axis + 2) % 3] = size_[(axis + 2) % 3];
    if ((face % 2 == 1) == inside_) std::swap(u, v);  // counter-clockwise as seen by the bodies
    for (const Vec3& corner : {a, Vec3(a + u), Vec3(a + u + v), a, Vec3(a + u + v), Vec3(a + v)})
      corners.push_back(corner);
  }
  return corners;
}

}  // namespace grit

const grit::PluginInfo* grit_plugin() {
  static const grit::PluginInfo info{.kind = "geometry",
                                     .name = "box",
                                     .version = "1.0.0",
                                     .doc = "box along the axes: open or closed container, or solid block",
                                     .make_geometry = []() -> grit::Geometry* { return new grit::Box; }};
  return &info;
}
