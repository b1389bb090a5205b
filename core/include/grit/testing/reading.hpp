// What contracts need of the kernel: reading keys into parameters, and units.
#pragma once

#include <string>
#include <vector>

#include "grit/description.hpp"
#include "grit/error.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// Reads keys, as an object of a description has them, into declared parameters, and runs their checks. Returns every
/// problem; parameters with a problem keep their defaults.
std::vector<Problem> read_parameters(const Description& keys, Parameters& parameters);

/// Whether UDUNITS-2 knows the unit; "1" is one, "" is none.
bool is_unit(const std::string& text);

}  // namespace grit
