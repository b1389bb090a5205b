// Where the energy is, and where it went.
#include <algorithm>
#include <numeric>
#include <vector>

#include "engines/clump_motion.hpp"
#include "run/simulation.hpp"
#include "run/stopwatch.hpp"
#include "scene/kinetic_energy.hpp"

namespace grit {

template <class Part>
auto Simulation::sum_of_chunks(Part part) const {
  std::vector<decltype(part(std::size_t{0}))> found(chunk_.size());
  team_.each(found.size(), [&](std::size_t chunk) { found[chunk] = part(chunk); });
  return std::accumulate(found.begin(), found.end(), decltype(part(std::size_t{0})){});
}

ElasticEnergy Simulation::elastic_energy(std::size_t chunk, double factor) const {
  ElasticEnergy all;
  const auto add = [&](const PairSize& size, std::size_t material_a, std::size_t material_b,
                       std::span<const double> memory) {
    const ElasticEnergy one = law_->energy(size, material_a, material_b, memory);
    all.normal += one.normal, all.shear += size.work_share() * one.shear, all.rolling += one.rolling;
  };
  // How far spheres of clumps go as their clump grows.
  const auto outward = [&](std::uint32_t body) -> Vec3 {
    const std::uint32_t c = bodies_.clumps.clump_of(body);
    if (factor == 1 || c == no_clump) return Vec3::Zero();
    return (factor - 1) * (bodies_.clumps.clump[c].axes * bodies_.clumps.of_body[body].place);
  };
  pairs_.each_memory(chunk, [&](std::size_t c, std::span<const double> memory) {
    const std::uint32_t a = pairs_.a(c), b = pairs_.b(c);
    const double radius_a = factor * bodies_.position[a].w, radius_b = factor * bodies_.position[b].w;
    const Vec3 branch = pairs_.branch(c, bodies_, shifts_.data()) + outward(b) - outward(a);
    const double overlap = std::max(0.0, radius_a + radius_b - branch.norm());  // springs do not pull
    add({.radius_a = radius_a,
         .radius_b = radius_b,
         .inverse_mass_a = bodies_.velocity[a].w,
         .inverse_mass_b = bodies_.velocity[b].w,
         .overlap = overlap},
        bodies_.material[a], bodies_.material[b], memory);
  });
  wall_contacts_.each(chunk, [&](const WallContacts::Touching& t) {
    const std::uint32_t a = t.touch->body;
    const double own = bodies_.position[a].w, r = factor * own;
    const double overlap = std::max(0.0, t.touch->overlap + (factor - 1) * own + t.touch->normal.dot(outward(a)));
    add({.radius_a = r,
         .radius_b = r,
         .inverse_mass_a = bodies_.velocity[a].w,
         .inverse_mass_b = 0,
         .overlap = overlap,
         .wall = true},
        bodies_.material[a], t.touch->material, t.state);
  });
  return all;
}

ElasticEnergy Simulation::elastic_energy(double factor) const {
  return sum_of_chunks([&](std::size_t chunk) { return elastic_energy(chunk, factor); });
}

double Simulation::elastic_by_growth() const {
  constexpr double share = 1e-6;
  return (elastic_energy(1 + share).total() - elastic_energy(1 - share).total()) / (2 * share);
}

double Simulation::kinetic_energy() const {
  const MotionStep next = next_motion();
  const Accelerating how{next.free_translation(), next.free_rotation(), next.strain_rate};
  static_cast<void>(forces()), static_cast<void>(clumps());  // the threads find them worked out
  return sum_of_chunks([&](std::size_t chunk) {
    return grit::kinetic_energy(*this, 0.5 * clock_.last_time_step, how, chunk * chunk_bodies,
                                (chunk + 1) * chunk_bodies);
  });
}

double Simulation::gravitational() const {
  return sum_of_chunks([&](std::size_t chunk) {
    const std::size_t first = chunk * chunk_bodies, last = first + chunk_bodies;
    double energy = 0;
    for (std::size_t c = first; c < std::min(last, bodies_.clumps.clump.size()); ++c)
      energy -= settings_.gravity.dot(bodies_.clumps.clump[c].centre) / bodies_.clumps.clump[c].inverse_mass;
    for (std::size_t i = first; i < std::min(last, bodies_.count()); ++i)
      if (bodies_.clumps.clump_of(i) == no_clump)
        energy -= settings_.gravity.dot(xyz(bodies_.position[i])) / bodies_.velocity[i].w;
    return energy;
  });
}

double Simulation::power_of_walls() const {
  double power = 0;
  for (const WallState& wall : walls_.states()) power -= wall.force.dot(wall.velocity) + wall.moment.dot(wall.spin);
  return power;
}

double Simulation::power_of_engines(std::size_t chunk) const {
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_.count(), first + chunk_bodies);
  double power = 0;
  if (!added_force_.empty())
    for (std::size_t i = first; i < last; ++i)
      power += xyz(added_force_[i]).dot(xyz(bodies_.velocity[i])) + xyz(added_moment_[i]).dot(xyz(bodies_.spin[i]));
  if (!bodies_are_held()) return power;
  // What holds bodies takes up what acts on them.
  const double translation = settings_.hold_translation ? 1 : 0, rotation = settings_.hold_rotation ? 1 : 0;
  for (std::size_t i = first; i < last; ++i) {
    if (bodies_.clumps.clump_of(i) != no_clump) continue;
    const Vec3 force = xyz(sum_[i].force) + settings_.gravity / bodies_.velocity[i].w;
    power -=
        translation * force.dot(xyz(bodies_.velocity[i])) + rotation * xyz(sum_[i].moment).dot(xyz(bodies_.spin[i]));
  }
  for (std::size_t c = first; c < std::min(bodies_.clumps.clump.size(), first + chunk_bodies); ++c) {
    const Clump& clump = bodies_.clumps.clump[c];
    const ClumpLoad load = load_of(clump, bodies_, sum_.data());
    const Vec3 force = load.force + settings_.gravity / clump.inverse_mass;
    power -= translation * force.dot(clump.velocity) + rotation * load.moment.dot(clump.spin);
  }
  return power;
}

double Simulation::power_of_flow() const {
  const Vec3 rate = clock_.cell.strain_rate;
  double power = 0;
  for (const Clump& clump : bodies_.clumps.clump) power += rate.dot(clump.velocity.cwiseAbs2()) / clump.inverse_mass;
  for (std::size_t i = 0; i < bodies_.count(); ++i)
    if (bodies_.clumps.clump_of(i) == no_clump)
      power += rate.dot(xyz(bodies_.velocity[i]).cwiseAbs2()) / bodies_.velocity[i].w;
  return power;
}

double Simulation::power_of_engines() const {
  return sum_of_chunks([this](std::size_t chunk) { return power_of_engines(chunk); });
}

void Simulation::find_crossing() {
  const Stopwatch watch(phases_[pair_contacts].seconds);
  team_.each(chunk_.size(), [this](std::size_t chunk) {
    Vec3& crossing = chunk_[chunk].crossing = Vec3::Zero();
    const auto over = [](const auto& periods, const Row& force) -> Vec3 {
      return Vec3(periods[0], periods[1], periods[2]).cwiseProduct(xyz(force));
    };
    pairs_.each_crossing(chunk, instant(true), [&](std::size_t c, const ContactRow& row) {
      crossing += over(image_shift(pairs_.image(c)), row.force);
    });
    if (bodies_.clumps.none()) return;
    // Spheres that have been put back into the cell pull at clumps at the other side.
    const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_.count(), first + chunk_bodies);
    for (std::size_t i = first; i < last; ++i) crossing -= over(bodies_.clumps.of_body[i].periods, sum_[i].force);
  });
  crossing_ = Vec3::Zero();
  for (const Chunk& chunk : chunk_) crossing_ += chunk.crossing;
}

EnergyLedger Simulation::energies() const {
  EnergyLedger now;
  if (!bodies_.energies()) return now;
  const ElasticEnergy elastic = elastic_energy();
  now.kinetic = kinetic_energy();
  now.elastic_normal = elastic.normal, now.elastic_shear = elastic.shear, now.elastic_rolling = elastic.rolling;
  // The half of the last step's work that the forces at its end do.
  const double half_step = 0.5 * clock_.last_time_step;
  double cell = 0;
  if (clock_.cell_deforms()) cell = power_of_cell(clock_.growth_of_period()) + power_of_flow();
  const double by_walls = half_step * power_of_walls(), by_cell = half_step * cell,
               by_engines = half_step * (engines_do_work() ? power_of_engines() : 0);
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

}  // namespace grit
