// The bodies of a rank, and those of others near them.
#pragma once

#include <vector>

#include "bodies/bodies.hpp"
#include "contact/chunk_boxes.hpp"
#include "ranks/ranks.hpp"
#include "threads/team.hpp"

namespace grit {

/// Arrays have an entry for each body of a run; a rank knows those of its own chunks and of chunks near them.
class Surroundings {
 public:
  /// Finds the chunks near own ones, and takes their bodies from their owners.
  void find(Bodies& bodies, const Cell& cell, const Skins& skins, Ranks& ranks, Team& team);
  /// Own chunks and those near them, in ascending order.
  const std::vector<std::uint32_t>& chunks() const { return chunks_; }
  /// Of all chunks.
  const ChunkBoxes& boxes() const { return boxes_; }

 private:
  void find_near(const Ranks& ranks);
  void fetch(Bodies& bodies, Ranks& ranks) const;

  ChunkBoxes boxes_;
  std::vector<std::uint32_t> chunks_;
  std::vector<std::vector<std::uint32_t>> near_;  // chunks of each rank
};

}  // namespace grit
