// The box of the specimen, from its walls and the cell.
#pragma once

#include "grit/world.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Where the specimen ends at walls with bodies outside: at the near or the far side of their surface.
enum class SurfaceSide { near, far };

/// The box of the specimen, reduced by `margin` [m] at its walls. Throws Error for a wall that does not exist.
Region specimen_region(const State& state, double margin, SurfaceSide side = SurfaceSide::near);
/// Passes the present lengths of the specimen to the walls, for servos whose pressure refers to it.
void update_cross_section(State& state);

}  // namespace grit
