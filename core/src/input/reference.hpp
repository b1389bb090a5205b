// Declarations as text: the output of `grit describe` and the reference pages.
#pragma once

#include <string>

#include "grit/parameters.hpp"

namespace grit {

/// A table with one parameter per line: name, symbol, type or unit, default in a readable unit, allowed values, doc.
/// The parameters of an object are indented below it; of a choice, every type is listed. Modifies the declarations:
/// lists get an entry, choices are made.
std::string reference_text(Parameters& parameters);

}  // namespace grit
