// Bodies that several ranks sort along one curve, and send to their owners.
#pragma once

#include <vector>

#include "bodies/bodies.hpp"
#include "bodies/reordering.hpp"
#include "contact/spatial_order.hpp"
#include "ranks/ranks.hpp"
#include "threads/team.hpp"

namespace grit {

/// Each rank sorts its own bodies; the order of all is that of spatial_order(). Clumps cannot migrate.
class Migration {
 public:
  /// `leaves`: by body, whether an own one is removed.
  Migration(const Bodies& bodies, const std::vector<bool>& leaves, const Cell& cell, Ranks& ranks, Team& team);
  /// Number of bodies of all ranks that stay.
  std::size_t count() const { return count_; }
  /// After their chunks have been divided: sends bodies to their new owners. Others are unknown then. Returns the
  /// present indices of the bodies that this rank had.
  Renumbering move(Bodies& bodies, Ranks& ranks);

 private:
  /// Where in own_ the bodies of each rank begin, and the end.
  std::vector<std::size_t> starts(Ranks& ranks) const;

  std::size_t count_ = 0, before_ = 0;
  int bits_ = 0;                     // of keys
  std::vector<CurvePlace> own_;      // along the curve
  std::vector<std::uint32_t> gone_;  // own bodies that are removed
};

}  // namespace grit
