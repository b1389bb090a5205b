// How much of a box lies on the bodies' side of walls.
#pragma once

#include <vector>

#include "grit/toolkit/averaging_cells.hpp"
#include "grit/world.hpp"

namespace grit {

/// Of each part of the cells, the volume that lies behind no wall's face [m³]. Exact to rounding for flat walls
/// along the axes, edges and rims included, and for others that do not meet in the cells; a curved or grooved surface
/// is taken to be elsewhere by some `error` [m] in the mean, > 0: less than that in parts of about equal sides, up to
/// twice in thin slices. Grooves less than 125 times as wide may be missed. What has no solid behind it, such as a
/// two-sided sheet, takes no volume.
std::vector<double> free_volumes(const World& world, const AveragingCells& cells, double error);

/// The share of a box with sides of `size` about the origin for which normal · x < distance; any length of the normal
/// but 0.
double share_below(const Vec3& size, const Vec3& normal, double distance);

}  // namespace grit
