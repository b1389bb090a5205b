// Declarations for people: what `grit describe` prints and the reference pages hold.
#pragma once

#include <string>

#include "grit/parameters.hpp"

namespace grit {

/// A table, a line a parameter: name, symbol, type or unit, default in a friendly unit, what is allowed, doc. What lies
/// in an object is indented below it; of a choice, every type. Declarations are used up: lists get an entry, choices
/// are made.
std::string reference_text(Parameters& parameters);

}  // namespace grit
