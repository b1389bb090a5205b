#include "app/idle_scenario.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdlib>
#include <optional>

#include "grit/error.hpp"

namespace grit {
namespace {

constexpr double little = 0.01;

/// A number, or one with its unit as a text, times `factor`; as JSON. Nothing for all else, and for 0.
std::optional<std::string> scaled(const Description& value, double factor) {
  if (value.is_number() && value != 0.0) return fmt::format("{:.17g}", factor * value.get<double>());
  if (!value.is_string()) return std::nullopt;
  const auto text = value.get<std::string>();
  char* unit = nullptr;
  const double number = std::strtod(text.c_str(), &unit);
  if (unit == text.c_str() || number == 0) return std::nullopt;
  return Description(fmt::format("{:.17g}{}", factor * number, unit)).dump();
}

}  // namespace

std::vector<std::string> idle_scenario(const Document& written,
                                       const std::function<bool(const std::vector<std::string>&)>& same) {
  std::vector<std::string> lines;
  if (!written.json().contains("scenario")) return lines;
  for (const auto& [key, value] : written.json().at("scenario").items()) {
    const std::string pointer = "/scenario/" + key;
    bool tried = false, idle = true;
    for (const double factor : {1 + little, 1 - little}) {
      const auto other = scaled(value, factor);
      if (!other) continue;
      try {
        idle = idle && same({pointer + '=' + *other});
        tried = true;
      } catch (const DescriptionError&) {  // beyond what is allowed, or no whole number
      }
    }
    if (tried && idle)
      lines.push_back(fmt::format("{}: the scene is the same with {:.0f} % more or less of it", pointer, 100 * little));
  }
  return lines;
}

}  // namespace grit
