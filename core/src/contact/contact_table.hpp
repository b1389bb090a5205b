// All candidate pairs, what touching ones remember, and what they do this step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/search.hpp"
#include "contact/team.hpp"
#include "grit/contact/contact_law.hpp"
#include "scene/bodies.hpp"

namespace grit {

/// A cache line of state: one field of a block of contacts.
struct alignas(64) StateLine {
  double lane[block_size]{};
};

/// Pairs are filed by the chunk of their lower body, those that touch first, so that blocks are full of touching lanes
/// and the distance test is most that the others cost. Memory of contacts moves along when the table is rebuilt.
class ContactTable {
 public:
  /// `order[i]` is the old index of the body that now has index i; empty where indices have not changed.
  void rebuild(const Bodies& bodies, const NeighbourSearch& search, bool periodic, std::span<const StateField> fields,
               std::span<const std::uint32_t> order, Team& team);
  /// Makes room for another set of fields; the leading ones that both have are kept.
  void set_fields(std::span<const StateField> fields);

  /// Evaluates one chunk: fills its rows, adds to the sums of its bodies. Returns the largest overlap over a radius.
  double evaluate(std::size_t chunk, const ContactLaw& law, const Bodies& bodies, bool one_material,
                  const ImageShift* shifts, double dt, BodySum* sum);

  /// Adds what the contacts do to `body` as their b. Always in the same order.
  void gather(std::size_t body, Quad& force, Quad& moment) const {
    const std::uint32_t* entry = inbox_.data() + inbox_start_[body];
    const std::uint32_t* const far = inbox_.data() + inbox_far_[body];
    const std::uint32_t* const end = inbox_.data() + inbox_start_[body + 1];
    for (; entry != far; ++entry) add(row_[*entry], force, moment);
    for (; entry != end; ++entry)
      if (touches(*entry)) add(row_[*entry], force, moment);
  }

  /// Asks for the memory that gather() will read.
  void prefetch(std::size_t body) const {
    for (std::uint32_t e = inbox_start_[body]; e < inbox_far_[body]; ++e) {
      __builtin_prefetch(&row_[inbox_[e]].force);
    }
  }

  std::size_t candidates() const { return a_.size(); }
  bool touches(std::size_t c) const { return (touching_[c / block_size] >> (c % block_size) & 1) != 0; }
  std::uint32_t a(std::size_t c) const { return a_[c]; }
  std::uint32_t b(std::size_t c) const { return b_[c]; }
  std::uint8_t image(std::size_t c) const { return image_.empty() ? 0 : image_[c]; }
  const ContactRow& row(std::size_t c) const { return row_[c]; }
  /// Memory of candidate c.
  std::vector<double> state(std::size_t c) const;
  std::size_t touching_count() const;

 private:
  struct Chunk {
    std::uint32_t first_block = 0, last_block = 0;
  };
  static void add(const ContactRow& row, Quad& force, Quad& moment) {
    force += load(row.force), moment += load(row.moment);
  }
  void make_inbox(std::size_t bodies);

  std::vector<Chunk> chunks_;
  std::vector<std::uint32_t> a_, b_;
  std::vector<std::uint8_t> image_;  // empty without periodic boundaries
  std::vector<std::uint8_t> touching_;
  std::vector<StateField> fields_;
  LargeArray<StateLine> state_;  // [block][field]
  LargeArray<ContactRow> row_;
  // Candidates by their b: inbox_start_[b] … inbox_far_[b] touched when the table was built, the rest did not.
  std::vector<std::uint32_t> inbox_, inbox_start_, inbox_far_;
  std::vector<std::uint8_t> near_;             // of each candidate: touched when the table was built
  std::vector<std::vector<Candidate>> found_;  // by chunk
};

}  // namespace grit
