#include "lint/unused_scenario_parameters.hpp"

#include "lint/small_changes.hpp"

namespace grit {

std::vector<UnusedSetting> unused_scenario_parameters(
    const Document& written, const std::function<bool(const std::vector<std::string>&)>& same) {
  std::vector<UnusedSetting> unused;
  if (!written.json().contains("scenario")) return unused;
  for (const auto& [key, value] : written.json().at("scenario").items()) {
    const std::string pointer = "/scenario/" + key;
    if (changes_nothing(value, [&](const std::string& other) { return same({pointer + '=' + other}); }))
      unused.push_back({pointer, "the scene does not depend on it"});
  }
  return unused;
}

}  // namespace grit
