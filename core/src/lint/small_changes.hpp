// Tests whether a value has an effect by small changes.
#pragma once

#include <functional>
#include <string>

#include "grit/description.hpp"

namespace grit {

/// Whether `same("other value, as JSON")` holds with the number, or number with unit, changed by ±1 %, and an integer
/// also by +1. False for 0, for other types, and if no other value is allowed.
bool changes_nothing(const Description& value, const std::function<bool(const std::string&)>& same);

}  // namespace grit
