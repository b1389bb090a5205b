#include "lint/unused_scenario_parameters.hpp"

#include "lint/small_changes.hpp"

namespace grit {

std::vector<std::string> unused_scenario_parameters(const Document& written,
                                                    const std::function<bool(const std::vector<std::string>&)>& same) {
  std::vector<std::string> lines;
  if (!written.json().contains("scenario")) return lines;
  for (const auto& [key, value] : written.json().at("scenario").items()) {
    const std::string pointer = "/scenario/" + key;
    if (changes_nothing(value, [&](const std::string& other) { return same({pointer + '=' + other}); }))
      lines.push_back(pointer + ": the scene is the same with a little more or less of it");
  }
  return lines;
}

}  // namespace grit
