// Memory that a description needs, before it is taken.
#pragma once

#include "description/components.hpp"
#include "description/description.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// Reports the bodies that a description counts and the available memory cannot hold. Bodies of files are counted when
/// they are read; those of streams may leave again. `components` has the kinds of bodies.
void check_memory(const SceneDescription& scene, const Components& components, const ReportFault& report);

}  // namespace grit
