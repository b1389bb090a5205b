// Bodies that become larger where they are.
#pragma once

#include <cstddef>

#include "bodies/bodies.hpp"

namespace grit {

/// Raises all lengths of the bodies of one chunk by `factor`, masses by its cube and moments of inertia by its fifth
/// power. Velocities and spins stay. Spheres of clumps move away from the middle of their clump as much.
void grow_bodies(std::size_t chunk, Bodies& bodies, double factor);

/// The same of what clumps have as a whole.
void grow_clumps(Bodies& bodies, double factor);

}  // namespace grit
