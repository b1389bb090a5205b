// Quantities: numbers are SI, texts have a unit. Reader and schema share one table of units.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace grit {

/// Allowed spellings of units that convert to `unit` (SI, UDUNITS spelling). Never empty; "" is no unit. A unit outside
/// the table has only its own spelling. All functions here may be called from several threads.
/// They throw FileError if the UDUNITS-2 database cannot be read, PluginError if it does not know a declared unit.
std::vector<std::string> unit_spellings(const std::string& unit);

/// The same as a list for messages: "Pa, kPa, MPa".
std::string unit_list(const std::string& unit);

/// The regular expression (ECMAScript, anchored) of all texts that are quantities of `unit`.
std::string quantity_pattern(const std::string& unit);

/// Whether UDUNITS-2 knows a unit, of the table or not; true for "1", false for "".
bool is_unit(const std::string& text);

/// A quantity as written.
struct Quantity {
  double value;          ///< SI; infinite if the number is too large
  std::string spelling;  ///< of the unit, one of unit_spellings()
};

/// Reads a text such as "200 kPa". Factors that are powers of ten are exact: "0.3 mm" is the double next to 3e-4.
/// Empty if the text does not match quantity_pattern().
std::optional<Quantity> parse_quantity(const std::string& text, const std::string& unit);

/// `value` (SI, in `unit`) in the unit `spelling`, to six digits: "200 kPa". Infinite values keep their sign.
std::string quantity_text(double value, const std::string& unit, const std::string& spelling);

/// The same in the unit with the shortest text.
std::string friendly_text(double value, const std::string& unit);

}  // namespace grit
