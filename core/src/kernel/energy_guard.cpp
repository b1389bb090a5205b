#include "kernel/energy_guard.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "format/number.hpp"
#include "kernel/failure.hpp"

namespace grit {
namespace {

// Interval of checks; also at 64, 128 and 256 steps after a change, so that the largest energy is known.
constexpr std::uint64_t check_every = 500, first_check = 64;

/// Whether all work that changes the stored energy is summed up in each step, without a balance.
bool all_work_is_known(const State& state) {
  const Settings& settings = state.settings;
  bool known = settings.growth_rate == 0 && !state.deforms() && !settings.engines_do_work();
  // There is no potential along a periodic axis.
  for (int k = 0; k < 3; ++k)
    known = known && !(state.cell.cell().periodic[as_index(k)] &&
                       settings.any_motion([k](const MotionSettings& motion) { return motion.gravity[k] != 0; }));
  return known;
}

}  // namespace

bool EnergyGuard::due(std::uint64_t step) const {
  const std::uint64_t since = step - first_;
  return begins_ || step % check_every == 0 ||
         (since >= first_check && since < check_every && std::has_single_bit(since));
}

void EnergyGuard::check(const State& state, EnergyBalance& balance) {
  const bool begins = std::exchange(begins_, false), by_balance = balance.begun();
  if (!by_balance && !all_work_is_known(state)) {
    if (begins) stored_at_start_ = std::numeric_limits<double>::quiet_NaN();  // NaN: no energy exceeds it
    return;
  }
  const Energies terms = by_balance ? balance.terms() : Energies{};
  const double kinetic = by_balance ? terms.kinetic : balance.kinetic(),
               elastic = by_balance ? terms.elastic() : balance.elastic().total(), energy = kinetic + elastic;
  const double stored = by_balance ? 0 : energy + balance.gravitational();
  const double last_half = by_balance ? 0 : 0.5 * state.time.previous_dt * balance.power_of_walls();
  if (begins) {
    first_ = state.time.step, stored_at_start_ = stored, work_ = -last_half, largest_ = kinetic + std::abs(elastic);
    closure_at_start_ = terms.closure_error, dissipated_at_start_ = terms.dissipated();
    return;
  }
  largest_ = std::max(largest_, kinetic + std::abs(elastic));  // attraction stores negative energy
  const double gained =
      by_balance ? terms.closure_error - closure_at_start_ : stored - stored_at_start_ - (work_ + last_half);
  // The allowed error of a balance is a fraction of the energy turned over.
  const double scale = largest_ + (terms.dissipated() - dissipated_at_start_);
  const double allowed = state.settings.guards.energy;
  const double rounding = 1e-12 * std::max(std::abs(stored), std::abs(work_));
  if (gained > allowed * scale + rounding)
    fail(state, Guard::energy, {"guards", "energy"},
         "energy was created: " + number(gained) + " J more than the work done, " + number(gained / scale) +
             " of the largest energy so far" + (by_balance ? " plus dissipation" : "") + "; /guards/energy allows " +
             number(allowed),
         "the time step may be too large for the stiffest contact; try a smaller /time_step/safety" +
             std::string(state.walls.any_servo() && balance.dissipated_by_dashpots() > 0
                             ? ", or a lower max_velocity of a servo that closes on grains with dashpots"
                             : ""));
}

}  // namespace grit
