// Which chunks of bodies are near each other.
#pragma once

#include <cstddef>
#include <vector>

#include "bodies/bodies.hpp"
#include "contact/skins.hpp"
#include "grit/world.hpp"
#include "ranks/ranks.hpp"
#include "threads/team.hpp"

namespace grit {

/// A box around the bodies of each chunk, with their skins and the reach of the law.
class ChunkBoxes {
 public:
  struct Box {
    Vec3 low, high;
  };

  ChunkBoxes() = default;
  /// Of all chunks; each rank measures its own.
  ChunkBoxes(const Bodies& bodies, const Cell& cell, const Skins& skins, Ranks& ranks, Team& team);
  /// Whether a body of one chunk may be a neighbour of one of the other, across periodic sides, too.
  bool near(std::size_t one, std::size_t other) const { return near(boxes_[one], boxes_[other]); }
  /// Whether a chunk is near a box.
  bool near(std::size_t chunk, const Box& box) const { return near(boxes_[chunk], box); }
  /// Around the chunks `first` … `last` − 1, of which there is at least one.
  Box around(std::size_t first, std::size_t last) const;
  /// Of the chunks below `first`, those near any of `first` … `last` − 1.
  std::vector<std::size_t> near_below(std::size_t first, std::size_t last) const;

 private:
  bool near(const Box& one, const Box& other) const;

  std::vector<Box> boxes_;
  Vec3 period_ = Vec3::Zero();  // m; 0 along axes that are not periodic
  std::vector<Vec3> shifts_;    // of the images in a skewed cell [m]; else empty
};

}  // namespace grit
