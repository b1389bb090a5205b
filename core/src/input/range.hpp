// The allowed values of a declaration as text.
#pragma once

#include <string>

#include "grit/parameters.hpp"

namespace grit {

/// The declared range in one spelling of the unit: "above 0 kPa", "from 0 deg to below 90 deg"; "any finite
/// number" if there is none.
std::string range_text(const Parameter& parameter, const std::string& spelling);

}  // namespace grit
