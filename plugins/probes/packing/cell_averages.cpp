#include "cell_averages.hpp"

#include <limits>

#include "grit/toolkit/cell_contents.hpp"

namespace grit {

namespace {

/// What a part of the specimen, or a cell, holds.
struct Sums {
  double solid = 0;                 ///< m³
  double grains = 0, touching = 0;  ///< grains with their centre in it, and the grains that touch those
  Mat3 load = Mat3::Zero();         ///< sum of force and branch, as far as it lies inside [N m]

  Sums& operator+=(const Sums& other) {
    solid += other.solid, grains += other.grains, touching += other.touching, load += other.load;
    return *this;
  }
};

}  // namespace

std::vector<CellAverage> cell_averages(const World& world, const AveragingCells& cells) {
  std::vector<Sums> parts(cells.parts());
  const Grains grains = grains_of(world);
  std::vector<double> touching(grains.centre.size());
  for (const auto& contact : world.contacts())
    if (!contact.with_wall) ++touching[grains.of_body[contact.a]], ++touching[grains.of_body[contact.b]];
  share_out_contacts(world, cells, [&](std::size_t part, const Piece& piece) { parts[part].load += piece.load; });
  share_out_solids(world, cells, [&](std::size_t part, double volume, std::size_t) { parts[part].solid += volume; });
  for (std::size_t g = 0; g < touching.size(); ++g)
    cells.place(grains.centre[g], [&](std::size_t part) { ++parts[part].grains, parts[part].touching += touching[g]; });

  std::vector<CellAverage> averages;
  averages.reserve(cells.cells());
  for (const Sums& sums : cells.sum_up(parts)) {
    const double volume = cells.cell(averages.size()).volume();
    averages.push_back({sums.solid > 0 ? volume / sums.solid - 1 : std::numeric_limits<double>::infinity(),
                        sums.grains > 0 ? sums.touching / sums.grains : 0, sums.load / volume});
  }
  return averages;
}

}  // namespace grit
