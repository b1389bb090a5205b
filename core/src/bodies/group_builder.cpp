#include "bodies/group_builder.hpp"

#include <algorithm>
#include <utility>

#include "bodies/make_bodies.hpp"

namespace grit {

GroupBuilder::GroupBuilder(const SceneDescription& scene, const BodiesDescription& group,
                           std::shared_ptr<const BodyKind> kind)
    : kind_(std::move(kind)),
      density_(scene.materials.at(group.material).density),
      scaled_below_(group.scaled_below()) {
  const auto names = material_names(scene);
  material_ = static_cast<std::uint8_t>(std::ranges::find(names, group.material) - names.begin());
}

double GroupBuilder::inert(double radius) const { return std::max(radius, 0.5 * scaled_below_); }

std::optional<double> GroupBuilder::shape_diameter() const {
  if (clump() == nullptr || !(clump()->given_radius > 0)) return std::nullopt;
  return 2 * clump()->given_radius;
}

void GroupBuilder::add(Bodies& bodies, const Vec3& centre, double radius, const Eigen::Quaterniond& turn,
                       const Vec3& velocity, const Vec3& spin) const {
  const ClumpShape* const shape = kind_->clump();
  if (shape == nullptr) {
    const double own = mass(radius);
    bodies.add(centre, radius, own, kind_->inertia(inert(radius), own), material_, velocity, spin);
    return;
  }
  const Eigen::Quaterniond orientation = turn * Eigen::Quaterniond(shape->axes);
  const Vec3 middle = orientation * (radius * shape->middle);
  add_clump(bodies, centre - middle, radius, orientation, velocity, spin);
}

void GroupBuilder::add_clump(Bodies& bodies, const Vec3& centre, double radius, const Eigen::Quaterniond& orientation,
                             const Vec3& velocity, const Vec3& spin) const {
  const double own = mass(radius), size = inert(radius);
  const ClumpShape& shape = *kind_->clump();
  bodies.add_clump(shape, centre, radius, own, own * size * size * shape.inertia, orientation, material_, velocity,
                   spin);
}

}  // namespace grit
