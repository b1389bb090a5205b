// Memory that bodies take.
#pragma once

#include <string>

namespace grit {

/// Of a body of a dense packing, with its contacts and neighbours [bytes].
inline constexpr double bytes_per_body = 700;

/// Of these, what each rank of a run keeps of all bodies; the rest is of its own ones.
inline constexpr double bytes_on_each_rank = 340;

/// Of each of several ranks that share so many bodies [bytes].
inline double bytes_of_rank(double bodies, unsigned ranks) {
  return bytes_on_each_rank * bodies + (bytes_per_body - bytes_on_each_rank) * bodies / ranks;
}

/// Why this number of bodies does not fit into the available memory [bytes]; empty if it does.
std::string memory_fault(double bodies, double available);

}  // namespace grit
