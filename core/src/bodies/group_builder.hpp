// Makes the bodies of a group: masses, inertia and spheres of clumps.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "bodies/bodies.hpp"
#include "description/description.hpp"
#include "grit/body_kind.hpp"

namespace grit {

class GroupBuilder {
 public:
  GroupBuilder(const SceneDescription& scene, const BodiesDescription& group, std::shared_ptr<const BodyKind> kind);

  /// Mass of a body [kg]; `radius`: of a clump that of the enclosing sphere [m].
  double mass(double radius) const { return density_ * kind_->volume(radius); }
  /// Throws Error for a position, radius or mass that the arithmetic cannot hold.
  void add(Bodies& bodies, const Vec3& centre, double radius, const Eigen::Quaterniond& turn, const Vec3& velocity,
           const Vec3& spin) const;
  /// Adds a clump by its centre of mass and the orientation of its principal axes.
  void add_clump(Bodies& bodies, const Vec3& centre, double radius, const Eigen::Quaterniond& orientation,
                 const Vec3& velocity, const Vec3& spin) const;
  /// Gives a body that another description made the material, mass and inertia of this group; velocity and spin are
  /// kept. A clump gets them with its first sphere. Its kind and shape must be those of the group.
  void take_over(Bodies& bodies, std::size_t body) const;
  const ClumpShape* clump() const { return kind_->clump(); }
  /// Diameter of the enclosing sphere of the shape as it was given [m].
  std::optional<double> shape_diameter() const;

 private:
  /// Of a single sphere [kg m²].
  double inertia(double radius) const { return kind_->inertia(radius, mass(radius)); }
  /// Principal moments of a clump [kg m²].
  Vec3 clump_inertia(double radius) const;

  std::shared_ptr<const BodyKind> kind_;
  double density_;  // kg/m³
  std::uint8_t material_;
};

}  // namespace grit
