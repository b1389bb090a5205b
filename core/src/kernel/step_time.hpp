// Where a simulation is in time.
#pragma once

#include <cstdint>

#include "grit/memory.hpp"

namespace grit {

struct StepTime {
  double time = 0;  ///< s since the start of the run
  std::uint64_t step = 0;
  double dt = 0;           ///< of the next step [s]
  double previous_dt = 0;  ///< of the last step [s]; 0 before the first

  void remember(Memory& memory) { memory(time, step, dt, previous_dt); }
};

}  // namespace grit
