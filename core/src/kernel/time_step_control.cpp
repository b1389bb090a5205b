#include "kernel/time_step_control.hpp"

#include <algorithm>
#include <cmath>

#include "format/number.hpp"
#include "kernel/failure.hpp"

namespace grit {
namespace {

// Displacement after which contacts are evaluated again for the time step, and distance below which pairs count as
// contacts, both over the mean diameter. Two bodies may approach by more than that between evaluations;
// docs/definitions.md explains how much the time step lags and the cost of avoiding it.
constexpr double renew_distance = 0.03, contact_distance = 0.015;
// The time step is raised only by this factor or more, so that it does not follow every small change.
constexpr double raise_when = 1.1;

}  // namespace

CriticalStep::Instant TimeStepControl::near_contacts(const State& state) const {
  return {.bodies = state.bodies,
          .pairs = state.pairs,
          .walls = state.wall_contacts,
          .surfaces = state.surfaces,
          .law = *state.settings.law,
          .shifts = state.cell.images(),
          .skins = state.lists.skins(),
          .near = contact_distance * state.statistics.mean_diameter,
          .overlap = stiffening_.expected_overlap()};
}

void TimeStepControl::set(State& state, const DisplacementBounds& bounds, Team& team) {
  requested_ = false;
  stiffening_.expect(state, bounds);
  choose(critical_.find(near_contacts(state), team), state);
}

void TimeStepControl::follow(State& state, const DisplacementBounds& bounds, Team& team) {
  const double distance = renew_distance * state.statistics.mean_diameter;
  if (requested_) set(state, bounds, team);
  // Contacts form long before the next rebuild.
  else if (critical_.due(state.lists.skins(), distance))
    choose(critical_.renew(near_contacts(state), distance, team), state);
}

void TimeStepControl::react(bool may_have_stiffened, State& state, const DisplacementBounds& bounds, Team& team) {
  if (may_have_stiffened && stiffening_.exceeds(state.overlap, state, bounds)) set(state, bounds, team);
  else if (state.walls.demand().more_than(walls_)) choose(contacts_, state);
}

void TimeStepControl::choose(const Demand& contacts, State& state) {
  const TimeStepDescription& wish = state.settings.time_step;
  double& dt = state.time.dt;
  contacts_ = contacts, walls_ = state.walls.demand();
  critical_time_step_ =
      Demand{contacts.spring + walls_.spring, contacts.dashpot + walls_.dashpot, 0}.critical_time_step();
  if (wish.value) {
    dt = *wish.value;
    if (*wish.value > critical_time_step_ && !wish.allow_unstable)
      fail(state, Guard::critical_step, {"time_step", "value"},
           "the time step " + number(*wish.value) + " s is above the critical one, " + number(critical_time_step_) +
               " s",
           "remove /time_step/value, or set /time_step/allow_unstable to true");
    state.walls.check_oscillations(dt);
    return;
  }
  const double safe = std::min(wish.safety * critical_time_step_, contacts.step_of_impact(wish.steps_per_impact));
  if (!std::isfinite(safe) && dt > 0) return;  // all bodies have left
  if (!std::isfinite(safe))
    throw Error(state.bodies.count() == 0
                    ? "without bodies the time step is undefined; set /time_step/value"
                    : "contacts have practically no stiffness, so the critical time step is infinite; make "
                      "them stiffer, or set /time_step/value");
  if (dt == 0 || safe < dt || safe > raise_when * dt) dt = safe;
  state.walls.check_oscillations(dt);
}

}  // namespace grit
