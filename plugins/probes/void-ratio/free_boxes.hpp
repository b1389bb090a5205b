// What flat walls along the axes leave free of a box.
#pragma once

#include <optional>
#include <vector>

#include "grit/world.hpp"

namespace grit {

/// The boxes that make up what of a box lies on the bodies' side of some of the world's walls, exact to rounding: it is
/// cut where their faces lie, so that what it costs goes with the number of faces. None where walls are something else
/// than faces along the axes with straight edges and rims, or more than a few hundred of them. Surfaces that are
/// `reach` [m] or more away count as outside.
std::optional<std::vector<Region>> free_boxes(const World& world, const Region& box,
                                              const std::vector<std::size_t>& walls, double reach);

}  // namespace grit
