// When a repeated event is due.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "description/description.hpp"
#include "grit/archive.hpp"
#include "kernel/kernel.hpp"

namespace grit {

/// Counts from the start of a stage.
class Schedule {
 public:
  explicit Schedule(const Cadence& cadence) : cadence_(cadence) {}
  void restart(const Kernel& now) {
    first_time_ = now.world().time(), first_step_ = now.world().step(),
    first_discharged_ = now.state().discharged_fraction();
    count_ = 0, level_ = 0, began_ = true, due_ = false;
  }
  /// Decides whether it is due at this step. Call once per step, before the forces: these may change the time step and
  /// remove bodies, so that other observers would otherwise change the steps at which it is due.
  void ask(const Kernel& now) {
    const bool by_time = due_by_time(now), by_mass = due_by_mass(now), by_displacement = due_by_displacement(now);
    due_ = by_time || by_mass || by_displacement || due_by_steps(now);
    if (by_time) ++count_;
    if (by_mass) count_ = static_cast<std::uint64_t>(portions(now)) + 1;  // one step may discharge several portions
    if (by_displacement) level_ += std::trunc(beyond(now)), began_ = false;
  }
  bool is_due() const { return due_; }
  /// The same, and clears it for this step.
  bool take() { return std::exchange(due_, false); }
  void serialize(Archive& archive) {
    archive(first_time_, first_discharged_, level_, first_step_, count_, began_, due_);
  }
  bool never() const { return cadence_.never(); }

 private:
  // Counted, not summed up, so that the instants do not drift.
  bool due_by_time(const Kernel& now) const {
    return cadence_.every_time && now.world().time() >= first_time_ +
                                                            static_cast<double>(count_) * *cadence_.every_time -
                                                            0.5 * now.world().dt();
  }
  bool due_by_steps(const Kernel& now) const {
    return cadence_.every_steps > 0 &&
           (now.world().step() - first_step_) % static_cast<std::uint64_t>(cadence_.every_steps) == 0;
  }
  bool due_by_mass(const Kernel& now) const {
    return cadence_.every_discharged && portions(now) >= static_cast<double>(count_);
  }
  bool due_by_displacement(const Kernel& now) const {
    return cadence_.every_displacement && (began_ || std::abs(beyond(now)) >= 1);
  }

  /// Mass discharged since the stage began, in units of the interval; 1e-9 more, for rounding.
  double portions(const Kernel& now) const {
    return (now.state().discharged_fraction() - first_discharged_) / *cadence_.every_discharged + 1e-9;
  }
  /// Displacement since the last event, in units of the interval, signed; 1e-9 larger, for rounding.
  double beyond(const Kernel& now) const {
    const auto& [wall, axis, value] = *cadence_.every_displacement;
    const Walls& walls = now.state().walls;  // not through World: each step it would make views of all walls
    std::size_t w = 0;
    while (walls.name(w) != wall) ++w;
    const WallState& state = walls.states()[w];
    const double gone = (state.pose.shift - state.stage_start)[axis[0] - 'x'] / value - level_;
    return gone + std::copysign(1e-9, gone);
  }

  Cadence cadence_;
  double first_time_ = 0, first_discharged_ = 0, level_ = 0;
  std::uint64_t first_step_ = 0, count_ = 0;
  bool began_ = true, due_ = false;
};

}  // namespace grit
