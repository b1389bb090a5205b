// Properties of probe fields in maps and as colours: whether they are shown, in which order, whether they are signed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

/// Names of the components: those of the field, or x, y, z for three, xx … for nine; none for one.
std::vector<std::string> components_of(const Field& field);

/// Whether a field only holds ids, counters or indices, which are not shown as maps.
bool is_bookkeeping(const Field& field);

/// Order of the fields, the most informative first: void ratio, motion, stress; then unknown ones; last those on the
/// reliability of others. Fields of equal rank keep their order in the frame.
int field_rank(const Field& field);

/// Largest upper end of the colour scale, infinite for most fields. Void ratios above 3 are those of cells with few
/// bodies, e.g. at a free surface; they would leave one colour to all packings.
double largest_shown(const Field& field);

/// Whether a component is signed, whatever its values in a frame: vectors, strains and off-diagonal components of
/// tensors; scalars if their doc states what is positive. Normal and mean stresses in Pa are not.
bool is_signed(const Field& field, std::size_t component);

}  // namespace grit
