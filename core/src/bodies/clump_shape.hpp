// Volume, centre of mass, inertia and size of a union of spheres.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grit/body_kind.hpp"

namespace grit {

/// A ball: centre, w: radius.
using Ball = Row;

/// The smallest ball that encloses one or more others; to round-off. It touches at most four of them; all sets of four
/// are tried.
Ball smallest_enclosing(std::span<const Ball> balls);

struct ClumpDefect {
  std::optional<std::size_t> sphere;  ///< the sphere at fault, from 0; none: all of them
  std::string found, allowed;         ///< numbers of spheres in texts start from 1
};
/// All defects: no sphere or more than 64, spheres that are inside another, spheres that are not connected with the
/// largest connected group. Of two equal spheres the second is reported.
std::vector<ClumpDefect> clump_defects(std::span<const Ball> spheres);

/// The clump of these spheres, in any unit and frame. Volume and moments are those of the union, by exact chords along
/// `rays` × `rays` lines (a multiple of 3) through each sphere, without the parts that previous spheres cover. Errors
/// are the differences to a third as many lines in both directions, sphere by sphere. Throws grit::Error for a defect
/// or an error above 0.1 %.
ClumpShape make_clump_shape(std::span<const Ball> spheres, int rays = 501);

}  // namespace grit
