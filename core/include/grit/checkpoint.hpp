// Where a simulation was, and all that it needs to go on to the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace grit {

struct Checkpoint {
  std::string stage;
  double time = 0;  ///< simulated [s]
  std::uint64_t step = 0;
  std::vector<std::byte> memory;
};

}  // namespace grit
