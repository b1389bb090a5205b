#include "kernel/time_step_control.hpp"

#include <algorithm>
#include <cmath>

#include "format/number.hpp"
#include "kernel/completion.hpp"
#include "kernel/failure.hpp"
#include "kernel/group_view.hpp"

namespace grit {
namespace {

// Displacement after which contacts are evaluated again for the time step, and distance below which pairs count as
// contacts, both over the mean diameter. Two bodies may approach by more than that between evaluations;
// docs/method.md explains how much the time step lags and the cost of avoiding it.
constexpr double renew_distance = 0.06, contact_distance = 0.015;
// The time step is raised only by this factor or more, so that it does not follow every small change.
constexpr double raise_when = 1.1;

/// Rates of an engine over the bodies on which it acts.
EngineRates rates_of(const ActingEngine& one, const State& state, const World& world) {
  if (one.groups.empty()) return one.engine->rates(world);
  std::vector<std::string> names;
  for (std::size_t group = 0; group < one.groups.size(); ++group)
    if (one.groups[group]) names.push_back(state.settings.groups[group]);
  GroupView own(std::move(names));
  own.update(world);
  return one.engine->rates(own);
}

/// Demand of engines on bodies, added up.
Demand demand_of_engines(const State& state, const World& world) {
  Demand all;
  for (const ActingEngine& one : state.settings.force_engines) {
    const EngineRates rates = rates_of(one, state, world);
    all.spring += rates.stiffness, all.dashpot += rates.damping;
  }
  return all;
}

/// Whether nothing depends on the critical step. It is then evaluated at every eighth search only, for reports.
bool unchecked(const State& state) { return state.settings.time_step.value && state.settings.time_step.allow_unstable; }

/// The time step in which no surface moves too far. While bodies accelerate it is shortened only now and then.
double step_of_displacements(const State& state, const DisplacementBounds& bounds) {
  const Settings& settings = state.settings;
  return max_displacement(settings.time_step, settings.guards) / (raise_when * bounds.displacement_rate());
}

void check_advance(const State& state) {
  if (advances(state.time.time, state.time.dt)) return;
  fail(state, Guard::none, {"time_step"}, "time does not advance in steps of " + number(state.time.dt) + " s",
       "check the units of stiffnesses, densities, sizes and velocities, of which the time step is a function");
}

}  // namespace

CriticalStep::Instant TimeStepControl::near_contacts(State& state, Passes& passes) const {
  return {.bodies = state.bodies,
          .pairs = state.pairs,
          .walls = state.wall_contacts,
          .surfaces = state.surfaces,
          .law = *state.settings.law,
          .shifts = state.cell.images(),
          .skins = state.lists.skins(),
          .near = contact_distance * state.statistics.mean_diameter,
          .ahead = 2 * renew_distance * state.statistics.mean_diameter,  // of a body and a wall
          .overlap = stiffening_.expected_overlap(),
          .halo = state.halo,
          .ranks = passes.ranks()};
}

void TimeStepControl::set(State& state, const World& world, DisplacementBounds& bounds, Passes& passes) {
  stiffening_.expect(state, bounds, passes);
  // Without bodies the step is that of the groups that will appear.
  const Demand found = critical_.find(near_contacts(state, passes), passes.team());
  set_for(state.bodies.count() > 0 ? found : state.settings.of_groups, state, world, bounds, passes);
}

void TimeStepControl::search_ends(State& state, const World& world, DisplacementBounds& bounds, Passes& passes) {
  if (requested_ || !unchecked(state) || state.lists.sorts()) return set(state, world, bounds, passes);
  critical_.forget(state.bodies.count());
  set_for(contacts_, state, world, bounds, passes);
}

void TimeStepControl::set_for(const Demand& contacts, State& state, const World& world, DisplacementBounds& bounds,
                              Passes& passes) {
  engines_ = demand_of_engines(state, world);
  const double stable = stable_step(contacts, state);
  bounds.foresee(state, std::isfinite(stable) ? stable : state.time.dt, passes);
  choose(contacts, state, bounds);
  requested_ = true;
  if (state.settings.time_step.value) bounds.check_foreseen(state, state.time.dt, passes);
  requested_ = false;
}

CriticalStep::Change TimeStepControl::change_that_matters(const State& state) const {
  return {renew_distance * state.statistics.mean_diameter, stiffening_.least_overlap()};
}

bool TimeStepControl::due(State& state, Passes& passes) const {
  if (requested_ || unchecked(state)) return false;
  const CriticalStep::Change change = change_that_matters(state);
  for (const std::size_t chunk : critical_.in_doubt(state.wall_contacts, state.lists.skins(), change, passes.ranks())) {
    fetch_bodies(state, passes);
    state.lists.measure(chunk, state.bodies, state.cell);
  }
  return critical_.due(state.wall_contacts, state.lists.skins(), change, passes.ranks());
}

void TimeStepControl::follow(bool due, State& state, const World& world, DisplacementBounds& bounds, Passes& passes) {
  const Settings& settings = state.settings;
  if (requested_) set(state, world, bounds, passes);
  // Contacts form long before the next rebuild.
  else if (due)
    choose(critical_.renew(near_contacts(state, passes), change_that_matters(state), passes.team()), state, bounds);
  else if (!settings.time_step.value &&
           state.time.dt * bounds.displacement_rate() > max_displacement(settings.time_step, settings.guards))
    choose(contacts_, state, bounds);
}

void TimeStepControl::react(bool may_have_stiffened, State& state, const World& world, DisplacementBounds& bounds,
                            Passes& passes) {
  if (may_have_stiffened && stiffening_.exceeds(state.overlap, state, bounds)) set(state, world, bounds, passes);
  else if (state.walls.demand().more_than(walls_)) choose(contacts_, state, bounds);
}

/// The largest eigenvalue of a sum of positive semidefinite matrices is at most the sum of theirs.
double TimeStepControl::critical_step(const Demand& contacts, const State& state) const {
  const Demand walls = state.walls.demand();
  return Demand{contacts.spring + walls.spring + engines_.spring, contacts.dashpot + walls.dashpot + engines_.dashpot,
                0}
      .critical_time_step();
}

double TimeStepControl::stable_step(const Demand& contacts, const State& state) const {
  const TimeStepDescription& wish = state.settings.time_step;
  if (wish.value) return *wish.value;
  return std::min(wish.safety * critical_step(contacts, state), contacts.step_of_impact(wish.steps_per_impact));
}

void TimeStepControl::choose(const Demand& contacts, State& state, const DisplacementBounds& bounds) {
  requested_ = true;  // again, if this one is refused
  const TimeStepDescription& wish = state.settings.time_step;
  double& dt = state.time.dt;
  contacts_ = contacts, walls_ = state.walls.demand();
  critical_time_step_ = critical_step(contacts_, state);
  if (wish.value) {
    dt = *wish.value;
    if (*wish.value > critical_time_step_ && !wish.allow_unstable)
      fail(state, Guard::critical_step, {"time_step", "value"},
           "the time step " + number(*wish.value) + " s is above the critical one, " + number(critical_time_step_) +
               " s",
           "remove /time_step/value, or set /time_step/allow_unstable to true");
    check_advance(state);
    state.walls.check_oscillations(dt);
    requested_ = false;
    return;
  }
  double safe = stable_step(contacts, state);
  if (!std::isfinite(safe) && dt > 0) {  // all bodies have left
    requested_ = false;
    return;
  }
  if (!std::isfinite(safe))
    throw Error(state.bodies.count() == 0
                    ? "without any group of bodies the time step is undefined; set /time_step/value"
                    : "contacts have practically no stiffness, so the critical time step is infinite; make "
                      "them stiffer, or set /time_step/value");
  safe = std::min(safe, step_of_displacements(state, bounds));
  if (dt == 0 || safe < dt || safe > raise_when * dt) dt = safe;
  check_advance(state);
  state.walls.check_oscillations(dt);
  requested_ = false;
}

}  // namespace grit
