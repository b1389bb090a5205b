// A depth that costs more than it tells.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "grit/world.hpp"
#include "input/scene.hpp"

namespace grit {

/// One line, with the pointer, if the scene is at least twice as deep as what shows beside the scatter between samples:
/// by a study that came with grit, if one of scenes like this varied the depth; else by 1/√contacts. `same(sets)`:
/// whether the description stays the same with these.
std::optional<std::string> too_deep(const Scene& described, const World& world, const std::string& scenario,
                                    const std::function<bool(const std::vector<std::string>&)>& same);

}  // namespace grit
