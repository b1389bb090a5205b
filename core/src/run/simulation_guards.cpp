// How a run finds out that it has failed, and says so.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "grit/error.hpp"
#include "run/number.hpp"
#include "run/simulation.hpp"

namespace grit {
namespace {

// Energies are looked at so often, and at 64, 128 and 256 steps of settings, that the largest is known.
constexpr std::uint64_t energy_check_every = 500, first_energy_check = 64;

}  // namespace

void Simulation::check_overlap(double largest) const {
  if (largest <= scene_->guards.overlap) return;
  // Bodies may have moved since, so that the largest overlap is looked for, not the one that is too large.
  const auto share = [this](const Contact& c) {
    const double radius = bodies_.position[c.a].w;
    return c.overlap / (c.with_wall ? radius : std::min(radius, bodies_.position[c.b].w));
  };
  const auto all = contacts();
  const auto worst =
      std::max_element(all.begin(), all.end(), [&](const Contact& c, const Contact& d) { return share(c) < share(d); });
  const Contact& contact = *worst;
  fail_at_body(contact.a,
               "overlaps " +
                   (contact.with_wall ? "wall \"" + walls_.name(contact.b) + "\""
                                      : "body " + std::to_string(bodies_.id[contact.b])) +
                   " by " + number(largest) + " of its radius, more than /guards/overlap " +
                   number(scene_->guards.overlap),
               "the contact modulus may be too low for this load, or bodies began inside each other");
}

double Simulation::kinetic_energy_ratio() const {
  const double elastic = elastic_energy().total();
  return elastic > 0 ? kinetic_energy() / elastic : std::numeric_limits<double>::infinity();
}

bool Simulation::energy_check_is_due() const {
  const std::uint64_t since = clock_.step - energy_.first;
  return energy_.begins || clock_.step % energy_check_every == 0 ||
         (since >= first_energy_check && since < energy_check_every && std::has_single_bit(since));
}

void Simulation::check_energy() {
  const bool begins = std::exchange(energy_.begins, false), by_ledger = flows_.begun;
  // Without a ledger, what growth, the cell and engines put in is not reckoned at each step.
  bool kept = by_ledger || (growth_rate_ == 0 && !clock_.cell_deforms() && !engines_do_work());
  // Nor is there a potential along a periodic axis.
  for (int k = 0; k < 3 && !by_ledger; ++k) kept = kept && !(clock_.cell.periodic[k] && settings_.gravity[k] != 0);
  if (!kept) {  // nor would what is not a number ever be too much
    if (begins) energy_.stored_at_start = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  const EnergyLedger ledger = by_ledger ? energies() : EnergyLedger{};
  const double energy = by_ledger ? ledger.kinetic + ledger.elastic() : kinetic_energy() + elastic_energy().total();
  const double stored = by_ledger ? 0 : energy + gravitational();
  const double last_half = by_ledger ? 0 : 0.5 * clock_.last_time_step * power_of_walls();
  if (begins) {
    energy_ = {.begins = false,
               .first = clock_.step,
               .stored_at_start = stored,
               .work = -last_half,
               .largest = energy,
               .closure_at_start = ledger.closure_error,
               .dissipated_at_start = ledger.dissipated()};
    return;
  }
  energy_.largest = std::max(energy_.largest, energy);
  const double gained = by_ledger ? ledger.closure_error - energy_.closure_at_start
                                  : stored - energy_.stored_at_start - (energy_.work + last_half);
  // What went through is what a ledger may be wrong by a share of.
  const double scale = energy_.largest + (ledger.dissipated() - energy_.dissipated_at_start);
  if (gained > scene_->guards.energy * scale)
    fail("energy came from nowhere: " + number(gained) + " J more than was put in, " + number(gained / scale) +
             " of the largest energy so far" + (by_ledger ? " and of what was dissipated" : "") +
             "; /guards/energy allows " + number(scene_->guards.energy),
         "the time step may be too large for the stiffest contact; try a smaller /time_step/safety" +
             std::string(walls_.any_servo() && flows_.lost.viscosity > 0
                             ? ", or a lower max_velocity of a servo that closes on grains with dashpots"
                             : ""));
}

void Simulation::fail(const std::string& what) const {
  throw NumericsError("step " + std::to_string(clock_.step) + ", time " + number(clock_.time) + " s" +
                      (stage_.empty() ? "" : ", stage \"" + stage_ + "\"") + ": " + what);
}

void Simulation::fail(const std::string& what, const std::string& advice) const { fail(what + "; " + advice); }

void Simulation::fail_at_body(std::size_t body, const std::string& what, const std::string& advice) const {
  const Vec3 x = xyz(bodies_.position[body]);
  fail("body " + std::to_string(bodies_.id[body]) + " at (" + number(x.x()) + ", " + number(x.y()) + ", " +
           number(x.z()) + ") m " + what,
       advice);
}

}  // namespace grit
