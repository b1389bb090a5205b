// How evenly ranks share the work, and what they exchange.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ranks/traffic.hpp"

namespace grit {

class Halo;
class Ranks;

/// Means over ranks and over the time until the last collection.
struct Sharing {
  double imbalance = 0;          ///< computing time of the busiest rank over the mean, less 1
  double neighbours = 0;         ///< bodies of other ranks that a rank needs, over its own
  double shared_pairs = 0;       ///< pairs that two ranks evaluate, over all
  double independent_pairs = 0;  ///< pairs that a rank evaluates while it receives bodies of others, over all its pairs
  Traffic step, search;          ///< of a rank: in a step without neighbour search, and in a search
};

/// Collects what Sharing shows. All ranks must call its functions, in turns.
class SharingRecord {
 public:
  /// Before a neighbour search, and at the end of a run.
  void steps_end(Ranks& ranks, std::uint64_t step);
  void search_ends(Ranks& ranks, const Halo& halo, std::size_t bodies);
  /// `imbalance` is known elsewhere.
  Sharing sharing(double imbalance) const;

 private:
  std::uint64_t step_ = 0;  // of the last steps_end()
  Traffic before_;          // that of this rank before the present steps or search
  // Sums over searches, of all ranks.
  double searches_ = 0, steps_ = 0;  // times the number of ranks
  double bodies_ = 0, neighbours_ = 0, pairs_ = 0, shared_pairs_ = 0, independent_pairs_ = 0;
  Traffic in_steps_, in_searches_;
};

}  // namespace grit
