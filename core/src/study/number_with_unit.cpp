#include "study/number_with_unit.hpp"

#include <spdlog/fmt/fmt.h>

#include <charconv>
#include <cmath>

#include "input/units.hpp"

namespace grit {

std::optional<NumberWithUnit> number_with_unit(const std::string& text) {
  NumberWithUnit one;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), one.number);
  if (error != std::errc() || !std::isfinite(one.number)) return std::nullopt;
  one.unit = std::string(end, text.data() + text.size());
  if (!one.unit.empty() && one.unit.front() != ' ') return std::nullopt;  // a name, such as "3d"
  one.unit.erase(0, one.unit.find_first_not_of(' '));
  return one;
}

std::optional<double> number_in(const std::string& unit, const Description& written) {
  if (written.is_number()) return written.get<double>();
  if (!written.is_string() || unit.empty()) return std::nullopt;
  const auto quantity = parse_quantity(written.get<std::string>(), unit);
  return quantity && std::isfinite(quantity->value) ? std::optional(quantity->value) : std::nullopt;
}

std::string numbers_in(const std::string& unit) {
  return unit.empty()  ? "a number in the unit of the channel"
         : unit == "1" ? "a number, or a text such as \"5 %\": the channel has no unit"
                       : fmt::format("a number in {}, or a text with a number and one of {}", unit, unit_list(unit));
}

}  // namespace grit
