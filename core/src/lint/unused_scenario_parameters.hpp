// Parameters of a scenario that change nothing of the scene.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "input/document.hpp"

namespace grit {

/// One line each, with the pointer and why: with a little more and a little less of it the scenario expands to the
/// same. Of the numbers that are `written`, lists left aside; `same({"/pointer=value"})` tells whether the scene so
/// changed is the same.
std::vector<std::string> unused_scenario_parameters(const Document& written,
                                                    const std::function<bool(const std::vector<std::string>&)>& same);

}  // namespace grit
