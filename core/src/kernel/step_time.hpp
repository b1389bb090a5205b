// Time, step number and time step of a simulation, and whether time advances.
#pragma once

#include <cstdint>

#include "grit/archive.hpp"

namespace grit {

/// Whether a step of `dt` [s] changes the time: double precision loses steps that are too short.
constexpr bool advances(double time, double dt) { return time + dt > time; }

struct StepTime {
  double time = 0;  ///< since the start of the run [s]
  std::uint64_t step = 0;
  double dt = 0;           ///< of the next step [s]
  double previous_dt = 0;  ///< of the last step [s]; 0 before the first

  void serialize(Archive& archive) { archive(time, step, dt, previous_dt); }
};

}  // namespace grit
