// When neighbours are searched again, and with how wide skins.
#pragma once

#include <cstdint>

#include "bodies/bodies.hpp"
#include "bodies/large_array.hpp"
#include "contact/search.hpp"
#include "contact/skins.hpp"
#include "domain/deforming_cell.hpp"
#include "domain/population_statistics.hpp"
#include "kernel/passes.hpp"

namespace grit {

class NeighbourLists {
 public:
  const Skins& skins() const { return skins_; }
  const NeighbourSearch& search() const { return search_; }
  std::uint64_t rebuilds() const { return rebuilds_; }
  /// Distance by which strain of the cell and growth brought two surfaces closer since the last rebuild, at most [m].
  double strain_travel() const { return strain_travel_; }

  void request_rebuild() { requested_ = true; }
  /// Whether a body or wall may have used up its skin. Distances from the last rebuild are measured where the sum of
  /// largest speeds does not suffice.
  bool due(const Bodies& bodies, const DeformingCell& cell);
  /// Whether this rebuild should also put bodies in spatial order.
  bool sorts() const { return rebuilds_ % sort_every == 0; }
  /// Searches neighbours. Skins follow from speeds alone, so that a run is the same on every machine.
  void rebuild(const Bodies& bodies, const DeformingCell& cell, const PopulationStatistics& statistics, double dt,
               double wall_speed, Passes& passes);
  /// After a step of `dt` [s] in which two surfaces came closer by `strained` [m] at most because of strain and growth.
  /// Returns how far a body is from where it was at the last rebuild, at most [m].
  double advance(double dt, double strained, const Passes& passes);
  void advance_walls(double distance) { skins_.walls_go(distance); }

  /// The shortest period that is allowed [m].
  static double shortest_period(const Bodies& bodies, const PopulationStatistics& statistics);

  void remember(Memory& memory);

 private:
  static constexpr std::uint64_t sort_every = 8;
  void lay_skins(const Bodies& bodies, const DeformingCell& cell, const PopulationStatistics& statistics, double dt,
                 double wall_speed, Passes& passes);

  NeighbourSearch search_;
  Skins skins_;
  LargeArray<Row> reference_;  // positions at the last rebuild
  Cell reference_cell_;
  double strain_travel_ = 0;
  std::uint64_t rebuilds_ = 0;
  bool requested_ = true;
};

}  // namespace grit
