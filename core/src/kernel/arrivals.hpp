// Bodies that appear in a stage.
#pragma once

#include <vector>

#include "bodies/make_bodies.hpp"
#include "grit/world.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Gives bodies that appear the velocity of the mean flow, and velocities of half a step before, as all others have.
void match_velocities(Bodies& arriving, const State& state);

/// Throws NumericsError, with the deepest, if a body of the groups overlaps one that was there before, or a wall, by
/// more than its group allows.
void check_arrivals(const State& state, const World& world, const std::vector<Newcomers::Group>& groups);

}  // namespace grit
