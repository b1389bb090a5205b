// Quantities: numbers are SI, texts carry a unit. One table says which units; kernel and schema both go by it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace grit {

/// How a unit may be written where `unit` (SI, UDUNITS spelling) is meant. Never empty; "" stands for no unit at all.
/// A unit that is not in the table has only its own spelling. All functions here may be called from several threads.
/// They throw FileError if the UDUNITS-2 database cannot be read, PluginError if it does not know a declared unit.
std::vector<std::string> unit_spellings(const std::string& unit);

/// The same as a list for messages: "Pa, kPa, MPa".
std::string unit_list(const std::string& unit);

/// The regular expression (ECMAScript, anchored) of all texts that are quantities of `unit`.
std::string quantity_pattern(const std::string& unit);

/// A quantity as somebody wrote it.
struct Quantity {
  double value;          ///< SI; infinite if the number is too large
  std::string spelling;  ///< of the unit, one of unit_spellings()
};

/// Reads a text such as "200 kPa". Factors that are powers of ten are exact: "0.3 mm" is the double next to 3e-4.
/// Nothing if the text does not match quantity_pattern().
std::optional<Quantity> parse_quantity(const std::string& text, const std::string& unit);

/// `value` (SI) as a number of `spelling`s of `unit`, to six digits: "200 kPa". Infinite values keep their sign.
std::string quantity_text(double value, const std::string& unit, const std::string& spelling);

/// The same in the spelling that reads best.
std::string friendly_text(double value, const std::string& unit);

}  // namespace grit
