// Finds a depth that is larger than scatter between samples justifies.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "description/components.hpp"
#include "grit/world.hpp"
#include "input/scene.hpp"
#include "lint/unused_setting.hpp"
#include "study/advice.hpp"

namespace grit {

/// The depth, if half of it or less would give the same results within the scatter between samples: from one of
/// `studies`, if it varied the depth of similar scenes; else estimated as 1/√contacts. `same(sets)`: whether the
/// description is unchanged by these.
std::optional<UnusedSetting> excess_depth(const Scene& described, const Components& components, const World& world,
                                          const std::string& scenario, const std::vector<EvaluatedStudy>& studies,
                                          const std::function<bool(const std::vector<std::string>&)>& same);

}  // namespace grit
