// All candidate pairs, with contact histories and the forces of this step.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "bodies/bodies.hpp"
#include "bodies/reordering.hpp"
#include "contact/chunk_boxes.hpp"
#include "contact/search.hpp"
#include "contact/skins.hpp"
#include "grit/contact/contact_law.hpp"
#include "ranks/shared_archive.hpp"
#include "threads/team.hpp"

namespace grit {

/// A cache line of state: one field of a block of contacts.
struct alignas(64) StateLine {
  double lane[block_size]{};
};

template <>
inline constexpr bool plain_numbers<StateLine> = true;

/// Pairs are sorted by the chunk of their lower body, the nearest first. Blocks are then full of contacts, and the
/// others are skipped until their bodies may have come close. Pairs within a chunk add to the sums of both bodies; only
/// pairs across chunks write a row for b. Contact histories are kept when the table is rebuilt.
///
/// With several ranks, each has the pairs of its own chunks, and those of its bodies with lower bodies of other ranks.
/// Both ranks evaluate these and keep their histories.
class ContactTable {
 public:
  /// `now`: of the bodies of pairs that this rank has had. `boxes`: of all chunks, if there are several ranks.
  void rebuild(const Bodies& bodies, const NeighbourSearch& search, bool periodic, std::span<const StateField> fields,
               const Renumbering& now, const ChunkBoxes& boxes, Ranks& ranks, Team& team);
  /// Changes the fields of the contact history; those in both sets are kept.
  void set_fields(std::span<const StateField> fields);

  /// Input of the law at one instant.
  struct Instant {
    const ContactLaw& law;
    const Bodies& bodies;
    bool one_material;
    const ImageShift* shifts;
    double dt;  ///< s
    const Skins& skins;
    bool again = false;  ///< whether this instant has been evaluated before
  };
  /// Pairs of bodies of one chunk, or of two.
  enum class Kind { within, across };
  /// Evaluates such pairs of one chunk, those within it first: writes their rows and adds to the sums of its bodies, by
  /// index, and of no others. Returns the largest overlap over a radius.
  double evaluate(Kind kind, std::size_t chunk, const Instant& at, BodySum* sum, Losses* losses);
  /// The chunks to evaluate, in ascending order: the own ones, and others with pairs of own bodies.
  const std::vector<std::uint32_t>& evaluated() const { return evaluated_; }
  /// Those of them whose pairs across chunks are with bodies of other ranks, too.
  const std::vector<std::uint32_t>& shared() const { return shared_; }
  bool is_shared(std::size_t chunk) const { return is_shared_[chunk] != 0; }
  /// Whether pairs of this kind, of the chunk of this candidate, are of own bodies only.
  bool is_independent(std::size_t c) const {
    const std::size_t chunk = a_[c] / chunk_bodies;
    return !is_shared(chunk) || b_[c] / chunk_bodies == chunk;
  }
  /// Calls use(candidate, row) for the contacts of own chunks at an evaluated instant, in order. Those of all ranks
  /// within chunks come before all across them.
  template <class Use>
  void each_touching(Kind kind, const Instant& at, Use use) const {
    each_touching(
        own_blocks(kind), at, [this](std::size_t block) { return touching_[block] != 0; }, use);
  }
  /// The same for the contacts of one chunk.
  template <class Use>
  void each_contact(std::size_t chunk, const Instant& at, Use use) const {
    const auto any = [this](std::size_t block) { return touching_[block] != 0; };
    for (const Blocks blocks : {chunks_[chunk].within, chunks_[chunk].across}) each_touching(blocks, at, any, use);
  }
  /// The same for the contacts of one chunk across a periodic boundary.
  template <class Use>
  void each_crossing(std::size_t chunk, const Instant& at, Use use) const {
    if (image_.empty()) return;
    const auto crosses = [this](std::size_t block) {
      bool any = false;
      each_touching(block, block + 1, [&](std::size_t c) { any = any || image_[c] != 0; });
      return any;
    };
    for (const Blocks blocks : {chunks_[chunk].within, chunks_[chunk].across})
      each_touching(blocks, at, crosses, [&](std::size_t c, const ContactRow& row) {
        if (image_[c] != 0) use(c, row);
      });
  }
  /// Calls use(candidate, history) for the contacts of one chunk.
  template <class Use>
  void each_history(std::size_t chunk, Use use) const {
    std::vector<double> history(fields_.size());
    for (const Blocks blocks : {chunks_[chunk].within, chunks_[chunk].across})
      each_touching(blocks.first, blocks.last, [&](std::size_t c) {
        for (std::size_t f = 0; f < history.size(); ++f) history[f] = history_of(c, f);
        use(c, std::span<const double>(history));
      });
  }
  /// Upper bounds of the approach of a body of a chunk and one of another, since the neighbour search, summed over
  /// steps [m]; by chunk.
  std::vector<double> closings_across(const Skins& skins) const {
    std::vector<double> closings(chunks_.size());
    for (std::size_t chunk = 0; chunk < closings.size(); ++chunk) closings[chunk] = closing_across(chunk, skins);
    return closings;
  }
  /// Calls use(candidate, distance) for pairs of a chunk's bodies, with each other and with others, whose surfaces
  /// touch or are nearer than `near` [m] plus the reach of the law. `closings`: closings_across().
  template <class Use>
  void each_near(std::size_t chunk, const Bodies& bodies, const ImageShift* shifts, const Skins& skins,
                 std::span<const double> closings, double near, Use use) const {
    // Without branches, as few processors predict which pairs are near.
    const double gap = near + skins.reach();
    const auto square = [&](std::size_t c) { return branch(c, bodies, shifts).squaredNorm(); };
    const auto limit = [&](std::size_t c) {
      const double distance = bodies.position[a_[c]].w + bodies.position[b_[c]].w + gap;
      return distance * distance;
    };
    const auto asleep = [&](std::size_t block, double closing) {
      return touching_[block] == 0 && closing + near < asleep_until_[block];
    };
    const auto take_all = [&](Blocks blocks, double closing) {
      for (std::size_t block = blocks.first; block < blocks.last; ++block) {
        if (asleep(block, closing)) continue;
        const std::size_t first = block * block_size;
        double squares[block_size];
        std::uint32_t mask = 0;
        for (std::size_t k = 0; k < block_size; ++k) {
          squares[k] = square(first + k);
          mask |= static_cast<std::uint32_t>(squares[k] < limit(first + k)) << k;
        }
        for (; mask != 0; mask &= mask - 1) {
          const auto k = static_cast<std::size_t>(std::countr_zero(mask));
          use(first + k, std::sqrt(squares[k]));
        }
      }
    };
    const Chunk& own = chunks_[chunk];
    take_all(own.within, closing_within(chunk, skins)), take_all(own.across, closings[chunk]);
    for (std::uint32_t e = own.inbox_first; e < own.inbox_last; ++e) {
      const std::size_t c = first_cross_ + inbox_[e].row;
      if (asleep(c / block_size, closings[a_[c] / chunk_bodies])) continue;
      if (const double of_centres = square(c); of_centres < limit(c)) use(c, std::sqrt(of_centres));
    }
  }
  /// From a to b [m].
  Vec3 branch(std::size_t c, const Bodies& bodies, const ImageShift* shifts) const {
    return xyz(bodies.position[b_[c]]) - xyz(bodies.position[a_[c]]) + xyz(shifts[image(c)].position);
  }

  /// Adds the forces of contacts across chunks on b to the bodies of this chunk, always in the same order.
  void gather(std::size_t chunk, BodySum* sum) const;
  /// By chunk: the other chunks that contain a b of its candidates.
  const std::vector<std::vector<std::uint32_t>>& reached() const { return reached_; }

  std::size_t candidates() const { return a_.size(); }
  /// Calls use(candidate) for all pairs, without padding.
  template <class Use>
  void each_candidate(Use use) const {
    for (std::size_t c = 0; c < b_.size(); ++c)
      if (b_[c] != bodies_) use(c);
  }
  bool contacts(std::size_t c) const { return (touching_[c / block_size] >> (c % block_size) & 1) != 0; }
  /// Whether a pair in contact, or within the reach of the law, overlaps or has a force.
  bool acts(std::size_t c) const { return acting_.empty() || (acting_[c / block_size] >> (c % block_size) & 1) != 0; }
  /// What another engine has found of a candidate.
  void set_contact(std::size_t c, bool touches, bool acts) {
    const auto set = [c](std::uint8_t& mask, bool on) {
      const auto bit = static_cast<std::uint8_t>(1u << (c % block_size));
      mask = static_cast<std::uint8_t>(on ? mask | bit : mask & ~bit);
    };
    set(touching_[c / block_size], touches);
    if (!acting_.empty()) set(acting_[c / block_size], acts);
  }
  void set_history(std::size_t c, std::size_t field, double number) {
    state_[c / block_size * fields_.size() + field].lane[c % block_size] = number;
  }
  std::uint32_t a(std::size_t c) const { return a_[c]; }
  std::uint32_t b(std::size_t c) const { return b_[c]; }
  std::uint8_t image(std::size_t c) const { return image_.empty() ? 0 : image_[c]; }
  /// Contact history of candidate c.
  std::vector<double> state(std::size_t c) const;
  /// Number of pairs of own chunks that overlap or have a force.
  std::size_t touching_count() const;
  /// Memory [bytes].
  std::size_t bytes() const;
  /// Whether it has the pairs of all ranks.
  bool is_whole() const { return whole_; }
  /// Chunk by chunk, in the order of all sums. Restored into a table whose fields are set; a rank keeps what it needs.
  /// Throws Error for pairs that cannot be.
  void serialize(SharedArchive& archive);
  /// Where some candidates, in the order of each_near(), are among those of a chunk: alike for any number of ranks.
  std::vector<std::uint32_t> places(std::size_t chunk, std::span<const std::uint32_t> candidates) const;
  /// The reverse. Throws Error for places that are not there.
  std::vector<std::uint32_t> candidates_at(std::size_t chunk, std::span<const std::uint32_t> places) const;
  /// Number of bodies when the table was built.
  std::size_t bodies() const { return bodies_; }

 private:
  static constexpr std::size_t blocks_at_once = 64;
  struct Blocks {
    std::uint32_t first = 0, near = 0, last = 0;  ///< from `near` on none was in contact when the table was built
    std::uint32_t slots() const { return (last - first) * static_cast<std::uint32_t>(block_size); }
  };
  struct Chunk {
    Blocks within, across;
    std::uint32_t inbox_first = 0, inbox_far = 0, inbox_last = 0;
    Blocks& of(Kind kind) { return kind == Kind::within ? within : across; }
    const Blocks& of(Kind kind) const { return kind == Kind::within ? within : across; }
  };
  /// Destination of a row of another chunk.
  struct Letter {
    std::uint32_t row, body;
  };
  /// A candidate within its chunk; small, because all candidates exist at once during a rebuild.
  struct Found {
    std::uint32_t b;
    float gap;
    std::uint8_t a;  ///< index in the chunk
    std::uint8_t image;
    bool touching() const { return gap == 0; }
  };
  static_assert(chunk_bodies <= 256);
  static constexpr std::uint32_t nowhere = ~0u;  // slot of a pair that is no longer a candidate
  /// A pair that was in contact before the rebuild, sorted by its present lower body index.
  struct Former {
    std::uint32_t other = 0;                       ///< higher body index
    std::uint32_t from : 31 = 0, swapped : 1 = 0;  ///< its index before; whether a and b have been exchanged
    std::uint32_t to = nowhere;                    ///< its index now
  };
  /// Upper bound of the approach of two bodies of a chunk, or of one of it and one of another, since the neighbour
  /// search, summed over steps [m].
  static double closing_within(std::size_t chunk, const Skins& skins) { return 2 * skins.within(chunk); }
  double closing_across(std::size_t chunk, const Skins& skins) const {
    double furthest = 0;
    for (const std::uint32_t other : reached_[chunk]) furthest = std::max(furthest, skins.across(other));
    return skins.across(chunk) + furthest;
  }
  double history_of(std::size_t c, std::size_t field) const {
    return state_[c / block_size * fields_.size() + field].lane[c % block_size];
  }
  /// Calls use(candidate) for the contacts of some blocks.
  template <class Use>
  void each_touching(std::size_t first_block, std::size_t last_block, Use use) const {
    for (std::size_t block = first_block; block < last_block; ++block)
      for (std::uint32_t mask = touching_[block]; mask != 0; mask &= mask - 1)
        use(block * block_size + static_cast<std::size_t>(std::countr_zero(mask)));
  }
  /// Calls use(candidate, row) for the contacts of the selected blocks.
  template <class Wanted, class Use>
  void each_touching(Blocks blocks, const Instant& at, Wanted wanted, Use use) const {
    std::vector<ContactRow> rows;
    for (std::size_t block = blocks.first, last; block < blocks.last; block = last) {
      // Many blocks have none, mostly contiguous ones.
      for (last = block; last < blocks.last && last < block + blocks_at_once && wanted(last);) ++last;
      if (last > block) {
        evaluate_again(block, last, at, rows);
        each_touching(block, last, [&](std::size_t c) { use(c, rows[c - block * block_size]); });
      } else {
        ++last;
      }
    }
  }
  PairBatch batch(Blocks blocks, const Instant& at, std::uint32_t last_body) const;
  /// The blocks of all own chunks.
  Blocks own_blocks(Kind kind) const;
  /// Finds the pairs of an own chunk, sorted as they will be in the table.
  void find_pairs(std::size_t chunk, const Bodies& bodies, const NeighbourSearch& search);
  /// The same for those of own bodies with lower ones of other ranks.
  void find_pairs_below(const Bodies& bodies, const NeighbourSearch& search, const ChunkBoxes& boxes, Team& team);
  void sort_pairs(std::size_t chunk, std::span<const Candidate> found, std::size_t last);
  /// A pair whose history another rank has sent: present indices of its bodies.
  struct Sent {
    std::uint32_t a, b;
  };
  /// Sends histories to ranks that will have their pairs and have not had them.
  std::vector<Sent> exchange_histories(const Renumbering& now, Ranks& ranks);
  /// Which chunks are own ones, after they have been divided among ranks.
  void take_chunks(const Ranks& ranks);
  /// Finds the chunks to evaluate, and those shared.
  void find_evaluated();
  /// Makes what follows from the lists.
  void finish(Ranks ranks);
  void evaluate_again(std::size_t first_block, std::size_t last_block, const Instant& at,
                      std::vector<ContactRow>& rows) const;
  /// Some blocks of a chunk.
  void save(Archive& archive, Blocks blocks) const;
  /// Appends blocks of a chunk, and returns them.
  Blocks restore(Archive& archive, std::size_t chunk, Kind kind);
  /// Appends the pairs with own bodies of a chunk of another rank; `from` has the pairs of this chunk only.
  Blocks append_own_pairs(const ContactTable& from, std::size_t chunk, const Ranks& ranks);
  void append_block(const ContactTable& from, std::size_t chunk, std::span<const std::size_t> slots);
  /// A table of the same bodies and fields, without chunks.
  ContactTable empty() const;
  /// Throws Error unless the restored pairs in some blocks of a chunk can be.
  void check_restored(std::size_t chunk, Blocks blocks, Kind kind) const;
  void make_inbox(std::size_t bodies);
  void sort_inbox(Chunk& chunk);
  void find_reached();

  std::size_t bodies_ = 0;
  std::vector<Chunk> chunks_;
  // Candidates: first those within chunks, then those across.
  LargeArray<std::uint32_t> a_, b_;
  LargeArray<std::uint8_t> image_;  // empty without periodic boundaries
  std::vector<std::uint8_t> touching_;
  std::vector<std::uint8_t> acting_;  // with a law that has a reach: pairs that overlap or have a force; else empty
  std::vector<float> asleep_until_;   // of blocks without contacts: approach before there can be one [m]
  std::vector<StateField> fields_;
  LargeArray<StateLine> state_;  // [block][field]
  std::size_t first_cross_ = 0;  // first candidate across chunks; it has the first row
  LargeArray<ContactRow> row_;
  LargeArray<Letter> inbox_;       // by chunk of b, first those in contact when the table was built; then by b
  LargeArray<std::uint8_t> near_;  // by candidate: in contact when the table was built
  std::vector<std::vector<std::uint32_t>> reached_;  // by chunk
  std::vector<std::vector<Found>> found_;            // by chunk
  std::vector<std::size_t> within_;                  // by chunk: number of candidates within it
  std::vector<float> widest_;                        // by chunk: largest gap of its candidates [m]
  Cuts cuts_;                                        // which rank had which chunk at the last rebuild
  bool whole_ = true;                                // whether it has the pairs of all ranks
  std::size_t first_own_ = 0, last_own_ = 0;         // chunks
  std::vector<std::uint32_t> evaluated_, shared_;
  std::vector<std::uint8_t> is_shared_;  // by chunk
  // Used by rebuilds only. They are kept, as new pages would have to be cleared each time.
  LargeArray<Former> formers_;
  LargeArray<double> field_;
  std::vector<double> received_;  // histories from other ranks, one after the other
};

}  // namespace grit
