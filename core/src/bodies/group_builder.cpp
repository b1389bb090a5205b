#include "bodies/group_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodies/make_bodies.hpp"
#include "bodies/size_limits.hpp"
#include "format/narrow.hpp"
#include "format/number.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

/// `radius`: of a clump that of its smallest sphere; `inertia`: its smallest moment.
void check_body(const Vec3& centre, double radius, double mass, double inertia) {
  const auto in_range = [](double value) { return value > 0 && std::isfinite(value) && std::isfinite(1 / value); };
  if (!(centre.cwiseAbs().maxCoeff() <= most_coordinate))
    throw Error("found a body at (" + number(centre.x()) + ", " + number(centre.y()) + ", " + number(centre.z()) +
                ") m; allowed are positions up to " + number(most_coordinate) +
                " m from the origin along each axis; is the unit right?");
  if (!(radius >= least_body_radius && radius <= most_body_radius))
    throw Error("found a radius of " + number(radius) + " m; allowed is from " + number(least_body_radius) + " to " +
                number(most_body_radius) + " m; is the unit right?");
  if (!in_range(mass) || !in_range(inertia))
    throw Error(
        "found a body with a mass of " + number(mass) + " kg and a moment of inertia of " + number(inertia) +
        " kg m^2; allowed are numbers above 0 whose inverses are finite; is the density of its material right?");
}

}  // namespace

GroupBuilder::GroupBuilder(const SceneDescription& scene, const BodiesDescription& group,
                           std::shared_ptr<const BodyKind> kind)
    : kind_(std::move(kind)), density_(scene.materials.at(group.material).density) {
  const auto names = material_names(scene);
  const auto place = std::ranges::find(names, group.material) - names.begin();
  material_ = narrow_index<std::uint8_t>(static_cast<std::size_t>(place), "materials of bodies");
}

Vec3 GroupBuilder::clump_inertia(double radius) const {
  return mass(radius) * radius * radius * kind_->clump()->inertia;
}

std::optional<double> GroupBuilder::shape_diameter() const {
  if (clump() == nullptr || !(clump()->given_radius > 0)) return std::nullopt;
  return 2 * clump()->given_radius;
}

void GroupBuilder::add(Bodies& bodies, const Vec3& centre, double radius, const Eigen::Quaterniond& turn,
                       const Vec3& velocity, const Vec3& spin) const {
  const ClumpShape* const shape = kind_->clump();
  if (shape == nullptr) {
    check_body(centre, radius, mass(radius), inertia(radius));
    bodies.add(centre, radius, mass(radius), inertia(radius), material_, velocity, spin);
    return;
  }
  const Eigen::Quaterniond orientation = turn * Eigen::Quaterniond(shape->axes);
  const Vec3 middle = orientation * (radius * shape->middle);
  add_clump(bodies, centre - middle, radius, orientation, velocity, spin);
}

void GroupBuilder::add_clump(Bodies& bodies, const Vec3& centre, double radius, const Eigen::Quaterniond& orientation,
                             const Vec3& velocity, const Vec3& spin) const {
  const Row& smallest = *std::ranges::min_element(kind_->clump()->spheres, {}, &Row::w);
  check_body(centre, radius * smallest.w, mass(radius), clump_inertia(radius).minCoeff());
  bodies.add_clump(*kind_->clump(), centre, radius, mass(radius), clump_inertia(radius), orientation, material_,
                   velocity, spin);
}

void GroupBuilder::take_over(Bodies& bodies, std::size_t body) const {
  const auto weigh = [&](std::size_t i, double mass_of, double inertia_of) {
    bodies.material[i] = material_;
    bodies.velocity[i].w = 1 / mass_of, bodies.spin[i].w = 1 / inertia_of;
  };
  const std::uint32_t c = bodies.clumps.clump_of(body);
  if (c == no_clump) {
    const double radius = bodies.position[body].w;
    return weigh(body, mass(radius), inertia(radius));
  }
  Clump& clump = bodies.clumps.clump[c];
  if (bodies.clumps.spheres[clump.first] != body) return;
  const Vec3 inertia = clump_inertia(clump.radius);
  clump.momentum *= inertia[0] / clump.inertia[0];  // all moments change alike
  clump.inertia = inertia, clump.inverse_mass = 1 / mass(clump.radius);
  for (std::uint32_t k = clump.first; k < clump.last; ++k)
    weigh(bodies.clumps.spheres[k], mass(clump.radius), inertia.minCoeff());
}

}  // namespace grit
