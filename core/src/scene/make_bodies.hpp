// From a description's groups of grains to bodies.
#pragma once

#include "grit/world.hpp"
#include "scene/bodies.hpp"
#include "scene/description.hpp"

namespace grit {

/// All state of bodies that a component of the scene, or `also`, asks for.
StateRequest requested_state(const SceneDescription& scene, StateRequest also = {});

/// The bodies of all groups, in the order of their names; ids count through. Throws as the sources of grains do.
Bodies make_bodies(const SceneDescription& scene, StateRequest state);

}  // namespace grit
