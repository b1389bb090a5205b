// Numbers and sentences of a chart, as people like to read them.
#pragma once

#include <string>

namespace grit {

struct Chart;

/// "2.1 %"; "?" where it cannot be told.
std::string percent(double share);

/// A ratio with three digits.
std::string times(double ratio);

/// "42 s", "12 min", "3.5 h".
std::string cost_text(double seconds);

/// One sentence or two: the cheapest variant that is good enough, and what it saves.
std::string verdict(const Chart& chart);

}  // namespace grit
