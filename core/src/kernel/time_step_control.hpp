// The time step: as long as stability and impacts allow, or as prescribed.
#pragma once

#include "contact/critical_step.hpp"
#include "kernel/displacement_bounds.hpp"
#include "kernel/stiffening.hpp"

namespace grit {

class TimeStepControl {
 public:
  /// The critical time step of the last time that it was found [s].
  double critical() const { return critical_time_step_; }
  const Stiffening& stiffening() const { return stiffening_; }

  /// Has the next prepare() set the time step from all contacts.
  void request() { requested_ = true; }
  /// After settings or bodies have changed.
  void update_stiffening(const State& state) { stiffening_.update(state); }
  /// Sets the time step from all contacts. Throws NumericsError if a prescribed one is above the critical one, Error if
  /// nothing limits it.
  void set(State& state, const DisplacementBounds& bounds, Team& team);
  /// Before an evaluation without a rebuild: sets the time step if requested, or follows contacts that have formed
  /// where bodies have moved far enough.
  void follow(State& state, const DisplacementBounds& bounds, Team& team);
  /// Whether the coming evaluation may find springs that stiffened.
  bool may_stiffen(const State& state, const DisplacementBounds& bounds) const {
    return stiffening_.may_exceed(state, bounds);
  }
  /// After an evaluation: sets the time step again if springs stiffened (when `may_stiffen` was true before), or if
  /// free walls have got stiffer contacts.
  void react(bool may_have_stiffened, State& state, const DisplacementBounds& bounds, Team& team);

  void remember(Memory& memory) { memory(critical_, contacts_, walls_, critical_time_step_, requested_, stiffening_); }

 private:
  CriticalStep::Instant near_contacts(const State& state) const;
  void choose(const Demand& contacts, State& state);

  CriticalStep critical_;
  Stiffening stiffening_;
  Demand contacts_, walls_;  // that the step follows from
  double critical_time_step_ = 0;
  bool requested_ = true;
};

}  // namespace grit
