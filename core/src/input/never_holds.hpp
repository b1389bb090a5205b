// Conditions for which a stage would wait until its limit.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "scene/description.hpp"

namespace grit {

/// Calls complain(pointer, message) for each part of a stage's condition that cannot come true, by what the scene is
/// when the stage begins.
void never_holds(const SceneDescription& scene, std::size_t stage,
                 const std::function<void(const std::string& pointer, const std::string& message)>& complain);

}  // namespace grit
