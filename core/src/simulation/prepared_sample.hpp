// A prepared sample: the state of another run, from which a run begins.
#pragma once

#include "grit/world.hpp"
#include "kernel/prepared.hpp"
#include "simulation/live_scene.hpp"

namespace grit {

class Registry;

/// Restores the run that /begin of a scene names, and takes over its bodies, contacts, walls and cell. Materials of
/// bodies are those of the scene; masses follow their densities and the density scaling of the scene. A wall with
/// another geometry starts as described. Throws PlacedError for what cannot be taken over: a group that one of the two
/// lacks or that has another shape, a field of the contact history that the law does not have, another periodic domain;
/// FileError.
Prepared prepared_sample(const LiveScene& live, const Registry& registry, StateRequest state);
/// From which a simulation starts: a sample, or the bodies of the description.
Prepared prepare(const LiveScene& live, const Registry& registry, StateRequest state);

}  // namespace grit
