// Numbers with their units, as studies and calibrations write them.
#pragma once

#include <optional>
#include <string>

namespace grit {

/// A number and its unit, as in "20 deg".
struct NumberWithUnit {
  double number = 0;
  std::string unit;  ///< as written; empty without one
};

/// Nothing for another text, or a number that is not finite.
std::optional<NumberWithUnit> number_with_unit(const std::string& text);

}  // namespace grit
