// Components with parameters and nothing behind them: what descriptions in these tests choose from.
#pragma once

#include "plugins/registry.hpp"

namespace grit {

/// Two contact laws with different materials ("spring", "glue"), a body ("sphere"), geometries ("plane", "mesh"),
/// engines
/// ("gravity", "damping"), a probe ("curve"), scenarios ("pile", which takes no more than 1000 grains, and "careless",
/// whose expansion has mistakes).
void add_components(Registry& registry);

}  // namespace grit
