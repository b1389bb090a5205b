// The complete state of a simulation, from which it continues with identical results (bit for bit).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace grit {

/// A saved state, with the instant to which it belongs.
struct Checkpoint {
  std::string stage;             ///< name of the stage that was running
  double time = 0;               ///< simulated [s]
  std::uint64_t step = 0;        ///< since the start of the run
  std::vector<std::byte> state;  ///< of all bodies, contacts, walls and components
};

}  // namespace grit
