// Values of materials and interfaces that affect no contact.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// Values for which small changes leave the parameters of all possible contacts unchanged in all stages. Checks values
/// for which `is_written(pointer)`.
std::vector<UnusedSetting> unused_materials(const Scene& scene,
                                            const std::function<bool(const std::string&)>& is_written);

}  // namespace grit
