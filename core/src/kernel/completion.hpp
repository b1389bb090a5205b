// What a rank lacks of the state of bodies that others, or a device, move.
#pragma once

#include "kernel/passes.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Takes what other ranks have sent of bodies near own ones, after the last motion. Nothing if that has been done.
void take_halo(State& state, Passes& passes);
/// Completes the bodies if those of other ranks, or on a device, have moved; all ranks must call this.
void complete_bodies(State& state, Passes& passes);
/// The same if a device has moved them; this may be called on one rank only.
void fetch_bodies(State& state, Passes& passes);
/// The same of the sums of contact forces.
void complete_sums(State& state, Passes& passes);

}  // namespace grit
