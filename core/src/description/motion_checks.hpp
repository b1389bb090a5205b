// Whether the engines that set the motion of bodies contradict each other.
#pragma once

#include "description/description.hpp"

namespace grit {

/// Reports pairs of engines that set the motion of a group differently, so that the result would depend on their names,
/// and prescribed motions along axes that another engine holds.
void check_motions(const SceneDescription& scene, const Complain& complain);

}  // namespace grit
