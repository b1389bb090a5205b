// Where the energy is, and where it went.
#include <limits>

#include "run/simulation.hpp"
#include "scene/kinetic_energy.hpp"

namespace grit {

ElasticEnergy Simulation::elastic_energy() const {
  ElasticEnergy all;
  const auto add = [&](const ElasticEnergy& one) {
    all.normal += one.normal, all.shear += one.shear, all.rolling += one.rolling;
  };
  pairs_.each_memory([&](std::size_t c, std::span<const double> memory) {
    const std::uint32_t a = pairs_.a(c), b = pairs_.b(c);
    const double overlap =
        bodies_.position[a].w + bodies_.position[b].w - pairs_.branch(c, bodies_, shifts_.data()).norm();
    add(law_->energy({.radius_a = bodies_.position[a].w,
                      .radius_b = bodies_.position[b].w,
                      .inverse_mass_a = bodies_.velocity[a].w,
                      .inverse_mass_b = bodies_.velocity[b].w,
                      .overlap = overlap},
                     bodies_.material[a], bodies_.material[b], memory));
  });
  wall_contacts_.each([&](const WallContacts::Touching& t) {
    const std::uint32_t a = t.touch->body;
    const double r = bodies_.position[a].w;
    add(law_->energy({.radius_a = r,
                      .radius_b = r,
                      .inverse_mass_a = bodies_.velocity[a].w,
                      .inverse_mass_b = 0,
                      .overlap = t.touch->overlap,
                      .wall = true},
                     bodies_.material[a], t.touch->material, t.state));
  });
  return all;
}

double Simulation::kinetic_energy() const { return grit::kinetic_energy(*this, 0.5 * clock_.last_time_step); }

double Simulation::power_of_walls() const {
  double power = 0;
  for (const WallState& wall : walls_.states()) power -= wall.force.dot(wall.velocity) + wall.moment.dot(wall.spin);
  return power;
}

bool Simulation::all_work_is_kept() const {
  return clock_.cell.strain_rate.isZero(0.0) && force_engines_.empty() && !settings_.hold_rotation &&
         !settings_.hold_translation;
}

EnergyLedger Simulation::energies() const {
  EnergyLedger now;
  if (!bodies_.energies()) return now;
  const ElasticEnergy elastic = elastic_energy();
  now.kinetic = kinetic_energy();
  now.elastic_normal = elastic.normal, now.elastic_shear = elastic.shear, now.elastic_rolling = elastic.rolling;
  // The half of the last step's work that the forces at its end do.
  const double last_half = 0.5 * clock_.last_time_step * power_of_walls();
  if (!flows_.begun) {
    flows_ = {
        .begun = true, .complete = all_work_is_kept(), .at_start = now.kinetic + elastic.total(), .walls = -last_half};
  }
  now.gravitational = -flows_.fallen;
  now.walls = flows_.walls + last_half, now.settings = flows_.settings;
  now.friction = flows_.lost.friction, now.rolling = flows_.lost.rolling, now.viscosity = flows_.lost.viscosity;
  now.local_damping = flows_.damped;
  now.closure_error =
      now.kinetic + now.elastic() + now.gravitational + now.dissipated() - flows_.at_start - now.walls - now.settings;
  if (!flows_.complete) now.closure_error = std::numeric_limits<double>::quiet_NaN();
  return now;
}

}  // namespace grit
