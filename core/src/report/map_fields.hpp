// What the fields of cells are as maps: which are none, which is looked at first, where zero parts colours.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grit/probe.hpp"

namespace grit {

/// What the numbers of a row are: the field's own words, or x, y, z of three, xx … of nine; none of one number.
std::vector<std::string> components_of(const Field& field);

/// Whether a field only says which, how many or from where: ids, counters, places. Nobody looks at a map of those.
bool is_bookkeeping(const Field& field);

/// Fields are offered in this order, the most telling first: void ratio, motion, stress; then those that are not known
/// here; last what says how far others are to be trusted. As many are alike, they stay as the frame has them.
int telling_rank(const Field& field);

/// Whether zero parts the values of a component, whatever they are in a frame: so vectors, strains and what tensors
/// have off their diagonal; of single numbers those whose doc says what is positive. What Pa presses on a face, or all
/// round, is not: it is there or not.
bool is_signed(const Field& field, std::size_t component);

}  // namespace grit
