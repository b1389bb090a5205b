// Neighbour lists: when they are rebuilt, and the widths of skins.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bodies/bodies.hpp"
#include "bodies/large_array.hpp"
#include "contact/search.hpp"
#include "contact/skins.hpp"
#include "contact/surroundings.hpp"
#include "domain/deforming_cell.hpp"
#include "domain/population_statistics.hpp"
#include "kernel/passes.hpp"

namespace grit {

class NeighbourLists {
 public:
  const Skins& skins() const { return skins_; }
  const NeighbourSearch& search() const { return search_; }
  const Surroundings& surroundings() const { return surroundings_; }
  std::uint64_t rebuilds() const { return rebuilds_; }
  /// Number of searches at walls only, between rebuilds.
  std::uint64_t searches_at_walls() const { return searches_at_walls_; }
  /// Upper bound of the approach of two surfaces by strain of the cell and by growth since the last rebuild [m].
  double strain_travel() const { return strain_travel_; }

  void request_rebuild() { requested_ = true; }
  /// The same if reaches of the law have changed since the last rebuild.
  void expect_reaches(const std::vector<double>& reaches) { requested_ = requested_ || reaches != reaches_; }
  bool requested() const { return requested_; }
  /// Whether an own body may have used up its skin, if it was as fast as the fastest of its chunk.
  bool may_be_due(const Ranks& ranks) const;
  /// Whether a body has used up most of it: displacements since the last rebuild are measured.
  bool due(const Bodies& bodies, const DeformingCell& cell, Ranks& ranks);
  /// Whether a wall may have used up its skin; then only candidates at walls are found again.
  bool due_at_walls() const { return skins_.walls_gone() > skins_.of_walls(); }
  /// Whether this rebuild should also sort bodies in space.
  bool sorts() const { return rebuilds_ % sort_every == 0; }
  /// Searches neighbours. `reaches`: those of the law for the largest radius [m]. Skins follow from speeds only, so
  /// that a run is identical on every machine. With several ranks, takes bodies near own ones from the others.
  void rebuild(Bodies& bodies, const DeformingCell& cell, const PopulationStatistics& statistics,
               std::vector<double> reaches, double dt, double wall_speed, Passes& passes);
  /// After the pairs of the search are known: `reached` as in ContactTable.
  void compare_velocities(const std::vector<std::vector<std::uint32_t>>& reached, Ranks& ranks);
  /// Measures how far a chunk's bodies have moved since the last rebuild, see Skins::measured().
  void measure(std::size_t chunk, const Bodies& bodies, const DeformingCell& cell);
  /// Before candidates at walls are found again, without a rebuild: sets the skins for this. Arguments as in rebuild().
  void begin_search_at_walls(const DeformingCell& cell, const PopulationStatistics& statistics, double dt,
                             double wall_speed);
  /// After a step of `dt` [s]; `strained`: upper bound of the approach of two surfaces by strain and growth [m].
  void advance(double dt, double strained, const Passes& passes);
  /// The same for chunks of other ranks near own ones, once their speeds are known.
  void advance_near(std::span<const std::uint32_t> near, const Passes& passes);
  /// Upper bound of the displacement of own bodies since the last rebuild, and after a further step of `dt` [m].
  double furthest_here(const Passes& passes, double dt = 0) const;
  /// The same of all bodies.
  double furthest(Passes& passes) const;
  void advance_walls(double distance) { skins_.advance_walls(distance); }

  /// The largest of the law's reaches [m], and somewhat more than their rounding errors in single precision.
  static double largest_reach(std::span<const double> reaches);
  /// The shortest allowed period [m]. `reaches`: as in rebuild().
  static double shortest_period(const Bodies& bodies, const PopulationStatistics& statistics,
                                std::span<const double> reaches);

  void serialize(SharedArchive& archive);
  /// Throws Error unless restored lists fit so many bodies.
  void check_restored(std::size_t bodies) const;

 private:
  class Displacements;
  static constexpr std::uint64_t sort_every = 8;
  bool used_up(std::size_t chunk) const;
  /// Takes into account how far a chunk's bodies may have approached others in the last step.
  void approach(std::size_t chunk, const Passes& passes);
  void lay_skins(const Bodies& bodies, const DeformingCell& cell, const PopulationStatistics& statistics, double dt,
                 double wall_speed, Passes& passes);

  NeighbourSearch search_;
  Surroundings surroundings_;
  Skins skins_;
  LargeArray<Row> reference_;  // positions of own bodies at the last rebuild
  Cell reference_cell_;
  std::vector<double> reaches_;             // of the law at the last rebuild
  double strain_travel_ = 0, elapsed_ = 0;  // since the last rebuild
  struct {
    double dt = 0, strained = 0;
    bool near_chunks_wait = false;
  } last_;  // step
  std::uint64_t rebuilds_ = 0, searches_at_walls_ = 0;
  bool requested_ = true;
};

}  // namespace grit
