#include "simulation/checked_number.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace grit {

std::optional<CheckedNumber> CheckedNumber::find(Parameters& parameters, std::span<const std::string> keys) {
  Declared declared;
  const auto place = find_number(parameters, keys, &declared);
  return place ? std::optional(CheckedNumber(*place, std::move(declared))) : std::nullopt;
}

bool CheckedNumber::set(double value) const {
  if (!is_declared() || !declared_.parameter->allows(value)) return false;
  if (place_.is_integer() && value != std::floor(value)) return false;
  const double before = place_.get();
  place_.set(value);
  bool is_right = true;
  for (const Check& check : declared_.checks)
    check.run([&](std::string_view, std::string_view, std::string_view) { is_right = false; });
  if (!is_right) place_.set(before);
  return is_right;
}

}  // namespace grit
