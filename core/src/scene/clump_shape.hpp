// Volume, centre of mass, inertia and size of a union of spheres.
#pragma once

#include <span>

#include "grit/body_kind.hpp"

namespace grit {

/// A ball: centre, w: radius.
using Ball = Row;

/// The smallest ball that encloses others, of which there is one at least; to round-off. It touches four of them at
/// most, and all sets of four are tried.
Ball smallest_enclosing(std::span<const Ball> balls);

/// Throws grit::Error where spheres do not hang together, are more than 64, or there is none.
void check_clump(std::span<const Ball> spheres);

/// The clump of these spheres, in any unit and frame. Volume and moments are those of the union, by exact chords along
/// a million parallel rays: to 1e-5. Throws as check_clump() does.
ClumpShape make_clump_shape(std::span<const Ball> spheres);

}  // namespace grit
