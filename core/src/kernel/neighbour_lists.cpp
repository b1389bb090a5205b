#include "kernel/neighbour_lists.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "bodies/restored.hpp"

namespace grit {

namespace {

// Skins over the mean diameter, and the number of steps for which skins above the minimum should last. On the
// dense periodic box of bench/ 0.01 … 0.05 were tried: wider skins need fewer rebuilds and more pair tests; 0.03 was
// best or within 3 % of it at 10 000 and 50 000 particles.
constexpr double least_skin = 0.03, most_skin = 0.6, steps_of_skin = 100;

/// The widths of skins [m]: for the motion in some steps, within bounds.
struct SkinWidths {
  double least, most;
  SkinWidths(const DeformingCell& cell, const PopulationStatistics& statistics, double reach)
      : least(least_skin * statistics.mean_diameter), most(most_skin * statistics.mean_diameter) {
    for (int k = 0; k < 3; ++k)
      if (cell.cell().periodic[as_index(k)])
        most = std::min(most, 0.25 * cell.lengths()[k] - statistics.largest_radius - 0.5 * reach);
  }
  double at(double speed, double dt) const { return std::max(least, std::min(most, steps_of_skin * dt * speed)); }
};

}  // namespace

bool NeighbourLists::used_up(std::size_t chunk) const {
  return skins_.gone(chunk) + 0.5 * strain_travel_ > skins_.of_chunk(chunk);
}

bool NeighbourLists::may_be_due(const Ranks& ranks) const {
  for (std::size_t chunk = ranks.first(); chunk < ranks.last(); ++chunk)
    if (used_up(chunk)) return true;
  return false;
}

bool NeighbourLists::due(const Bodies& bodies, const DeformingCell& cell, Ranks& ranks) {
  // The sum of the largest speeds is a bound; the true distance is often far less. In a cell that deforms it is the
  // distance relative to the mean flow.
  Vec3 stretch = Vec3::Ones(), from = Vec3::Zero(), to = Vec3::Zero();
  if (cell.deforms() || cell.cell().skewed()) {
    from = 0.5 * (reference_cell_.low + reference_cell_.high), to = cell.centre();
    for (int k = 0; k < 3; ++k)
      if (cell.cell().periodic[as_index(k)])
        stretch[k] = cell.lengths()[k] / (reference_cell_.high[k] - reference_cell_.low[k]);
      else from[k] = to[k] = 0;
  }
  // Deformation since the last rebuild, which has moved no image since.
  const bool skewed = cell.cell().skewed();
  Mat3 deformed = Mat3::Identity();
  if (skewed)
    deformed = DeformingCell::columns(cell.lengths(), cell.cell().tilt) *
               DeformingCell::columns(reference_cell_.high - reference_cell_.low, reference_cell_.tilt).inverse();
  const auto measured = [&](std::size_t chunk) {
    const ChunkRange range(chunk, bodies.count());
    double largest = 0;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Vec3 x = xyz(bodies.position[i]), before = xyz(reference_[i]);
      const Vec3 away =
          skewed ? Vec3(x - to - deformed * (before - from)) : Vec3(x - to - stretch.cwiseProduct(before - from));
      largest = std::max(largest, away.squaredNorm());
    }
    return std::sqrt(largest);
  };
  bool due = false;
  for (std::size_t chunk = ranks.first(); chunk < ranks.last(); ++chunk) {
    if (!used_up(chunk)) continue;
    skins_.found(chunk, measured(chunk));
    due = due || skins_.gone(chunk) + 0.5 * strain_travel_ > 0.95 * skins_.of_chunk(chunk);
  }
  return ranks.any(due);
}

void NeighbourLists::lay_skins(const Bodies& bodies, const DeformingCell& cell, const PopulationStatistics& statistics,
                               double dt, double wall_speed, Passes& passes) {
  const double reach = largest_reach(reaches_);
  const SkinWidths widths(cell, statistics, reach);
  const std::vector<double> skins = passes.of_chunks([&](std::size_t chunk) {
    const ChunkRange range(chunk, bodies.count());
    double fastest = 0;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Vec3 flow = cell.mean_flow(xyz(bodies.position[i]));
      fastest = std::max(fastest, (xyz(bodies.velocity[i]) - flow).squaredNorm());
    }
    return widths.at(std::sqrt(fastest), dt);
  });
  skins_.reset(skins, widths.at(wall_speed, dt), reach);
  strain_travel_ = 0;
}

double NeighbourLists::largest_reach(std::span<const double> reaches) {
  return reaches.empty() ? 0 : (1 + 1e-6) * *std::ranges::max_element(reaches);
}

void NeighbourLists::rebuild(Bodies& bodies, const DeformingCell& cell, const PopulationStatistics& statistics,
                             std::vector<double> reaches, double dt, double wall_speed, Passes& passes) {
  reaches_ = std::move(reaches);
  lay_skins(bodies, cell, statistics, dt, wall_speed, passes);
  surroundings_.find(bodies, cell.cell(), skins_, passes.ranks(), passes.team());
  search_.build(bodies, surroundings_.chunks(), cell.cell(), skins_, passes.team());
  reference_.resize(bodies.count()), reference_cell_ = cell.cell();
  passes.each_own([&](std::size_t chunk) {
    const ChunkRange range(chunk, bodies.count());
    std::copy(bodies.position.begin() + std::ptrdiff_t(range.first),
              bodies.position.begin() + std::ptrdiff_t(range.last), reference_.begin() + std::ptrdiff_t(range.first));
  });
  ++rebuilds_;
  requested_ = false;
}

void NeighbourLists::begin_search_at_walls(const DeformingCell& cell, const PopulationStatistics& statistics, double dt,
                                           double wall_speed) {
  skins_.reset_at_walls(SkinWidths(cell, statistics, skins_.reach()).at(wall_speed, dt));
  ++searches_at_walls_;
}

void NeighbourLists::advance(double dt, double strained, const Passes& passes) {
  strain_travel_ += strained;
  last_ = {dt, strained, true};
  for (std::size_t chunk = passes.ranks().first(); chunk < passes.ranks().last(); ++chunk) go(chunk, passes);
}

void NeighbourLists::advance_near(std::span<const std::uint32_t> near, const Passes& passes) {
  if (!std::exchange(last_.near_chunks_wait, false)) return;
  for (const std::uint32_t chunk : near) go(chunk, passes);
}

void NeighbourLists::go(std::size_t chunk, const Passes& passes) {
  skins_.go(chunk, last_.dt * passes.chunks()[chunk].motion.largest_speed, 0.5 * last_.strained);
}

double NeighbourLists::furthest_here(const Passes& passes, double dt) const {
  double furthest = 0;
  for (std::size_t chunk = passes.ranks().first(); chunk < passes.ranks().last(); ++chunk)
    furthest = std::max(furthest, skins_.gone(chunk) + dt * passes.chunks()[chunk].motion.largest_speed);
  return furthest;
}

double NeighbourLists::furthest(Passes& passes) const {
  std::array<double, 1> all{furthest_here(passes)};
  passes.ranks().largest(all);
  return all.front();
}

double NeighbourLists::shortest_period(const Bodies& bodies, const PopulationStatistics& statistics,
                                       std::span<const double> reaches) {
  double furthest = 0;
  for (const Clump& clump : bodies.clumps.clump) furthest = std::max(furthest, clump.furthest);
  // A clump must not meet its own images.
  return NeighbourSearch::shortest_period(statistics.largest_radius, least_skin * statistics.mean_diameter,
                                          largest_reach(reaches)) +
         2 * furthest;
}

void NeighbourLists::check_restored(std::size_t bodies) const {
  expect_restored(skins_.chunks() == chunks_of(bodies) && reference_.size() == bodies,
                  "neighbour lists are of another number of bodies");
}

void NeighbourLists::serialize(SharedArchive& archive) {
  skins_.serialize(archive);
  archive(reference_cell_, reaches_, strain_travel_, rebuilds_, searches_at_walls_, requested_);
  reference_.resize(archive.length(reference_.size(), sizeof(Row)));
  archive.each_body(reference_.size(), reference_);
}

}  // namespace grit
