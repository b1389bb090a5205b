// Times as text.
#pragma once

#include <string>

namespace grit {

/// Simulated time: "1.2 s", "69.23 ms", "3.4 µs", with four digits.
std::string written_time(double seconds);

/// Remaining computing time: "42 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

/// Used computing time: "0.52 s", "12 min", "3.5 h".
std::string cost_text(double seconds);

}  // namespace grit
