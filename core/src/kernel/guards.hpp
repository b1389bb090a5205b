// Guards on overlaps, periods and growth.
#pragma once

#include "grit/world.hpp"
#include "kernel/state.hpp"

namespace grit {

/// Throws NumericsError, naming the deepest contact, if the largest overlap over a radius is above /guards/overlap.
void check_overlap(const State& state, const World& world);
/// Throws NumericsError if a period is too short for the largest body and its skin.
void check_periods(const State& state);
/// Throws NumericsError if surfaces move by `distance` [m] in one step because bodies grow, more than /guards/travel.
void check_growth(const State& state, double distance);

}  // namespace grit
