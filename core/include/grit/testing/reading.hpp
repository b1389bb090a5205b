// Functions of grit that the tests of plugins need: reading keys into parameters, and units.
#pragma once

#include <string>
#include <vector>

#include "grit/description.hpp"
#include "grit/error.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// Reads an object of a description into declared parameters and runs their checks. Returns all problems; parameters
/// with a problem keep their defaults.
std::vector<Problem> read_parameters(const Description& keys, Parameters& parameters);

/// Whether UDUNITS-2 knows the unit; true for "1", false for "".
bool is_unit(const std::string& text);

}  // namespace grit
