#include "kernel/energy_balance.hpp"

#include <algorithm>
#include <utility>

#include "bodies/kinetic_energy.hpp"
#include "motion/clump_motion.hpp"

namespace grit {

ElasticEnergy EnergyBalance::elastic(std::size_t chunk, double factor) const {
  const Bodies& bodies = state_.bodies;
  ElasticEnergy all;
  const auto add = [&](const PairSize& size, std::size_t material_a, std::size_t material_b,
                       std::span<const double> history) {
    all = all + state_.settings.law->energy(size, material_a, material_b, history);
  };
  // Springs carry no tension, unless the law acts at a distance.
  const auto overlap_of_springs = [tension = state_.settings.law->has_reach()](double overlap) {
    return tension ? overlap : std::max(0.0, overlap);
  };
  // Displacement of a clump's spheres as the clump grows.
  const auto outward = [&](std::uint32_t body) -> Vec3 {
    const std::uint32_t c = bodies.clumps.clump_of(body);
    if (factor == 1 || c == no_clump) return Vec3::Zero();
    return (factor - 1) * (bodies.clumps.clump[c].axes * bodies.clumps.of_body[body].place);
  };
  state_.pairs.each_history(chunk, [&](std::size_t c, std::span<const double> history) {
    const std::uint32_t a = state_.pairs.a(c), b = state_.pairs.b(c);
    const double radius_a = factor * bodies.position[a].w, radius_b = factor * bodies.position[b].w;
    const Vec3 branch = state_.pairs.branch(c, bodies, state_.cell.images()) + outward(b) - outward(a);
    const double overlap = overlap_of_springs(radius_a + radius_b - branch.norm());
    add({.radius_a = radius_a,
         .radius_b = radius_b,
         .inverse_mass_a = bodies.velocity[a].w,
         .inverse_mass_b = bodies.velocity[b].w,
         .overlap = overlap},
        bodies.material[a], bodies.material[b], history);
  });
  state_.wall_contacts.each(chunk, [&](const WallContacts::Touching& t) {
    const std::uint32_t a = t.contact->body;
    const double own = bodies.position[a].w, r = factor * own;
    const double overlap =
        overlap_of_springs(t.contact->overlap + (factor - 1) * own + t.contact->normal.dot(outward(a)));
    add({.radius_a = r,
         .radius_b = r,
         .inverse_mass_a = bodies.velocity[a].w,
         .inverse_mass_b = 0,
         .overlap = overlap,
         .wall = true},
        bodies.material[a], t.contact->material, t.state);
  });
  return all;
}

ElasticEnergy EnergyBalance::elastic(double factor) const {
  return passes_.sum([&](std::size_t chunk) { return elastic(chunk, factor); });
}

double EnergyBalance::elastic_by_growth() const {
  constexpr double share = 1e-6;
  return (elastic(1 + share).total() - elastic(1 - share).total()) / (2 * share);
}

double EnergyBalance::kinetic() const {
  const MeanFlow flow{state_.cell.cell().strain_rate, state_.cell.cell().shear_rate};
  static_cast<void>(world_.forces()), static_cast<void>(world_.clumps());  // computed once, before threads read them
  return passes_.sum([&](std::size_t chunk) {
    return kinetic_energy(world_, 0.5 * state_.time.previous_dt, flow, chunk * chunk_bodies,
                          (chunk + 1) * chunk_bodies);
  });
}

double EnergyBalance::gravitational() const {
  const Bodies& bodies = state_.bodies;
  return passes_.sum([&](std::size_t chunk) {
    const ChunkRange clumps(chunk, bodies.clumps.clump.size()), range(chunk, bodies.count());
    double energy = 0;
    for (std::size_t c = clumps.first; c < clumps.last; ++c) {
      const Clump& clump = bodies.clumps.clump[c];
      energy -= state_.motion_of(clump).gravity_on(clump.radius).dot(clump.centre) / clump.inverse_mass;
    }
    for (std::size_t i = range.first; i < range.last; ++i)
      if (bodies.clumps.clump_of(i) == no_clump)
        energy -=
            state_.motion_of(i).gravity_on(bodies.position[i].w).dot(xyz(bodies.position[i])) / bodies.velocity[i].w;
    return energy;
  });
}

double EnergyBalance::power_of_walls() const {
  double power = 0;
  for (const WallState& wall : state_.walls.states())
    power -= wall.force.dot(wall.velocity) + wall.moment.dot(wall.spin) +
             wall.surface_force.dot(wall.surface_velocity) + wall.surface_moment.dot(wall.surface_spin);
  return power;
}

double EnergyBalance::power_of_engines(std::size_t chunk) const {
  const Bodies& bodies = state_.bodies;
  const ChunkRange range(chunk, bodies.count()), clumps(chunk, bodies.clumps.clump.size());
  double power = 0;
  if (!state_.added_force.empty())
    for (std::size_t i = range.first; i < range.last; ++i)
      power += xyz(state_.added_force[i]).dot(xyz(bodies.velocity[i])) +
               xyz(state_.added_moment[i]).dot(xyz(bodies.spin[i]));
  if (!state_.settings.holds_bodies()) return power;
  // Held bodies: the engine's work is the negative of that of all other forces.
  for (std::size_t i = range.first; i < range.last; ++i) {
    if (bodies.clumps.clump_of(i) != no_clump) continue;
    const MotionSettings& motion = state_.motion_of(i);
    if (!motion.holds()) continue;
    const Vec3 force = xyz(state_.sum[i].force) + motion.gravity_on(bodies.position[i].w) / bodies.velocity[i].w;
    power -= motion.constrained_translation().cwiseProduct(force).dot(xyz(bodies.velocity[i])) +
             motion.constrained_rotation().cwiseProduct(xyz(state_.sum[i].moment)).dot(xyz(bodies.spin[i]));
  }
  for (std::size_t c = clumps.first; c < clumps.last; ++c) {
    const Clump& clump = bodies.clumps.clump[c];
    const MotionSettings& motion = state_.motion_of(clump);
    if (!motion.holds()) continue;
    const ClumpLoad load = load_of(clump, bodies, state_.sum.data());
    const Vec3 force = load.force + motion.gravity_on(clump.radius) / clump.inverse_mass;
    power -= motion.constrained_translation().cwiseProduct(force).dot(clump.velocity) +
             motion.constrained_rotation().cwiseProduct(load.moment).dot(clump.spin);
  }
  return power;
}

double EnergyBalance::power_of_engines() const {
  if (!state_.bodies.clumps.none()) static_cast<void>(world_.forces());  // completes those of other ranks
  return passes_.sum([this](std::size_t chunk) { return power_of_engines(chunk); });
}

double EnergyBalance::power_of_flow() const {
  static_cast<void>(world_.velocities());  // completes those of other ranks
  const Bodies& bodies = state_.bodies;
  const Cell& cell = state_.cell.cell();
  double power = 0;
  const auto add = [&](const Vec3& velocity, double inverse_mass) {
    power += cell.strain_rate.dot(velocity.cwiseAbs2()) / inverse_mass;
    if (cell.shears()) power += DeformingCell::shear_flow(cell.shear_rate, velocity).dot(velocity) / inverse_mass;
  };
  for (const Clump& clump : bodies.clumps.clump) add(clump.velocity, clump.inverse_mass);
  for (std::size_t i = 0; i < bodies.count(); ++i)
    if (bodies.clumps.clump_of(i) == no_clump) add(xyz(bodies.velocity[i]), bodies.velocity[i].w);
  return power;
}

double EnergyBalance::power_of_cell() const {
  const double previous_dt = state_.time.previous_dt;
  return power_of_cell(state_.cell.period_growth(previous_dt), state_.cell.tilt_growth(previous_dt));
}

double EnergyBalance::power_of_cell(const Vec3& growth, const Vec3& tilt_growth) const {
  const Vec3 straight = crossing_.diagonal();
  const double power = -straight.dot(growth);
  return tilt_growth.isZero(0.0) ? power
                                 : power - Vec3(crossing_(0, 1), crossing_(0, 2), crossing_(1, 2)).dot(tilt_growth);
}

void EnergyBalance::find_crossing() {
  if (!state_.bodies.energies() || !state_.deforms()) return;
  const PhaseWatch watch = passes_.watch(StepPhase::contacts);
  const Bodies& bodies = state_.bodies;
  const auto parts = passes_.of_chunks([&](std::size_t chunk) {
    Mat3 crossing = Mat3::Zero();
    const auto over = [](const auto& periods, const Row& force) -> Mat3 {
      return xyz(force) * Vec3(periods[0], periods[1], periods[2]).transpose();
    };
    state_.pairs.each_crossing(chunk, state_.instant(true), [&](std::size_t c, const ContactRow& row) {
      crossing += over(image_shift(state_.pairs.image(c)), row.force);
    });
    if (bodies.clumps.none()) return crossing;
    // Spheres that re-entered the cell act on clumps on the other side.
    const ChunkRange range(chunk, bodies.count());
    for (std::size_t i = range.first; i < range.last; ++i)
      crossing -= over(bodies.clumps.of_body[i].periods, state_.sum[i].force);
    return crossing;
  });
  crossing_ = Mat3::Zero();
  for (const Mat3& crossing : parts) crossing_ += crossing;
}

void EnergyBalance::add_losses() {
  if (!is_kept()) return;
  for (const ChunkResult& chunk : passes_.chunks()) {
    flows_.lost.friction += chunk.losses.friction, flows_.lost.rolling += chunk.losses.rolling;
    flows_.lost.viscosity += chunk.losses.viscosity;
  }
}

void EnergyBalance::before_growth(double grown) {
  // Work of growth on springs in a step: half by the forces at its start, half by those at its end.
  const double half_by_now = 0.5 * (flows_.grown + grown);
  if (flows_.begun) flows_.settings += half_by_now * elastic_by_growth();
  flows_.grown = grown;
}

void EnergyBalance::before_motion(const MotionStep& step) {
  const double half_before = 0.5 * state_.time.previous_dt;
  engines_in_step_ = cell_in_step_ = 0;
  if (!step.energies) return;
  if (state_.settings.engines_do_work()) {
    const PhaseWatch watch = passes_.watch(StepPhase::motion);
    engines_in_step_ = half_before * power_of_engines();
  }
  if (step.flows()) cell_in_step_ = half_before * power_of_cell();
}

void EnergyBalance::after_motion(const MotionStep& step) {
  const double half_after = 0.5 * step.drift;
  if (step.energies && state_.settings.engines_do_work()) {
    const PhaseWatch watch = passes_.watch(StepPhase::motion);
    engines_in_step_ += half_after * power_of_engines();
  }
  if (step.energies && step.flows()) cell_in_step_ += half_after * power_of_cell(step.period_growth, step.tilt_growth);
  flows_.engines += engines_in_step_, flows_.cell += cell_in_step_;
}

void EnergyBalance::add_step(double work_of_walls) {
  flows_.walls += work_of_walls;
  for (ChunkResult& chunk : passes_.chunks()) {
    const Motion of_clumps = std::exchange(chunk.clumps, {});
    flows_.damped += chunk.motion.damped + of_clumps.damped;
    flows_.fallen += chunk.motion.fallen + of_clumps.fallen;
    flows_.cell += chunk.motion.carried + of_clumps.carried;
    flows_.engines += chunk.motion.prescribed + of_clumps.prescribed;
  }
}

double EnergyBalance::settings_less_stored() {
  if (!flows_.begun) return flows_.settings;
  const Energies now = terms();
  return flows_.settings -
         (now.kinetic + now.elastic() - now.walls - now.cell - now.engines - (now.settings - flows_.settings));
}

void EnergyBalance::set_settings_less_stored(double value) {
  double stored = 0;
  if (flows_.begun) {
    const Energies now = terms();
    stored = now.kinetic + now.elastic() - now.walls - now.cell - now.engines - (now.settings - flows_.settings);
  }
  flows_.settings = value + stored;
}

Energies EnergyBalance::terms() {
  Energies now;
  if (!state_.bodies.energies()) return now;
  const ElasticEnergy elastic = this->elastic();
  now.kinetic = kinetic();
  now.elastic_normal = elastic.normal, now.elastic_shear = elastic.shear, now.elastic_rolling = elastic.rolling;
  // The second half of the last step's work, by the forces at its end.
  const double half_step = 0.5 * state_.time.previous_dt;
  double cell = 0;
  if (state_.cell.deforms()) cell = power_of_cell() + power_of_flow();
  const double by_walls = half_step * power_of_walls(), by_cell = half_step * cell,
               by_engines = half_step * (state_.settings.engines_do_work() ? power_of_engines() : 0);
  const double by_growth = flows_.grown > 0 ? 0.5 * flows_.grown * elastic_by_growth() : 0;
  if (!flows_.begun)
    flows_ = {.begun = true,
              .at_start = now.kinetic + elastic.total(),
              .walls = -by_walls,
              .cell = -by_cell,
              .engines = -by_engines,
              .settings = -by_growth,
              .grown = flows_.grown};
  now.gravitational = -flows_.fallen;
  now.walls = flows_.walls + by_walls, now.cell = flows_.cell + by_cell, now.engines = flows_.engines + by_engines;
  now.settings = flows_.settings + by_growth;
  now.friction = flows_.lost.friction, now.rolling = flows_.lost.rolling, now.viscosity = flows_.lost.viscosity;
  now.local_damping = flows_.damped;
  now.closure_error = now.kinetic + now.elastic() + now.gravitational + now.dissipated() - flows_.at_start - now.walls -
                      now.cell - now.engines - now.settings;
  return now;
}

void EnergyBalance::serialize(Archive& archive) {
  archive(flows_.begun, flows_.at_start, flows_.lost.friction, flows_.lost.rolling, flows_.lost.viscosity,
          flows_.damped, flows_.fallen, flows_.walls, flows_.cell, flows_.engines, flows_.settings, flows_.grown);
}

}  // namespace grit
