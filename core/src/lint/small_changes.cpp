#include "lint/small_changes.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdlib>
#include <vector>

#include "grit/error.hpp"

namespace grit {
namespace {

constexpr double little = 0.01;

std::vector<std::string> others(const Description& value) {
  std::string text;
  if (value.is_string()) text = value.get<std::string>();
  char* unit = text.data();
  const double number = value.is_number() ? value.get<double>() : std::strtod(text.c_str(), &unit);
  if (number == 0 || (value.is_string() && unit == text.data())) return {};
  std::vector<std::string> all;
  for (const double factor : {1 + little, 1 - little}) {
    const std::string scaled = fmt::format("{:.17g}{}", factor * number, unit);
    all.push_back(value.is_string() ? Description(scaled).dump() : scaled);
  }
  if (value.is_number_integer()) all.push_back(fmt::format("{:.0f}", number + 1));
  return all;
}

}  // namespace

bool changes_nothing(const Description& value, const std::function<bool(const std::string&)>& same) {
  if (!value.is_number() && !value.is_string()) return false;
  bool tried = false, idle = true;
  for (const std::string& other : others(value)) {
    try {
      idle = idle && same(other);
      tried = true;
    } catch (const Error&) {  // out of range, not an integer, or the name of a missing file
    }
  }
  return tried && idle;
}

}  // namespace grit
