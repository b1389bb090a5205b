// Numbers in messages.
#pragma once

#include <spdlog/fmt/fmt.h>

#include <string>

namespace grit {

inline std::string number(double value) { return fmt::format("{:.4g}", value); }

}  // namespace grit
