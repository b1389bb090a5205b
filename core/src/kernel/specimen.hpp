// The box that the specimen fills, from its walls and the cell.
#pragma once

#include "grit/world.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Which side of the surfaces of walls that bodies are not inside of the specimen ends at.
enum class SurfaceSide { near, far };

/// The specimen's box, smaller by `margin` [m] at its walls. Throws Error for a wall that does not exist.
Region specimen_region(const State& state, double margin, SurfaceSide side = SurfaceSide::near);
/// Gives walls whose servo presses on the specimen its present lengths.
void update_cross_section(State& state);

}  // namespace grit
