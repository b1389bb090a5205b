// Void ratio, stress and coordination of averaging cells.
#pragma once

#include <vector>

#include "grit/toolkit/averaging_cells.hpp"

namespace grit {

/// One averaging cell.
struct CellAverage {
  double void_ratio;           ///< infinite without solids
  double coordination_number;  ///< touching grains of a grain, mean over those with their centre in the cell; 0 without
                               ///< any
  Mat3 stress;                 ///< Pa, compression positive
};

/// Of each cell, in the cells' order. Periodic images count.
std::vector<CellAverage> cell_averages(const World& world, const AveragingCells& cells);

}  // namespace grit
