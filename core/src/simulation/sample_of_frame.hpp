// A frame of another run as a sample.
#pragma once

#include "grit/world.hpp"
#include "kernel/prepared.hpp"
#include "simulation/live_scene.hpp"

namespace grit {

class Registry;

/// As prepared_sample(), from the frame that /begin names: bodies, clumps, walls and cell. Masses are those of the
/// scene. Velocities are half a step older than positions; contacts have no history. Throws PlacedError also for a
/// frame that does not exist, and for bodies of another kind or shape.
Prepared sample_of_frame(const LiveScene& live, const Registry& registry, StateRequest state);

}  // namespace grit
