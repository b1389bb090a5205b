// Densities that change when the bodies are made already.
#pragma once

#include <vector>

#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message for each change and ramp of a density by a stage with which no body is made: bodies keep their masses.
std::vector<UnusedSetting> late_densities(const Scene& scene);

}  // namespace grit
