// Bodies on a crystal lattice.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "description/description.hpp"
#include "grit/world.hpp"

namespace grit {

/// Centres [m], w: radius [m], row by row from the low corner of the box. Whole bodies lie inside the box; where it
/// spans a periodic axis of the cell, the lattice continues across its sides. Throws grit::Error if the box leaves a
/// periodic cell, if its length along such an axis is not a whole number of repeat lengths, or if no body fits.
std::vector<Row> make_lattice(const LatticeSource& source, const Cell& cell);

/// Repeat lengths of the lattice along the axes [m].
Vec3 repeat_lengths(const LatticeSource& source);

/// Number of bodies of make_lattice(), as far as it can be made; exact up to 2^53.
double count_of_lattice(const LatticeSource& source, const std::array<bool, 3>& periodic);

}  // namespace grit
