// Reads JSON into declared parameters.
#pragma once

#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/parameters.hpp"
#include "input/document.hpp"

namespace grit {

/// Pattern of names in a description (ECMAScript, anchored).
inline constexpr const char* name_pattern = "^[A-Za-z0-9_][A-Za-z0-9_.+-]*$";

/// Reads the object at `pointer` of a document into a declaration: first the choice made by its key "type", then the
/// entries in declared order, then the checks. Adds every problem to `problems` and returns whether there was none; a
/// parameter with a problem keeps its default. Throws PluginError if a chosen plugin is not available.
bool read(const Document& document, const std::string& pointer, Parameters& parameters, std::vector<Problem>& problems);

/// The same for one named entry of a section, whose name is checked too.
bool read_entry(const Document& document, const std::string& section, const std::string& name, Parameters& parameters,
                std::vector<Problem>& problems);

/// The same, but throws all problems together as DescriptionError.
void read(const Document& document, Parameters& parameters);

}  // namespace grit
