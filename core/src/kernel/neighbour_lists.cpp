#include "kernel/neighbour_lists.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bodies/restored.hpp"

namespace grit {

namespace {

// Skins over the mean diameter, and the number of steps for which skins above the minimum should last. On the
// dense periodic box of bench/ 0.01 … 0.05 were tried: wider skins need fewer rebuilds and more pair tests; 0.03 was
// best or within 3 % of it at 10 000 and 50 000 particles. In the flowing scenes of bench/, 75 … 170 steps were tried,
// and 0.6 … 2 diameters for grains that fall freely: 100 and 1.3 were best.
constexpr double least_skin = 0.03, most_skin = 1.3, steps_of_skin = 100;

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

/// Displacements of bodies relative to the mean flow since the last rebuild, which has moved no image since.
class NeighbourLists::Displacements {
 public:
  Displacements(const NeighbourLists& lists, const Bodies& bodies, const DeformingCell& cell)
      : bodies_(bodies), before_(lists.reference_), skewed_(cell.cell().skewed()) {
    const Cell& reference = lists.reference_cell_;
    if (!cell.deforms() && !skewed_) return;
    from_ = 0.5 * (reference.low + reference.high), to_ = cell.centre();
    for (int k = 0; k < 3; ++k)
      if (cell.cell().periodic[as_index(k)]) stretch_[k] = cell.lengths()[k] / (reference.high[k] - reference.low[k]);
      else from_[k] = to_[k] = 0;
    if (skewed_)
      deformed_ = DeformingCell::columns(cell.lengths(), cell.cell().tilt) *
                  DeformingCell::columns(reference.high - reference.low, reference.tilt).inverse();
  }
  /// The largest one of a chunk's bodies [m], less `common`.
  double largest(std::size_t chunk, const Vec3& common = Vec3::Zero()) const {
    const ChunkRange range(chunk, bodies_.count());
    double largest = 0;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Vec3 x = xyz(bodies_.position[i]), before = xyz(before_[i]);
      const Vec3 away = skewed_ ? Vec3(x - to_ - deformed_ * (before - from_))
                                : Vec3(x - to_ - stretch_.cwiseProduct(before - from_));
      largest = std::max(largest, (away - common).squaredNorm());
    }
    return std::sqrt(largest);
  }

 private:
  const Bodies& bodies_;
  const LargeArray<Row>& before_;
  bool skewed_;
  Vec3 stretch_ = Vec3::Ones(), from_ = Vec3::Zero(), to_ = Vec3::Zero();
  Mat3 deformed_ = Mat3::Identity();
};

bool NeighbourLists::due(const Bodies& bodies, const DeformingCell& cell, Ranks& ranks) {
  // The sum of the largest speeds is a bound; the true distance is often far less.
  const Displacements displacements(*this, bodies, cell);
  bool due = false;
  for (std::size_t chunk = ranks.first(); chunk < ranks.last(); ++chunk) {
    if (!used_up(chunk)) continue;
    skins_.found(chunk, displacements.largest(chunk));
    due = due || skins_.gone(chunk) + 0.5 * strain_travel_ > 0.95 * skins_.of_chunk(chunk);
  }
  return ranks.any(due);
}

void NeighbourLists::measure(std::size_t chunk, const Bodies& bodies, const DeformingCell& cell) {
  const Displacements displacements(*this, bodies, cell);
  const Velocity& reference = skins_.reference(chunk);
  const Vec3 common = elapsed_ * Vec3(reference[0], reference[1], reference[2]);
  const double strained = 0.5 * strain_travel_;
  skins_.measured(chunk, displacements.largest(chunk) + strained,
                  displacements.largest(chunk, common) + 0.5 * elapsed_ * skins_.parting(chunk) + strained);
}

void NeighbourLists::lay_skins(const Bodies& bodies, const DeformingCell& cell, const PopulationStatistics& statistics,
                               double dt, double wall_speed, Passes& passes) {
  const double reach = largest_reach(reaches_);
  const SkinWidths widths(cell, statistics, reach);
  struct Found {  // of a chunk
    double skin;
    Velocity reference;
  };
  const std::vector<Found> found = passes.of_chunks([&](std::size_t chunk) {
    const ChunkRange range(chunk, bodies.count());
    double fastest = 0;
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const Vec3 own = xyz(bodies.velocity[i]) - cell.mean_flow(xyz(bodies.position[i]));
      fastest = std::max(fastest, own.squaredNorm());
      low = low.cwiseMin(own), high = high.cwiseMax(own);
    }
    const VelocityRange velocities{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
    return Found{widths.at(std::sqrt(fastest), dt), velocities.middle()};
  });
  std::vector<double> skins;
  for (const Found& chunk : found) skins.push_back(chunk.skin);
  skins_.reset(skins, widths.at(wall_speed, dt), reach);
  for (std::size_t chunk = 0; chunk < found.size(); ++chunk) skins_.refer(chunk, found[chunk].reference);
  strain_travel_ = elapsed_ = 0;
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

void NeighbourLists::compare_velocities(const std::vector<std::vector<std::uint32_t>>& reached, Ranks& ranks) {
  std::vector<double> most(reached.size());
  for (std::size_t chunk = 0; chunk < reached.size(); ++chunk)
    for (const std::uint32_t other : reached[chunk]) {
      const double speed = difference(skins_.reference(chunk), skins_.reference(other));
      most[chunk] = std::max(most[chunk], speed), most[other] = std::max(most[other], speed);
    }
  ranks.complete(most);  // a rank knows all pairs of its own chunks only
  for (std::size_t chunk = 0; chunk < most.size(); ++chunk) skins_.set_parting(chunk, most[chunk]);
}

void NeighbourLists::begin_search_at_walls(const DeformingCell& cell, const PopulationStatistics& statistics, double dt,
                                           double wall_speed) {
  skins_.reset_at_walls(SkinWidths(cell, statistics, skins_.reach()).at(wall_speed, dt));
  ++searches_at_walls_;
}

void NeighbourLists::advance(double dt, double strained, const Passes& passes) {
  strain_travel_ += strained, elapsed_ += dt;
  last_ = {dt, strained, true};
  for (std::size_t chunk = passes.ranks().first(); chunk < passes.ranks().last(); ++chunk) {
    skins_.go(chunk, dt, passes.chunks()[chunk].motion.velocities.largest_speed(), 0.5 * strained);
    approach(chunk, passes);
  }
}

void NeighbourLists::advance_near(std::span<const std::uint32_t> near, const Passes& passes) {
  if (!std::exchange(last_.near_chunks_wait, false)) return;
  for (const std::uint32_t chunk : near) approach(chunk, passes);
}

void NeighbourLists::approach(std::size_t chunk, const Passes& passes) {
  skins_.approach(chunk, last_.dt, passes.chunks()[chunk].relative_speed, 0.5 * last_.strained);
}

double NeighbourLists::furthest_here(const Passes& passes, double dt) const {
  double furthest = 0;
  for (std::size_t chunk = passes.ranks().first(); chunk < passes.ranks().last(); ++chunk)
    furthest = std::max(furthest, skins_.gone(chunk) + dt * passes.chunks()[chunk].motion.velocities.largest_speed());
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
  archive(reference_cell_, reaches_, strain_travel_, elapsed_, rebuilds_, searches_at_walls_, requested_);
  reference_.resize(archive.length(reference_.size(), sizeof(Row)));
  archive.each_body(reference_.size(), reference_);
}

}  // namespace grit
