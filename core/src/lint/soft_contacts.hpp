// Materials that are too soft for the stresses of a run.
#pragma once

#include <vector>

#include "grit/world.hpp"
#include "input/scene.hpp"
#include "lint/unused_setting.hpp"

namespace grit {

/// A message for each material of the present bodies whose contacts would overlap by more than a tenth of the radius
/// under the largest target of a servo, or under the weight of all present bodies.
std::vector<UnusedSetting> soft_contacts(const Scene& described, const World& world);

}  // namespace grit
