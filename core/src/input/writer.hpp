// From what was declared back to JSON.
#pragma once

#include <optional>

#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// All present values of a declaration, defaults too, numbers in SI; reading them gives the same values. What is
/// optional and absent, and choices that were not made, are left out. Values of free form stay as they were read.
Description write(Parameters& parameters);

/// The value of one parameter; nothing if it is absent.
std::optional<Description> write(const Parameter& parameter);

}  // namespace grit
