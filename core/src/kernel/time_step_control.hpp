// The time step: the largest that stability, impacts and speeds allow, or a prescribed value.
#pragma once

#include "contact/critical_step.hpp"
#include "kernel/displacement_bounds.hpp"
#include "kernel/stiffening.hpp"

namespace grit {

class TimeStepControl {
 public:
  /// The critical time step at its last evaluation [s].
  double critical() const { return critical_time_step_; }
  const Stiffening& stiffening() const { return stiffening_; }

  /// Makes the next prepare() set the time step from all contacts.
  void request() { requested_ = true; }
  bool requested() const { return requested_; }
  /// After settings or bodies have changed.
  void update_stiffening(const State& state) { stiffening_.update(state); }
  /// Sets the time step from all contacts. Throws NumericsError if a prescribed value is above the critical one, Error
  /// if nothing limits it.
  void set(State& state, const World& world, DisplacementBounds& bounds, Passes& passes);
  /// After a neighbour search: the same, except that contacts are only evaluated where something depends on them.
  void search_ends(State& state, const World& world, DisplacementBounds& bounds, Passes& passes);
  /// Whether own bodies have moved or been compressed so far that contacts are new or stiffer. A prescribed step that
  /// may be unstable needs no updates.
  bool due(State& state, Passes& passes) const;
  /// Before an evaluation without a rebuild: sets the time step if requested; otherwise updates it, for such contacts
  /// if it is `due` on any rank, and for speeds.
  void follow(bool due, State& state, const World& world, DisplacementBounds& bounds, Passes& passes);
  /// Whether the next evaluation may find stiffer springs.
  bool may_stiffen(const State& state, const DisplacementBounds& bounds) const {
    return stiffening_.may_exceed(state, bounds);
  }
  /// After an evaluation of the chunk's contacts. `overlap`: the deepest over the smaller radius.
  void touched(std::size_t chunk, double overlap) { critical_.touched(chunk, overlap); }
  /// After an evaluation: sets the time step again if springs have stiffened (if `may_stiffen` was true before), or if
  /// free walls have stiffer contacts.
  void react(bool may_have_stiffened, State& state, const World& world, DisplacementBounds& bounds, Passes& passes);

  /// Throws Error unless what was restored fits the state.
  void check_restored(const State& state) const { critical_.check_restored(state.bodies.count()); }
  /// Restored after the pairs.
  void serialize(SharedArchive& archive, const ContactTable& pairs) {
    critical_.serialize(archive, pairs);
    archive(contacts_, walls_, engines_, critical_time_step_, requested_, stiffening_);
  }

 private:
  /// Sets the time step for these contacts, and the present speeds and engines.
  void set_for(const Demand& contacts, State& state, const World& world, DisplacementBounds& bounds, Passes& passes);
  CriticalStep::Change change_that_matters(const State& state) const;
  CriticalStep::Instant near_contacts(State& state, Passes& passes) const;
  double critical_step(const Demand& contacts, const State& state) const;
  /// The step that stability and impacts allow, or the prescribed one.
  double stable_step(const Demand& contacts, const State& state) const;
  void choose(const Demand& contacts, State& state, const DisplacementBounds& bounds);

  CriticalStep critical_;
  Stiffening stiffening_;
  Demand contacts_, walls_, engines_;  // of which the time step is a function
  double critical_time_step_ = 0;
  bool requested_ = true;
};

}  // namespace grit
