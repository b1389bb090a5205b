// Memory that bodies take.
#pragma once

#include <string>

namespace grit {

/// Of a body of a dense packing, with its contacts and neighbours [bytes].
inline constexpr double bytes_per_body = 700;

/// Why this number of bodies does not fit into the available memory [bytes]; empty if it does.
std::string memory_fault(double bodies, double available);

}  // namespace grit
