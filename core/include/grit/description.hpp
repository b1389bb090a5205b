// A description as JSON, as a file contains it or a scenario writes it. The time loop never uses it.
#pragma once

#include <nlohmann/json.hpp>

namespace grit {

/// Keys keep the order in which they were written. Numbers are SI.
using Description = nlohmann::ordered_json;

}  // namespace grit
