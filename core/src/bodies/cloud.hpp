// Grains at random places that do not overlap.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bodies/random.hpp"
#include "description/description.hpp"
#include "grit/world.hpp"

namespace grit {

/// Places a grain of each diameter [m] into the box by random sequential insertion, the largest first. Grains lie
/// inside the box; where it spans a periodic axis of the cell they may stick out across its sides and keep clear of the
/// images on the other side. They keep clear of `others` (centre, w: radius; wherever they are) and their images as
/// well. Centres within the box, w: radius
/// [m], in random order. `flat`: the axis normal to the plane in the middle of the box on which all centres then lie.
/// The same bits for the same arguments. Throws grit::Error: no room within a hundred thousand tries (with the count
/// and solid fraction that were reached), a grain that is larger than the box, a box that is empty or leaves a periodic
/// cell.
std::vector<Row> place_at_random(const Region& box, const Cell& cell, std::vector<double> diameters, Random& random,
                                 std::span<const Row> others = {}, std::optional<int> flat = {});

/// The grains of a description.
std::vector<Row> make_cloud(const CloudGrains& cloud, const Cell& cell, Random& random,
                            std::span<const Row> others = {});

}  // namespace grit
