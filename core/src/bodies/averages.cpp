// Averages over a box, and measures of static equilibrium.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <vector>

#include "bodies/kinetic_energy.hpp"
#include "grit/world.hpp"

namespace grit {

namespace {

/// Calls visit(shift) for each periodic image of low … high that may intersect the region.
template <class Visit>
void for_images(const Cell& cell, const Region& region, const Vec3& low, const Vec3& high, const Visit& visit) {
  if (cell.skewed()) return cell.each_image(low, high, region.low, region.high, visit);
  int first[3], last[3];
  Vec3 period = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (cell.periodic[as_index(k)]) {
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

/// Fraction of a branch inside the region. A branch along a face belongs to the box above it, so that adjacent boxes
/// count it once.
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

/// Which bodies and clumps forces may move: those of finite mass that no engine holds.
class Movable {
 public:
  explicit Movable(const World& world) : velocities_(world.velocities()), clumps_(world.clumps()), held_(world.held()) {
    if (held_.empty()) return;
    const auto clump_of = world.clump_of();
    held_clumps_.resize(world.clumps().size());
    for (std::size_t i = 0; i < clump_of.size(); ++i)
      if (clump_of[i] != no_clump) held_clumps_[clump_of[i]] = held_[i] != 0;
  }
  bool body(std::size_t i) const { return velocities_[i].w > 0 && (held_.empty() || held_[i] == 0); }
  bool clump(std::size_t c) const {
    return std::isfinite(clumps_[c].mass) && (held_clumps_.empty() || !held_clumps_[c]);
  }

 private:
  std::span<const Row> velocities_;
  std::span<const ClumpView> clumps_;
  std::span<const std::uint8_t> held_;
  std::vector<bool> held_clumps_;
};

}  // namespace

std::string World::group_of(std::uint32_t id) const {
  const auto all = groups();
  const auto next = std::ranges::upper_bound(all, id, {}, &BodyGroup::first_id);
  return next == all.begin() ? "" : std::prev(next)->name;
}

double World::mean_contact_force() const {
  double sum = 0;
  for (const Contact& contact : contacts()) sum += std::abs(contact.normal_force);
  return contacts().empty() ? 0 : sum / static_cast<double>(contacts().size());
}

std::span<const Contact> World::contacts_with_walls() const {
  const auto all = contacts();
  return {std::ranges::find_if(all, &Contact::with_wall), all.end()};
}

double kinetic_energy_of(const ClumpView& clump, double later) {
  const Vec3 velocity = clump.velocity + later / clump.mass * clump.force;
  const Vec3 momentum = clump.axes.transpose() * (clump.momentum + later * clump.moment);
  return 0.5 * clump.mass * velocity.squaredNorm() + 0.5 * momentum.dot(momentum.cwiseQuotient(clump.inertia));
}

double kinetic_energy(const World& world, double half_step, const MeanFlow& flow, std::size_t first, std::size_t last) {
  const auto velocities = world.velocities(), spins = world.spins(), forces = world.forces(), moments = world.moments();
  const auto energy = [half_step](const Row& velocity, const Vec3& force, const Vec3& brought_on) {
    return velocity.w > 0 ? 0.5 / velocity.w * (brought_on + half_step * velocity.w * force).squaredNorm() : 0.0;
  };
  const auto clump_of = world.clump_of();
  const auto clumps = world.clumps();
  double sum = 0;
  for (std::size_t c = first; c < std::min(last, clumps.size()); ++c) {
    ClumpView clump = clumps[c];
    clump.velocity = flow.carried(clump.velocity, half_step);
    sum += kinetic_energy_of(clump, half_step);
  }
  for (std::size_t i = first; i < std::min(last, velocities.size()); ++i)
    if (clump_of.empty() || clump_of[i] == no_clump)
      sum += energy(velocities[i], xyz(forces[i]), flow.carried(xyz(velocities[i]), half_step)) +
             energy(spins[i], xyz(moments[i]), xyz(spins[i]));
  return sum;
}

Equilibrium equilibrium(const World& world) {
  const auto velocities = world.velocities(), forces = world.forces();
  const Movable movable(world);
  double net = 0;
  std::size_t count = 0;
  const auto clump_of = world.clump_of();
  const auto clumps = world.clumps();
  for (std::size_t c = 0; c < clumps.size(); ++c)
    if (movable.clump(c)) net += clumps[c].force.norm(), ++count;
  for (std::size_t i = 0; i < velocities.size(); ++i)
    if (movable.body(i) && (clump_of.empty() || clump_of[i] == no_clump)) net += xyz(forces[i]).norm(), ++count;
  const double normal = world.mean_contact_force();
  if (count > 0) net /= static_cast<double>(count);
  // Velocities are half a step old, except at the first step.
  return {.kinetic_energy = kinetic_energy(world, world.step() > 0 ? 0.5 * world.dt() : 0),
          .unbalanced_force = normal > 0 ? net / normal : 0,
          .mean_contact_force = normal};
}

Support support(const World& world) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto velocities = world.velocities(), forces = world.forces();
  const auto clumps = world.clumps();
  const auto clump_of = world.clump_of();
  // Entries of grains: clumps first, then bodies; those of bodies of clumps stay zero.
  const auto grain = [&](std::size_t body) {
    return clump_of.empty() || clump_of[body] == no_clump ? clumps.size() + body : clump_of[body];
  };
  const Movable movable(world);
  std::vector<Vec3> by_contacts(clumps.size() + velocities.size(), Vec3::Zero());
  double contact = 0, carried = 0;
  for (const Contact& one : world.contacts()) {
    const double force = one.force.norm();
    contact += force, by_contacts[grain(one.a)] -= one.force;
    if (movable.body(one.a)) carried += force;
    if (one.with_wall) continue;
    by_contacts[grain(one.b)] += one.force;
    if (movable.body(one.b)) carried += force;
  }
  double net = 0, load = 0;
  const auto add = [&](const Vec3& force, const Vec3& of_contacts) {
    net += force.norm(), load += (force - of_contacts).norm();
  };
  for (std::size_t c = 0; c < clumps.size(); ++c)
    if (movable.clump(c)) add(clumps[c].force, by_contacts[c]);
  for (std::size_t i = 0; i < velocities.size(); ++i)
    if (movable.body(i) && grain(i) >= clumps.size()) add(xyz(forces[i]), by_contacts[grain(i)]);
  return {.unbalance = load + contact > 0 ? net / (load + contact) : infinity,
          .carried = load > 0 ? carried / load : infinity};
}

Grains grains_of(const World& world) {
  Grains grains;
  const auto positions = world.positions();
  const auto clump_of = world.clump_of();
  for (const ClumpView& clump : world.clumps()) grains.centre.push_back(clump.centre);
  grains.of_body.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const bool alone = clump_of.empty() || clump_of[i] == no_clump;
    grains.of_body[i] = alone ? static_cast<std::uint32_t>(grains.centre.size()) : clump_of[i];
    if (alone) grains.centre.push_back(xyz(positions[i]));
  }
  return grains;
}

Branch branch_of(const World& world, const Contact& contact) {
  Branch branch{xyz(world.positions()[contact.a]), contact.branch};
  const auto arms = world.arms();
  if (arms.empty()) return branch;
  branch.start -= arms[contact.a], branch.vector += arms[contact.a];
  if (!contact.with_wall) branch.vector -= arms[contact.b];
  return branch;
}

double void_ratio(const World& world, const Region& region) {
  const double volume = region.volume();
  if (!(volume > 0) || !std::isfinite(volume)) return std::numeric_limits<double>::infinity();
  double solid = 0;
  const auto positions = world.positions();
  const auto shares = world.volume_fractions();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3 centre = xyz(positions[i]), reach = Vec3::Constant(positions[i].w);
    const double share = shares.empty() ? 1 : shares[i];
    for_images(world.cell(), region, centre - reach, centre + reach, [&](const Vec3& shift) {
      solid += share * sphere_box_volume(centre + shift, positions[i].w, region.low, region.high);
    });
  }
  return solid > 0 ? volume / solid - 1 : std::numeric_limits<double>::infinity();
}

Mat3 mean_stress(const World& world, const Region& region) {
  const double volume = region.volume();
  Mat3 sum = Mat3::Zero();
  if (!(volume > 0) || !std::isfinite(volume)) return sum;
  for (const auto& contact : world.contacts()) {
    const Branch branch = branch_of(world, contact);
    const Vec3 &start = branch.start, end = start + branch.vector;
    double share = 0;
    for_images(world.cell(), region, start.cwiseMin(end), start.cwiseMax(end),
               [&](const Vec3& shift) { share += share_inside(start + shift, branch.vector, region); });
    if (share > 0) sum += share * contact.force * branch.vector.transpose();
  }
  return sum / volume;
}

}  // namespace grit
