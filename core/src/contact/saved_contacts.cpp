// The table of contacts in a checkpoint: chunk by chunk, alike for any number of ranks.
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "bodies/restored.hpp"
#include "contact/contact_table.hpp"

namespace grit {
namespace {

/// Entries of a list for some blocks, of each so many.
template <class List>
auto of_blocks(List& list, std::size_t first, std::size_t last, std::size_t per_block) {
  return std::span(list).subspan(first * per_block, (last - first) * per_block);
}

}  // namespace

void ContactTable::serialize(SharedArchive& archive) {
  archive(bodies_);
  if (archive.restoring()) {
    expect_restored(chunks_of(bodies_) == archive.ranks().cuts().chunks(), "contacts are of another number of bodies");
    *this = empty();
    chunks_.resize(chunks_of(bodies_));
  }
  for (const Kind kind : {Kind::within, Kind::across}) {
    archive.each_chunk(chunks_.size(), [&](Archive& own, std::size_t chunk) {
      Blocks& blocks = chunks_[chunk].of(kind);
      if (!archive.restoring()) return save(own, blocks);
      if (archive.ranks().owns(chunk)) {
        blocks = restore(own, chunk, kind);
      } else {
        ContactTable record = empty();
        record.restore(own, chunk, kind);
        blocks = append_own_pairs(record, chunk, archive.ranks());
      }
    });
    if (archive.restoring() && kind == Kind::within) first_cross_ = a_.size();
  }
  if (!archive.restoring()) return;
  expect_restored(
      (image_.empty() || image_.size() == a_.size()) && (acting_.empty() || acting_.size() == touching_.size()),
      "lists of contacts have different lengths");
  finish(archive.ranks());
}

ContactTable ContactTable::empty() const {
  ContactTable other;
  other.bodies_ = bodies_, other.fields_ = fields_;
  return other;
}

void ContactTable::save(Archive& archive, Blocks blocks) const {
  std::uint32_t near = blocks.near - blocks.first, all = blocks.last - blocks.first;
  archive(near, all);
  if (all == 0) return;
  bool periodic = !image_.empty(), reaches = !acting_.empty();
  archive(periodic, reaches);
  const auto save = [&](const auto& list, std::size_t per_block) {
    if (!list.empty()) archive.append(std::as_bytes(of_blocks(list, blocks.first, blocks.last, per_block)));
  };
  save(a_, block_size), save(b_, block_size), save(near_, block_size), save(image_, block_size);
  save(touching_, 1), save(acting_, 1), save(asleep_until_, 1), save(state_, fields_.size());
}

ContactTable::Blocks ContactTable::restore(Archive& archive, std::size_t chunk, Kind kind) {
  constexpr std::size_t least = block_size * (sizeof(a_[0]) + sizeof(b_[0]) + sizeof(near_[0]));
  const std::size_t before = touching_.size();
  std::uint32_t near = 0, all = 0;
  archive(near, all);
  archive.expect(all, least);
  expect_restored(near <= all && before + all < std::numeric_limits<std::uint32_t>::max() / block_size,
                  "there are more contacts than bodies have");
  const auto first = static_cast<std::uint32_t>(before);
  const Blocks blocks{first, first + near, first + all};
  if (all == 0) return blocks;
  bool periodic = false, reaches = false;
  archive(periodic, reaches);
  expect_restored(image_.size() == (periodic ? before * block_size : 0) && acting_.size() == (reaches ? before : 0),
                  "lists of contacts have different lengths");
  const auto restore = [&](auto& list, std::size_t per_block) {
    list.resize((before + all) * per_block);
    archive.values(of_blocks(list, before, before + all, per_block));
  };
  restore(a_, block_size), restore(b_, block_size), restore(near_, block_size);
  if (periodic) restore(image_, block_size);
  restore(touching_, 1);
  if (reaches) restore(acting_, 1);
  restore(asleep_until_, 1), restore(state_, fields_.size());
  check_restored(chunk, blocks, kind);
  return blocks;
}

ContactTable::Blocks ContactTable::append_own_pairs(const ContactTable& from, std::size_t chunk, const Ranks& ranks) {
  Blocks blocks;
  blocks.first = blocks.near = static_cast<std::uint32_t>(touching_.size());
  std::vector<std::size_t> slots;
  for (std::size_t c = 0; c < from.b_.size(); ++c)
    if (from.b_[c] != bodies_ && ranks.owns_body(from.b_[c])) slots.push_back(c);
  for (std::size_t first = 0; first < slots.size(); first += block_size) {
    append_block(from, chunk, std::span(slots).subspan(first, std::min(block_size, slots.size() - first)));
    if (from.near_[slots[first]] != 0) blocks.near = static_cast<std::uint32_t>(touching_.size());
  }
  blocks.last = static_cast<std::uint32_t>(touching_.size());
  return blocks;
}

void ContactTable::append_block(const ContactTable& from, std::size_t chunk, std::span<const std::size_t> slots) {
  const std::size_t fields = fields_.size();
  std::uint8_t touches = 0, acts = 0;
  state_.resize(state_.size() + fields);
  StateLine* const lines = state_.data() + state_.size() - fields;
  for (std::size_t k = 0; k < block_size; ++k) {
    const bool there = k < slots.size();
    const std::size_t c = there ? slots[k] : 0, block = c / block_size;
    const auto bit = [&](std::uint8_t mask) {
      return static_cast<std::uint8_t>((there ? mask >> c % block_size & 1u : 0u) << k);
    };
    a_.push_back(there ? from.a_[c] : static_cast<std::uint32_t>(chunk * chunk_bodies));
    b_.push_back(there ? from.b_[c] : static_cast<std::uint32_t>(bodies_));
    near_.push_back(there ? from.near_[c] : 0);
    if (!from.image_.empty()) image_.push_back(there ? from.image_[c] : 0);
    touches |= bit(from.touching_[block]);
    if (!from.acting_.empty()) acts |= bit(from.acting_[block]);
    if (!there) continue;
    for (std::size_t f = 0; f < fields; ++f) lines[f].lane[k] = from.history_of(c, f);
  }
  // Evaluated at once: the approach until which the whole chunk sleeps is bounded by chunks that this rank does not
  // know.
  touching_.push_back(touches), asleep_until_.push_back(0);
  if (!from.acting_.empty()) acting_.push_back(acts);
}

void ContactTable::check_restored(std::size_t chunk, Blocks blocks, Kind kind) const {
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_, first + chunk_bodies);
  for (std::size_t c = std::size_t{blocks.first} * block_size; c < std::size_t{blocks.last} * block_size; ++c) {
    expect_restored(a_[c] >= first && a_[c] < last, "a contact is of a body that is not there");
    if (b_[c] == bodies_) {
      expect_restored(!contacts(c), "a contact is of one body only");
      continue;
    }
    expect_restored(b_[c] > a_[c] && (kind == Kind::within ? b_[c] < last : b_[c] >= last && b_[c] < bodies_),
                    "a contact is of a body that is not there");
    expect_restored(image(c) < all_images, "a contact is across a side that is not there");
  }
}

std::vector<std::uint32_t> ContactTable::places(std::size_t chunk, std::span<const std::uint32_t> candidates) const {
  std::vector<std::uint32_t> places;
  if (candidates.empty()) return places;
  const Chunk& own = chunks_[chunk];
  std::uint32_t letter = own.inbox_first;
  for (const std::uint32_t c : candidates) {
    const std::uint32_t block = c / static_cast<std::uint32_t>(block_size);
    const auto is_in = [block](Blocks blocks) { return block >= blocks.first && block < blocks.last; };
    const auto place_in = [c](Blocks blocks) { return c - blocks.first * static_cast<std::uint32_t>(block_size); };
    if (is_in(own.within)) places.push_back(place_in(own.within));
    else if (is_in(own.across)) places.push_back(own.within.slots() + place_in(own.across));
    else {
      while (letter < own.inbox_last && first_cross_ + inbox_[letter].row != c) ++letter;
      if (letter == own.inbox_last) throw std::logic_error("a candidate is not one of its chunk");
      places.push_back(own.within.slots() + own.across.slots() + letter - own.inbox_first);
    }
  }
  return places;
}

std::vector<std::uint32_t> ContactTable::candidates_at(std::size_t chunk, std::span<const std::uint32_t> places) const {
  const auto expect = [](bool fits) {
    expect_restored(fits, "the critical time step is of contacts that are not there");
  };
  expect(places.empty() || chunk < chunks_.size());
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t place : places) {
    const Chunk& own = chunks_[chunk];
    const auto slot = [&place](Blocks blocks) { return blocks.first * static_cast<std::uint32_t>(block_size) + place; };
    if (place < own.within.slots()) {
      candidates.push_back(slot(own.within));
    } else if ((place -= own.within.slots()) < own.across.slots()) {
      candidates.push_back(slot(own.across));
    } else {
      place -= own.across.slots();
      expect(place < own.inbox_last - own.inbox_first);
      candidates.push_back(static_cast<std::uint32_t>(first_cross_) + inbox_[own.inbox_first + place].row);
    }
    expect(b_[candidates.back()] != bodies_);
  }
  return candidates;
}

}  // namespace grit
