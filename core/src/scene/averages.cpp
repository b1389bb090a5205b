// Averages over a box, and how far the world is from rest.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "grit/world.hpp"
#include "scene/kinetic_energy.hpp"

namespace grit {

namespace {

/// Calls visit(shift) for each periodic image of low … high that may reach into the region.
template <class Visit>
void for_images(const Cell& cell, const Region& region, const Vec3& low, const Vec3& high, const Visit& visit) {
  int first[3], last[3];
  Vec3 period = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (cell.periodic[k]) {
      period[k] = cell.high[k] - cell.low[k];
      first[k] = static_cast<int>(std::ceil((region.low[k] - high[k]) / period[k]));
      last[k] = static_cast<int>(std::floor((region.high[k] - low[k]) / period[k]));
    } else {
      first[k] = 0, last[k] = high[k] >= region.low[k] && low[k] <= region.high[k] ? 0 : -1;
    }
  }
  for (int i = first[0]; i <= last[0]; ++i)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int k = first[2]; k <= last[2]; ++k) visit(Vec3(i * period[0], j * period[1], k * period[2]));
}

/// The part of a branch that lies in the region. What runs along a face belongs to the box above it, so that boxes side
/// by side count it once.
double share_inside(const Vec3& start, const Vec3& branch, const Region& region) {
  double from = 0, to = 1;
  for (int k = 0; k < 3; ++k) {
    if (branch[k] == 0) {
      if (!(start[k] >= region.low[k] && start[k] < region.high[k])) return 0;
      continue;
    }
    const double low = (region.low[k] - start[k]) / branch[k], high = (region.high[k] - start[k]) / branch[k];
    from = std::max(from, std::min(low, high)), to = std::min(to, std::max(low, high));
  }
  return std::max(to - from, 0.0);
}

}  // namespace

double World::mean_contact_force() const {
  double sum = 0;
  for (const Contact& contact : contacts()) sum += std::abs(contact.normal_force);
  return contacts().empty() ? 0 : sum / static_cast<double>(contacts().size());
}

double kinetic_energy(const World& world, double half_step) {
  const auto velocities = world.velocities(), spins = world.spins(), forces = world.forces(), moments = world.moments();
  const auto energy = [half_step](const Row& velocity, const Row& force) {
    return velocity.w > 0 ? 0.5 / velocity.w * (xyz(velocity) + half_step * velocity.w * xyz(force)).squaredNorm()
                          : 0.0;
  };
  double sum = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i)
    sum += energy(velocities[i], forces[i]) + energy(spins[i], moments[i]);
  return sum;
}

Unrest unrest(const World& world) {
  const auto velocities = world.velocities(), forces = world.forces();
  double net = 0;
  std::size_t movable = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i)
    if (velocities[i].w > 0) net += xyz(forces[i]).norm(), ++movable;
  const double normal = world.mean_contact_force();
  if (movable > 0) net /= static_cast<double>(movable);
  // Velocities are half a step old, but for the first.
  return {.kinetic_energy = kinetic_energy(world, world.step() > 0 ? 0.5 * world.dt() : 0),
          .unbalanced_force = normal > 0 ? net / normal : 0,
          .mean_contact_force = normal};
}

double void_ratio(const World& world, const Region& region) {
  const double volume = region.volume();
  if (!(volume > 0) || !std::isfinite(volume)) return std::numeric_limits<double>::infinity();
  double solid = 0;
  for (const auto& body : world.positions()) {
    const Vec3 centre = xyz(body), reach = Vec3::Constant(body.w);
    for_images(world.cell(), region, centre - reach, centre + reach,
               [&](const Vec3& shift) { solid += sphere_box_volume(centre + shift, body.w, region.low, region.high); });
  }
  return solid > 0 ? volume / solid - 1 : std::numeric_limits<double>::infinity();
}

Mat3 mean_stress(const World& world, const Region& region) {
  const double volume = region.volume();
  Mat3 sum = Mat3::Zero();
  if (!(volume > 0) || !std::isfinite(volume)) return sum;
  const auto positions = world.positions();
  for (const auto& contact : world.contacts()) {
    const Vec3 start = xyz(positions[contact.a]), end = start + contact.branch;
    double share = 0;
    for_images(world.cell(), region, start.cwiseMin(end), start.cwiseMax(end),
               [&](const Vec3& shift) { share += share_inside(start + shift, contact.branch, region); });
    if (share > 0) sum += share * contact.force * contact.branch.transpose();
  }
  return sum / volume;
}

}  // namespace grit
