// Grains at random positions without overlaps.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bodies/random.hpp"
#include "description/description.hpp"
#include "grit/world.hpp"

namespace grit {

/// Inserts a grain of each diameter [m] into the box by random sequential insertion, the largest first. Returns centres
/// [m], w: radius [m], in random order. Grains are inside the box; where it spans a periodic axis of the cell they may
/// extend across its sides and do not overlap the images on the other side. They do not overlap `others` (centre, w:
/// radius; anywhere) and their images. `flat`: all centres are in the middle plane of the box normal to this axis.
/// Identical results for identical arguments. Throws grit::Error if there is no space within a hundred thousand tries
/// (with the count and solid fraction reached), for a grain larger than the box, and for a box that is empty or leaves
/// a periodic cell.
std::vector<Row> place_at_random(const Region& box, const Cell& cell, std::vector<double> diameters, Random& random,
                                 std::span<const Row> others = {}, std::optional<int> flat = {});

/// The grains of a description.
std::vector<Row> make_cloud(const CloudSource& cloud, const Cell& cell, Random& random,
                            std::span<const Row> others = {});

}  // namespace grit
