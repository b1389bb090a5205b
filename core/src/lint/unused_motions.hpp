// Settings of wall motions without effect.
#pragma once

#include <string>
#include <vector>

#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

std::vector<UnusedSetting> unused_motions(const Scene& described);

}  // namespace grit
