// Walls that move so far in a step that they pass bodies.
#pragma once

#include <cstddef>

#include "kernel/passes.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Whether the surface approaches any body, near or far, by more than guards/travel in a step in which it moves up to
/// `distance` [m], which is more than a radius: bodies may be passed that were not near.
bool passes_bodies(const State& state, std::size_t wall, const WallMotion& motion, double dt, double distance,
                   Passes& passes);

}  // namespace grit
