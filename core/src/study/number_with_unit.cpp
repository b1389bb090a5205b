#include "study/number_with_unit.hpp"

#include <charconv>
#include <cmath>

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

}  // namespace grit
