// A simulation without stages, output or files: a state and the parts that advance it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grit/simulation.hpp"
#include "kernel/energy_balance.hpp"
#include "kernel/energy_guard.hpp"
#include "kernel/inflow.hpp"
#include "kernel/model.hpp"
#include "kernel/passes.hpp"
#include "kernel/prepared.hpp"
#include "kernel/state.hpp"
#include "kernel/stepper.hpp"
#include "kernel/world_view.hpp"

namespace grit {

class Kernel {
 public:
  /// Starts with the bodies of the scene and the state that its components request. Walls of a sample keep their poses
  /// by name.
  /// `ranks`: processes that share the bodies; null if there is one.
  Kernel(const SceneDescription& scene, const Components& components, Prepared prepared, unsigned threads,
         Communicator* ranks = nullptr);

  /// Begins a stage with the settings of `scene`, which has the same materials, walls and bodies as the first. Inserts
  /// the bodies of this stage. Throws NumericsError if there is no room for them, or if they overlap others or walls by
  /// more than allowed; they are then not inserted.
  void begin_stage(const std::string& name, const SceneDescription& scene, const Components& components);
  /// Checks the guards that are not checked in each step. Throws NumericsError if one trips.
  void end_stage() { guard_.check(state_, balance_); }
  /// Changes settings within a stage.
  void change(const SceneDescription& scene, const Components& components);

  /// From the next step on a device steps the bodies. Throws PlacedError for what it cannot do yet. One rank only.
  void use(DeviceKind device);
  void find_forces();
  void advance() { stepper_.advance(); }
  void step_on();
  /// Forces a neighbour search before the next forces.
  void request_rebuild() { state_.lists.request_rebuild(); }

  const State& state() const { return state_; }
  const WorldView& world() const { return view_; }
  /// See Simulation::keep().
  std::shared_ptr<const void> keep(WorldArray array);
  double critical_time_step() const { return stepper_.time_step().critical(); }
  /// Kinetic over elastic energy; infinite without elastic energy.
  double kinetic_energy_ratio() const;
  /// Message for each servo of a wall or of the cell that misses its target; empty if there is none.
  std::string fallen_behind() const;
  /// Bodies of streams that wait for room, in words; empty if there are none.
  std::string waiting_bodies() const { return inflow_.waiting(); }
  /// Advice for each stream of which many bodies wait.
  std::vector<std::string> blocked_streams() const { return inflow_.blocked(); }
  /// Whether a component has asked for the energy balance, so that it is kept: see World::energies().
  bool keeps_energy_balance() const { return balance_.is_kept(); }
  bool is_first_rank() const { return passes_.ranks().rank() == 0; }
  unsigned ranks() const { return passes_.ranks().count(); }
  /// Whether any rank says so, of each; all must call this.
  std::pair<bool, bool> any_rank(bool one, bool other);
  /// See Ranks::Alone.
  Ranks::Alone alone() const { return Ranks::Alone(passes_.ranks()); }
  /// Completes bodies and clumps that the world shows on this rank; all must call this.
  void complete_world() const { view_.complete(); }
  /// The same of contacts, on the first rank only.
  void collect_contacts() const { view_.collect_contacts(); }
  /// Number of bodies, of all ranks. Unlike the arrays of the world, it needs nothing from others.
  std::size_t bodies() const { return state_.bodies.count(); }
  /// Number of pairs in contact, of all ranks; all must call this.
  std::size_t contact_count() const;
  double body_steps() const { return stepper_.body_steps(); }
  /// All ranks must call this before sharing().
  void collect_sharing() { stepper_.collect_sharing(); }
  /// None with one rank.
  std::optional<Sharing> sharing() const { return ranks() > 1 ? std::optional(stepper_.sharing()) : std::nullopt; }
  unsigned threads() const { return passes_.threads(); }
  std::vector<PhaseTime> phases() const { return passes_.phases(); }
  Model model() const;

  /// The state at the present instant as a sample for another simulation. This one cannot be continued.
  Prepared hand_over();

  /// Saves the complete state, between two steps. All ranks must call this; the archive of the first one gets it.
  void save(Archive& archive);
  /// Continues with identical results from the saved state of a kernel of the same scene; `scene`: its settings then.
  void restore(const SceneDescription& scene, const Components& components, Archive& archive);

 private:
  void apply(const SceneDescription& scene, const Components& components);
  void take_settings(const SceneDescription& scene, const Components& components);
  /// Before the first settings.
  void take_sample(const SceneDescription& scene, const Components& components, SampleState& sample);
  /// Advances the velocities of half a step ago to the present instant.
  void synchronise_velocities();
  void take_walls(const SceneDescription& scene, const Components& components);
  /// Adds the bodies of streams that enter now.
  void let_in();
  /// Appends new bodies; the next forces need a neighbour search.
  void append(const Bodies& arriving);
  void admit(const SceneDescription& scene, const Components& components);
  /// Adds bodies from this one on to the statistics, and allocates their state.
  void count_in(std::size_t first, std::size_t first_clump);
  void serialize(Archive& archive);
  void serialize_fields(Archive& archive);

  State state_;
  mutable Passes passes_;  // const functions use threads, too
  WorldView view_;
  EnergyBalance balance_;
  EnergyGuard guard_;
  Stepper stepper_;
  Bodies smallest_bodies_;  // of groups that appear during the run
  Inflow inflow_;
};

}  // namespace grit
