// Skins: distances that bodies and walls may move before the next neighbour search, and bounds of their displacements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "bodies/velocity_range.hpp"
#include "ranks/shared_archive.hpp"
#include "threads/chunks.hpp"

namespace grit {

/// Each chunk has its own skin; walls share one. Two surfaces are candidates if their gap is less than the sum of both
/// skins, and of the reach of a law that acts at a distance, so that no contact is missed while no displacement exceeds
/// its skin. Fast bodies have wide skins and slow ones thin ones, so that all are used up at about the same time.
///
/// Where only walls have used up theirs, candidates at walls are found again without a search of pairs. Bodies then are
/// where they have moved since the search. From there they may move back, and by their skin in the other direction:
/// their skin at walls is the sum of both.
///
/// Bodies that move together do not approach each other, as in a plug or in a bed that turns with a drum. Each chunk
/// therefore has a reference velocity, that of its bodies at the search. Bodies of two chunks approach by no more than
/// they move relative to those of their chunks, plus the difference of both.
class Skins {
 public:
  /// Before a search: sets the skins for the expected motion, `body` by chunk and `wall` [m], the largest reach of the
  /// law [m], zero displacements and zero reference velocities.
  void reset(std::span<const double> body, double wall, double reach) {
    chunk_.assign(body.size(), {});
    for (std::size_t c = 0; c < body.size(); ++c) chunk_[c].skin = chunk_[c].at_walls = body[c];
    largest_ = body.empty() ? 0 : *std::max_element(body.begin(), body.end());
    wall_ = {.skin = wall};
    reach_ = reach;
  }
  /// Before a search at walls only: sets the skin of walls [m], with zero displacements of these, and those of bodies
  /// at walls.
  void reset_at_walls(double wall) {
    for (Way& own : chunk_) own.at_walls = own.skin + own.gone;
    wall_.skin = wall, wall_.gone = 0, wall_.walked_at_search = wall_.walked;
  }

  /// Sets the reference velocity of a chunk [m/s].
  void refer(std::size_t chunk, const Velocity& to) { chunk_[chunk].reference = to; }
  /// After the search: no body of the chunk can meet one of others whose reference velocity differs by more [m/s].
  void set_parting(std::size_t chunk, double speed) { chunk_[chunk].parting = speed; }
  const Velocity& reference(std::size_t chunk) const { return chunk_[chunk].reference; }
  /// Upper bound of speeds relative to the reference velocity of the chunk [m/s].
  double relative_speed(std::size_t chunk, const VelocityRange& velocities) const {
    return velocities.furthest_from(chunk_[chunk].reference);
  }

  std::size_t chunks() const { return chunk_.size(); }
  double of_chunk(std::size_t chunk) const { return chunk_[chunk].skin; }
  double of_body(std::size_t body) const { return chunk_[body / chunk_bodies].skin; }
  /// The skin of a chunk's bodies at walls [m], see Skins.
  double at_walls(std::size_t chunk) const { return chunk_[chunk].at_walls; }
  double of_walls() const { return wall_.skin; }
  double largest() const { return largest_; }
  /// Largest distance of two surfaces at which the law acts [m]; 0 for most laws.
  double reach() const { return reach_; }

  /// After a step of `dt` [s]: upper bounds of speeds [m/s], and half the relative motion of a pair by the mean flow
  /// [m].
  void go(std::size_t chunk, double dt, double speed, double strained) {
    chunk_[chunk].gone += dt * speed, chunk_[chunk].walked += dt * speed + strained;
  }
  /// The same of speeds relative to the reference velocity.
  void approach(std::size_t chunk, double dt, double relative_speed, double strained) {
    chunk_[chunk].within += dt * relative_speed + strained;
    chunk_[chunk].across += dt * (relative_speed + 0.5 * chunk_[chunk].parting) + strained;
  }
  void advance_walls(double way) { wall_.gone += way, wall_.walked += way; }
  /// Sets the measured maximum displacement of a chunk's bodies since the search [m].
  void found(std::size_t chunk, double way) { chunk_[chunk].gone = std::min(chunk_[chunk].gone, way); }

  /// Sets measured displacements since the search [m], see displaced() and approached().
  void measured(std::size_t chunk, double displaced, double approached) {
    Way& own = chunk_[chunk];
    own.detour = std::max(0.0, own.walked - displaced), own.detour_across = std::max(0.0, own.across - approached);
  }

  /// Upper bound of the displacement of a chunk's bodies since the search [m].
  double gone(std::size_t chunk) const { return chunk_[chunk].gone; }
  /// Upper bound of the displacement of walls since the search, or the last one at walls [m].
  double walls_gone() const { return wall_.gone; }
  /// Those since the search along paths, summed over steps, so that they never decrease.
  double walked(std::size_t chunk) const { return chunk_[chunk].walked; }
  double walls_walked() const { return wall_.walked; }
  /// Half the approach of two bodies of a chunk, and the part of it in the approach of one of its bodies and one of
  /// another, since the search, summed over steps [m].
  double within(std::size_t chunk) const { return chunk_[chunk].within; }
  double across(std::size_t chunk) const { return chunk_[chunk].across; }
  /// The same as walked() and across() for straight ways from the search to here, as far as they have been measured.
  double displaced(std::size_t chunk) const { return chunk_[chunk].walked - chunk_[chunk].detour; }
  double approached(std::size_t chunk) const { return chunk_[chunk].across - chunk_[chunk].detour_across; }
  double parting(std::size_t chunk) const { return chunk_[chunk].parting; }
  /// walls_walked() at the last search at walls.
  double walls_walked_at_search() const { return wall_.walked_at_search; }

  void serialize(SharedArchive& archive) {
    chunk_.resize(archive.length(chunk_.size(), sizeof(Way)));
    archive(wall_, largest_, reach_);
    archive.each_chunk(chunk_.size(), [this](Archive& own, std::size_t chunk) { own(chunk_[chunk]); });
  }

 private:
  struct Way {
    double skin = 0, gone = 0, walked = 0, at_walls = 0, within = 0, across = 0, parting = 0, detour = 0,
           detour_across = 0;
    Velocity reference{};
    void serialize(Archive& archive) {
      archive(skin, gone, walked, at_walls, within, across, parting, detour, detour_across, reference);
    }
  };
  struct WayOfWalls {
    double skin = 0, gone = 0, walked = 0, walked_at_search = 0;
    void serialize(Archive& archive) { archive(skin, gone, walked, walked_at_search); }
  };
  std::vector<Way> chunk_;
  WayOfWalls wall_;
  double largest_ = 0, reach_ = 0;
};

}  // namespace grit
