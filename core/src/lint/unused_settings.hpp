// Settings of a description without effect.
#pragma once

#include <string>
#include <vector>

#include "input/scene.hpp"
#include "kernel/kernel.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// `components` and `kernel` are those of the initial scene.
std::vector<UnusedSetting> unused_settings(const Scene& described, const Components& components, const Kernel& kernel);

}  // namespace grit
