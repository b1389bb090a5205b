// Components with parameters and no function, for the descriptions of these tests.
#pragma once

#include "plugins/registry.hpp"

namespace grit {

/// Two contact laws with different materials ("spring", "glue"), a body ("sphere"), geometries ("plane", "mesh"),
/// engines ("gravity", "damping"), a probe ("curve"), scenarios ("pile", for at most 1000 grains, and "careless", whose
/// expansion has errors).
void add_components(Registry& registry);

}  // namespace grit
