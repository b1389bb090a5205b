// The plain form of a description, as a scenario writes it. The loop never sees it.
#pragma once

#include <nlohmann/json.hpp>

namespace grit {

/// Keys keep the order in which they were written. Numbers are SI.
using Description = nlohmann::ordered_json;

}  // namespace grit
