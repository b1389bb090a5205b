// Void ratio, stress and coordination of averaging cells.
#pragma once

#include <vector>

#include "grit/world.hpp"

namespace grit {

/// One averaging cell.
struct CellAverage {
  Region region;
  double void_ratio;           ///< infinite without solids
  double coordination_number;  ///< touching grains of a grain, mean over those with their centre in the cell; 0 without
                               ///< any
  Mat3 stress;                 ///< Pa, compression positive
};

/// Averages over cells of `size` moved by `step` [m] across `box`, each as deep as the box along `depth` (0, 1, 2: x,
/// y, z). The first remaining axis runs slowest. Periodic images count.
std::vector<CellAverage> cell_averages(const World& world, const Region& box, int depth, double size, double step);

}  // namespace grit
