// What a rank lacks of the state of bodies that others move.
#pragma once

#include "kernel/passes.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Completes the bodies if those of other ranks have moved; all ranks must call this.
void complete_bodies(State& state, Passes& passes);
/// The same of the sums of contact forces.
void complete_sums(State& state, Passes& passes);

}  // namespace grit
