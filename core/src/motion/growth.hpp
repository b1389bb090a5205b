// Growth of bodies.
#pragma once

#include <cstddef>

#include "bodies/bodies.hpp"

namespace grit {

/// Multiplies all lengths of the bodies of one chunk by `factor`, masses by its cube and moments of inertia by its
/// fifth power. Velocities and spins stay. The arms of spheres of clumps grow by the same factor.
void grow_bodies(std::size_t chunk, Bodies& bodies, double factor);

/// The same for the properties of clumps as a whole.
void grow_clumps(Bodies& bodies, double factor);

}  // namespace grit
