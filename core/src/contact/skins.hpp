// Skins: distances that bodies and walls may move before the next neighbour search, and bounds of their displacements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "contact/chunks.hpp"
#include "grit/archive.hpp"

namespace grit {

/// Each chunk has its own skin; walls share one. Two surfaces are candidates if their gap is less than the sum of both
/// skins, and of the reach of a law that acts at a distance, so that no contact is missed while no displacement exceeds
/// its skin. Fast bodies have wide skins and slow ones thin ones, so that all are used up at about the same time.
class Skins {
 public:
  /// Before a search: sets the skins for the expected motion, `body` by chunk and `wall` [m], the largest reach of the
  /// law [m], and zero displacements.
  void reset(std::span<const double> body, double wall, double reach) {
    chunk_.assign(body.size(), {});
    for (std::size_t c = 0; c < body.size(); ++c) chunk_[c].skin = body[c];
    largest_ = body.empty() ? 0 : *std::max_element(body.begin(), body.end());
    wall_ = {.skin = wall};
    reach_ = reach;
  }

  double of_chunk(std::size_t chunk) const { return chunk_[chunk].skin; }
  double of_body(std::size_t body) const { return chunk_[body / chunk_bodies].skin; }
  double of_walls() const { return wall_.skin; }
  double largest() const { return largest_; }
  /// Largest distance of two surfaces at which the law acts [m]; 0 for most laws.
  double reach() const { return reach_; }

  /// Upper bounds of displacements in a step [m]: own motion, and half the relative motion of a pair by the mean flow.
  void go(std::size_t chunk, double way, double strained) {
    chunk_[chunk].gone += way, chunk_[chunk].walked += way + strained;
  }
  void advance_walls(double way) { wall_.gone += way, wall_.walked += way; }
  /// Sets the measured maximum displacement of a chunk's bodies since the search [m].
  void found(std::size_t chunk, double way) { chunk_[chunk].gone = std::min(chunk_[chunk].gone, way); }

  /// Upper bound of the displacement of a chunk's bodies since the search [m].
  double gone(std::size_t chunk) const { return chunk_[chunk].gone; }
  double walls_gone() const { return wall_.gone; }
  /// The same along their path, summed over steps, so that it never decreases.
  double walked(std::size_t chunk) const { return chunk_[chunk].walked; }
  double walls_walked() const { return wall_.walked; }

  void serialize(Archive& archive) { archive(chunk_, wall_, largest_, reach_); }

 private:
  struct Way {
    double skin = 0, gone = 0, walked = 0;
    void serialize(Archive& archive) { archive(skin, gone, walked); }
  };
  std::vector<Way> chunk_;
  Way wall_;
  double largest_ = 0, reach_ = 0;
};

}  // namespace grit
