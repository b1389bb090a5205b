// One step: neighbours, forces, motion.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bodies/make_bodies.hpp"
#include "contact/readiness.hpp"
#include "kernel/cell_servo.hpp"
#include "kernel/displacement_bounds.hpp"
#include "kernel/energy_guard.hpp"
#include "kernel/sharing.hpp"
#include "kernel/time_step_control.hpp"
#include "kernel/world_view.hpp"

namespace grit {

class Stepper {
 public:
  Stepper(State& state, Passes& passes, WorldView& view, EnergyBalance& balance, EnergyGuard& guard)
      : state_(state), passes_(passes), view_(view), balance_(balance), guard_(guard) {}

  /// Forces at the present instant, after a neighbour search if one is due. Throws NumericsError if a guard trips.
  void find_forces();
  /// One step; find_forces() must have been called at this instant. Throws NumericsError if a guard trips.
  void advance();
  /// find_forces() and advance() with identical results, in one pass over the bodies if nothing needs the forces of all
  /// bodies in between. Forces are then undefined until find_forces() is called again. Throws NumericsError if a guard
  /// trips, with the forces of that instant.
  void step_on();
  /// Forces at the present positions, after a guard tripped.
  void show_forces();
  /// Brings what a device has of bodies and contacts, if it has moved since.
  void fetch_from_device();
  /// Before saving: makes bodies and contacts those of the device again, if there is one. Returns the contacts that
  /// this process has evaluated at this instant, if it has.
  std::optional<ContactTable> recall();
  /// Makes these contacts, of recall(), the present ones again.
  void take_back(ContactTable evaluated);

  /// After a change of settings or bodies: recomputes the time step and values of material pairs.
  void settings_changed();
  void bodies_changed() { time_step_.update_stiffening(state_); }
  /// Bodies of these groups have been appended; the next neighbour search checks and sorts them.
  void expect(std::vector<Newcomers::Group> arrivals) { arrivals_ = std::move(arrivals); }
  bool expects_arrivals() const { return !arrivals_.empty(); }
  const TimeStepControl& time_step() const { return time_step_; }
  /// Particle-steps so far.
  double body_steps() const { return body_steps_; }
  /// All ranks must call collect_sharing() before.
  void collect_sharing();
  Sharing sharing() const { return sharing_.sharing(passes_.imbalance()); }

  void serialize(SharedArchive& archive);
  /// After the state has been restored. Throws Error unless this fits it.
  void restored();

 private:
  /// Operations before contacts.
  void prepare();
  /// Whether contacts have been evaluated at this instant before. Contact histories advance once per step, even if
  /// forces are evaluated again at the start of a stage.
  bool evaluated_before();
  /// Searches neighbours or renews the time step, where bodies have moved far enough.
  void follow_bodies();
  void rebuild();
  /// Whether each rank rebuilds with all bodies: some parts need them.
  bool rebuilds_whole() const;
  /// Moves bodies back into a periodic cell. Returns which ones leave; unless `whole`, of own ones.
  std::vector<bool> wrap_bodies(bool whole);
  /// Records bodies that leave.
  void discharge(const std::vector<bool>& leaves, bool whole);
  /// Sorts bodies in space without those that leave, and divides them among the ranks again.
  Renumbering sort_bodies(const std::vector<bool>& leaves, bool some_leave, bool whole);
  /// Finds candidates at walls again; neighbour lists stay.
  void search_at_walls();
  /// Marks the bodies that engines remove.
  void mark_removed(std::vector<bool>& leaves) const;
  void update_surfaces();
  /// Contacts within one chunk.
  void evaluate_within(std::size_t chunk, bool again, BodySum* sum, Laps& laps);
  /// After these, its contacts with other chunks and with walls.
  void evaluate_across(std::size_t chunk, bool again, BodySum* sum, Laps& laps);
  void move(std::size_t chunk, const BodySum* sum, const MotionStep& step);
  /// Begins to update bodies of other ranks near own ones; see take_halo().
  void bodies_moved();
  void sum_forces(bool again);
  void check_finite(const ActingEngine& one, std::span<const Row> force, std::span<const Row> moment) const;
  void add_forces_of_engines();
  void find_extremes();
  /// Collects the results of chunks for walls and guards; `for_time_step`: and for the time step.
  void take_loads(bool for_time_step);
  bool can_move_at_once() const;
  /// Sends bodies and contacts, if they have changed here.
  void send_to_device();
  /// Forces and motion on the device.
  void step_on_device();
  void grow();
  /// Sets the strain rate that keeps the stresses of the cell.
  void drive_cell();
  void move_clumps_of_chunks(const MotionStep& step);
  /// Operations after the motion of bodies.
  void end_step();
  template <class Work>
  void and_show_forces(Work work);

  State& state_;
  Passes& passes_;
  WorldView& view_;
  EnergyBalance& balance_;
  EnergyGuard& guard_;
  TimeStepControl time_step_;
  DisplacementBounds bounds_;
  CellServo cell_servo_;
  Readiness readiness_;
  std::vector<Newcomers::Group> arrivals_;  // since the last rebuild, with their first ids
  std::vector<std::size_t> late_;           // chunks that could not move at once
  std::vector<WallLoad> loads_;
  static constexpr std::uint64_t never = ~0ull;
  std::uint64_t forces_step_ = never;  // step at which contacts were last updated
  bool device_is_ahead_ = false;       // it has moved bodies since they were brought home
  double body_steps_ = 0;
  SharingRecord sharing_;
};

}  // namespace grit
