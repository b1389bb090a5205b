// A depth that costs more than it tells.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "description/components.hpp"
#include "grit/world.hpp"
#include "input/scene.hpp"
#include "study/advice.hpp"

namespace grit {

/// One line, with the pointer, if the scene is at least twice as deep as what shows beside the scatter between samples:
/// by one of `studies`, if it varied the depth of scenes like this; else by 1/√contacts. `same(sets)`:
/// whether the description stays the same with these.
std::optional<std::string> excess_depth(const Scene& described, const Components& components, const World& world,
                                        const std::string& scenario, const std::vector<ChartedStudy>& studies,
                                        const std::function<bool(const std::vector<std::string>&)>& same);

}  // namespace grit
