// Walls across periodic sides.
#pragma once

#include "kernel/state.hpp"

namespace grit {

/// A wall that extends over exactly one period counts as endless along that axis: contacts are found at positions of
/// bodies within it. Throws NumericsError for a wall that ends near a periodic side otherwise, as walls have no images.
void repeat_walls(State& state);

}  // namespace grit
