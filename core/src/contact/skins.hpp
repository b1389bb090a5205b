// How far bodies and walls may go before neighbours are sought again, and how far they may have gone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "contact/chunks.hpp"
#include "grit/memory.hpp"

namespace grit {

/// Bodies of a chunk have a skin of their own, walls share one. Two surfaces are candidates if their gap is less than
/// both skins together, so that nothing is missed while nobody has gone further than its skin is wide. Fast bodies have
/// wide skins and slow ones thin ones, so that they use them up together.
class Skins {
 public:
  /// Before a search: skins for what may be expected, `body` of each chunk and `wall` [m], and nobody has moved.
  void lay_on(std::span<const double> body, double wall) {
    chunk_.assign(body.size(), {});
    for (std::size_t c = 0; c < body.size(); ++c) chunk_[c].skin = body[c];
    largest_ = body.empty() ? 0 : *std::max_element(body.begin(), body.end());
    wall_ = {.skin = wall};
  }

  double of_chunk(std::size_t chunk) const { return chunk_[chunk].skin; }
  double of_body(std::size_t body) const { return chunk_[body / chunk_bodies].skin; }
  double of_walls() const { return wall_.skin; }
  double largest() const { return largest_; }

  /// A step's way [m] at most: by themselves, and half of what the mean flow of a cell moves the two of a pair.
  void go(std::size_t chunk, double way, double strained) {
    chunk_[chunk].gone += way, chunk_[chunk].walked += way + strained;
  }
  void walls_go(double way) { wall_.gone += way, wall_.walked += way; }
  /// Bodies of a chunk were found to be no further than this from where they were.
  void found(std::size_t chunk, double way) { chunk_[chunk].gone = std::min(chunk_[chunk].gone, way); }

  /// How far bodies of a chunk are from where they were at the search, at most [m].
  double gone(std::size_t chunk) const { return chunk_[chunk].gone; }
  double walls_gone() const { return wall_.gone; }
  /// The same, step by step along their way, so that it never shrinks.
  double walked(std::size_t chunk) const { return chunk_[chunk].walked; }
  double walls_walked() const { return wall_.walked; }

  void remember(Memory& memory) { memory(chunk_, wall_, largest_); }

 private:
  struct Way {
    double skin = 0, gone = 0, walked = 0;
    void remember(Memory& memory) { memory(skin, gone, walked); }
  };
  std::vector<Way> chunk_;
  Way wall_;
  double largest_ = 0;
};

}  // namespace grit
