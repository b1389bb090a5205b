// Bodies that appear in a stage.
#pragma once

#include <vector>

#include "bodies/make_bodies.hpp"
#include "grit/world.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Adds the mean flow to the velocities of new bodies, and shifts them to half a step ago, as for all others.
void match_velocities(Bodies& arriving, const State& state);

/// Energy of new bodies now [J], after match_velocities().
struct EnteredEnergy {
  double kinetic = 0, potential = 0;  ///< potential: relative to the origin
};
EnteredEnergy energy_of(const Bodies& arriving, const State& state);

/// Throws NumericsError for the deepest overlap of a new body with an old one or a wall that exceeds the limit of its
/// group.
void check_arrivals(const State& state, const World& world, const std::vector<Newcomers::Group>& groups);

}  // namespace grit
