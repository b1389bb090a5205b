// What a world remembers from one step to the next.
#include "run/component_memory.hpp"
#include "run/simulation.hpp"

namespace grit {

template <>
inline constexpr bool plain_numbers<Cell> = true;
template <>
inline constexpr bool plain_numbers<ImageShift> = true;
template <>
inline constexpr bool plain_numbers<Departure> = true;

void Clock::remember(Memory& memory) {
  memory(time, step, time_step, last_time_step, critical_time_step, contact_demand, wall_demand, forces_step);
  memory(cell, period_before, rebuilds, skins, strain_travel, wall_speed, wall_closing, last_approach);
  memory(overlap, pressed_overlap, stepped_overlap, stepped_speed);
}

void Simulation::save(Memory& memory) {
  memory(walls_);
  remember(memory);
}

void Simulation::restore(const SceneDescription& scene, Memory& memory) {
  memory(walls_);
  walls_.change(scene);  // as they stand and move now
  take_settings(scene);
  remember(memory);
  growth_rate_ = growth_rate_of(stage_);
  sum_.assign(bodies_.count() + 1, {});
  readiness_.build(pairs_.reached());
  tell_walls_of_specimen();
  forget_views();
}

/// But for walls, which come first, and for what is worked out anew in every step: sums, loads, surfaces. Newcomers are
/// bodies as others before the step ends.
void Simulation::remember(Memory& memory) {
  memory(stage_, clock_, energy_, flows_, bodies_, pairs_, wall_contacts_, critical_);
  memory(reference_, reference_cell_, shifts_, arms_, departures_, stock_, mass_left_);
  memory(search_now_, time_step_now_, soft_until_, grown_);
  memory(body_steps_, passes_);
  for (PhaseTime& phase : phases_) memory(phase.seconds);
  chunk_.resize(chunks_of(bodies_.count()));
  for (Chunk& chunk : chunk_) memory(chunk.seconds);
  for (const auto& [name, engine] : scene_->engines)
    remember_by_itself("engine \"" + name + '"', *engine.engine, memory);
}

}  // namespace grit
