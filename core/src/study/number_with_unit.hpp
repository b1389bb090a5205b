// Numbers with their units, as studies and calibrations write them.
#pragma once

#include <optional>
#include <string>

#include "grit/description.hpp"

namespace grit {

/// A number and its unit, as in "20 deg".
struct NumberWithUnit {
  double number = 0;
  std::string unit;  ///< as written; empty without one
};

/// Nothing for another text, or a number that is not finite.
std::optional<NumberWithUnit> number_with_unit(const std::string& text);

/// A value as written, in the unit of its channel: a number is in it, a text has one that converts. `unit`: empty if it
/// is not known, so that a text has no number. Nothing for anything else, and for what is not finite.
std::optional<double> number_in(const std::string& unit, const Description& written);
/// What number_in() takes, for messages.
std::string numbers_in(const std::string& unit);

}  // namespace grit
