// Volume, centre of mass, inertia and size of a union of spheres.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "grit/body_kind.hpp"

namespace grit {

/// A ball: centre, w: radius.
using Ball = Row;

/// The smallest ball that encloses others, of which there is one at least; to round-off. It touches four of them at
/// most, and all sets of four are tried.
Ball smallest_enclosing(std::span<const Ball> balls);

struct ClumpDefect {
  std::optional<std::size_t> sphere;  ///< at fault, from 0; none: all of them
  std::string found, allowed;         ///< numbers of spheres are from 1
};
/// What is wrong where there is no sphere or more than 64, one lies within another, or they do not hang together.
std::optional<ClumpDefect> clump_defect(std::span<const Ball> spheres);

/// The clump of these spheres, in any unit and frame. Volume and moments are those of the union, by exact chords along
/// `rays` × `rays` lines through each sphere, a multiple of 3, less what spheres before it cover. Errors are what comes
/// of a third as many either way, sphere by sphere. Throws grit::Error where there is a defect or one is above 0.1 %.
ClumpShape make_clump_shape(std::span<const Ball> spheres, int rays = 501);

}  // namespace grit
