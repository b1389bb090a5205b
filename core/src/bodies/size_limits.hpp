// Sizes and positions of bodies that the arithmetic can hold.
#pragma once

namespace grit {

/// Inverse moments of inertia, and squares of distances in single precision, are finite within these limits [m].
inline constexpr double least_body_radius = 1e-15, most_body_radius = 1e12;
/// Largest distance of a body from the origin along an axis [m].
inline constexpr double most_coordinate = 1e15;

}  // namespace grit
