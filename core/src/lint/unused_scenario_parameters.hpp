// Parameters of a scenario without effect on the scene.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "input/document.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// Parameters for which the scenario expands to the same scene after small changes. Checks numbers that are `written`,
/// except in lists. `same({"/pointer=value"})`: whether the changed scene is the same.
std::vector<UnusedSetting> unused_scenario_parameters(const Document& written,
                                                      const std::function<bool(const std::vector<std::string>&)>& same);

}  // namespace grit
