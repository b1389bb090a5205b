#include "input/range.hpp"

#include <cmath>

#include "input/units.hpp"

namespace grit {

std::string range_text(const Parameter& parameter, const std::string& spelling) {
  const auto text = [&](double bound) { return quantity_text(bound, parameter.unit(), spelling); };
  const bool low = std::isfinite(parameter.low()), high = std::isfinite(parameter.high());
  const std::string from = low ? text(parameter.low()) : "", to = high ? text(parameter.high()) : "";
  if (low && high)
    return (parameter.low_is_open() ? "above " : "from ") + from + (parameter.high_is_open() ? " to below " : " to ") +
           to;
  if (low) return (parameter.low_is_open() ? "above " : "at least ") + from;
  if (high) return (parameter.high_is_open() ? "below " : "at most ") + to;
  return "any finite number";
}

}  // namespace grit
