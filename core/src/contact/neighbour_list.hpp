// Pairs that a wide skin lets in, of which a thin one takes those that may touch soon.
#pragma once

#include <vector>

#include "contact/search.hpp"
#include "contact/team.hpp"
#include "grit/contact/batch.hpp"

namespace grit {

/// Where few bodies are fast, a skin that lasts is so wide that most of its pairs never touch. They are kept here, and
/// the near ones are picked anew every few steps.
class NeighbourList {
 public:
  /// All that the search finds.
  void build(const Bodies& bodies, const NeighbourSearch& search, Team& team);
  void clear() { chunk_.clear(), chunk_.shrink_to_fit(); }
  /// Appends the pairs of a chunk that are nearer than `skin` now.
  void near(const Bodies& bodies, const ImageShift* shifts, std::size_t chunk, double skin,
            std::vector<Candidate>& found) const;

 private:
  std::vector<std::vector<Candidate>> chunk_;  // by a, then by b
};

}  // namespace grit
