// JSON from files that others may have written.
#pragma once

#include <string>

#include "grit/description.hpp"

namespace grit {

/// A text as JSON; a discarded value if it is not JSON, or has lists and objects inside each other at more than 100
/// levels, which could not be copied.
Description parsed_json(const std::string& text);

}  // namespace grit
