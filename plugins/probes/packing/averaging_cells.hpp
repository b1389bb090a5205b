// Void ratio, stress and coordination over cells that overlap. The edges of all cells cut the specimen into columns;
// each body and each contact is shared out among the few columns that it meets, once, and a cell sums up its columns.
#pragma once

#include <cstddef>
#include <vector>

#include "grit/world.hpp"

namespace grit {

/// Overlapping cells along one axis, and the strips between any two neighbouring edges of cells.
class CellAxis {
 public:
  /// Cells of `size`, each moved by `step` from the one before, as many as fit between `low` and `high`, in the middle;
  /// one cell from `low` to `high` where they lie nearer than `size`. All in m.
  CellAxis(double low, double high, double size, double step);

  struct Cell {
    double low, high;        ///< m
    std::size_t begin, end;  ///< its strips
  };
  const std::vector<Cell>& cells() const { return cells_; }
  std::size_t strips() const { return edges_.size() - 1; }
  /// Edges of the strips [m], ascending; strip i lies between edge i and edge i + 1.
  const std::vector<double>& edges() const { return edges_; }
  /// The strip that holds x, low edge included; the nearest one for x outside.
  std::size_t strip(double x) const;

 private:
  std::vector<Cell> cells_;
  std::vector<double> edges_;
};

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
std::vector<CellAverage> averaging_cells(const World& world, const Region& box, int depth, double size, double step);

}  // namespace grit
