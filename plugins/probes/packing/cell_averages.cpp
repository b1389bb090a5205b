#include "cell_averages.hpp"

#include <limits>

#include "../averaging_cells.hpp"

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

std::vector<CellAverage> cell_averages(const World& world, const Region& box, int depth, double size, double step) {
  Vec3 sizes = Vec3::Constant(size);
  if (size > 0) sizes[depth] = std::numeric_limits<double>::infinity();
  const AveragingCells cells(world.cell(), box, sizes, Vec3::Constant(step));
  std::vector<Sums> parts(cells.parts());

  const auto positions = world.positions();
  const auto shares = world.volume_shares();
  const Grains grains = grains_of(world);
  std::vector<double> touching(grains.centre.size());
  for (const auto& contact : world.contacts()) {
    const Branch branch = branch_of(world, contact);
    const Mat3 load = contact.force * branch.way.transpose();
    cells.share_out_branch(branch,
                           [&](std::size_t part, double from, double to) { parts[part].load += (to - from) * load; });
    if (!contact.with_wall) ++touching[grains.of_body[contact.a]], ++touching[grains.of_body[contact.b]];
  }
  for (std::size_t i = 0; i < positions.size(); ++i)
    cells.share_out_sphere(xyz(positions[i]), positions[i].w, [&](std::size_t part, double volume) {
      parts[part].solid += shares.empty() ? volume : shares[i] * volume;
    });
  for (std::size_t g = 0; g < touching.size(); ++g)
    cells.place(grains.centre[g], [&](std::size_t part) { ++parts[part].grains, parts[part].touching += touching[g]; });

  std::vector<CellAverage> averages;
  averages.reserve(cells.cells());
  for (const Sums& sums : cells.sum_up(parts)) {
    const Region region = cells.cell(averages.size());
    const double volume = region.volume();
    averages.push_back({region, sums.solid > 0 ? volume / sums.solid - 1 : std::numeric_limits<double>::infinity(),
                        sums.grains > 0 ? sums.touching / sums.grains : 0, sums.load / volume});
  }
  return averages;
}

}  // namespace grit
