// A simulation without stages, output or files: a state, and all that makes it go on.
#pragma once

#include <string>
#include <vector>

#include "kernel/energy_balance.hpp"
#include "kernel/energy_guard.hpp"
#include "kernel/model.hpp"
#include "kernel/passes.hpp"
#include "kernel/state.hpp"
#include "kernel/stepper.hpp"
#include "kernel/world_view.hpp"

namespace grit {

class Kernel {
 public:
  /// Starts with the bodies of the scene, with the state that its components ask for.
  Kernel(const SceneDescription& scene, const Components& components, Bodies bodies, unsigned threads);

  /// Begins a stage with the settings of `scene`, which has the same materials, walls and bodies as the first. Lets in
  /// bodies that appear in it. Throws NumericsError where they find no room, or overlap others or walls by more than
  /// they may; then they are not there.
  void begin_stage(const std::string& name, const SceneDescription& scene, const Components& components);
  /// Checks the guards that are not checked at each step. Throws NumericsError if one trips.
  void end_stage() { guard_.check(state_, balance_); }
  /// Changes settings within a stage.
  void change(const SceneDescription& scene, const Components& components);

  void find_forces() { stepper_.find_forces(); }
  void advance() { stepper_.advance(); }
  void step_on() { stepper_.step_on(); }
  /// Has the next forces search neighbours, whether or not it is due.
  void request_rebuild() { state_.lists.request_rebuild(); }

  const State& state() const { return state_; }
  const WorldView& world() const { return view_; }
  double critical_time_step() const { return stepper_.time_step().critical(); }
  /// Kinetic over elastic energy; infinite where none is stored.
  double kinetic_energy_ratio() const;
  double body_steps() const { return stepper_.body_steps(); }
  unsigned threads() const { return passes_.threads(); }
  std::vector<PhaseTime> phases() const { return passes_.phases(); }
  Model model() const;

  /// Saves everything, between two steps.
  void save(Memory& memory);
  /// Goes on, to the same bits, where a kernel of the same scene was saved, `scene` being its settings then.
  void restore(const SceneDescription& scene, const Components& components, Memory& memory);

 private:
  void apply(const SceneDescription& scene, const Components& components);
  void take_settings(const SceneDescription& scene, const Components& components);
  void take_walls(const SceneDescription& scene, const Components& components);
  /// Stops what moves out of a plane.
  void flatten(int axis);
  /// Lets bodies take part in the mean flow of a cell from its first instant.
  void change_strain_rate(const Vec3& rate);
  void admit(const SceneDescription& scene, const Components& components);
  /// Counts bodies from this one on, and makes room for them.
  void count_in(std::size_t first, std::size_t first_clump);
  void remember(Memory& memory);

  State state_;
  mutable Passes passes_;  // threads also share what is asked of a const kernel
  WorldView view_;
  EnergyBalance balance_;
  EnergyGuard guard_;
  Stepper stepper_;
};

}  // namespace grit
