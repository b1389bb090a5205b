// Whether sections of a description contradict each other.
#pragma once

#include "description/description.hpp"

namespace grit {

/// Reports density scaling together with growth.
void check_growth(const SceneDescription& scene, const Complain& complain);
/// Reports groups from a sample without one, settings that the sample gives, and a sample of which no group is used.
void check_sample(const SceneDescription& scene, const Complain& complain);
/// Walls and sources of bodies know no images off the axes.
void check_shear(const SceneDescription& scene, const Complain& complain);

}  // namespace grit
