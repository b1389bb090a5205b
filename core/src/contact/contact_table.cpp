#include "contact/contact_table.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

#include "grit/contact/fields.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

/// Number of rows to prefetch: about 100 ns, the latency of memory.
constexpr std::uint32_t gather_ahead = 48;

/// Reserves memory for `count` entries without copying the present ones.
template <class Array>
void make_room(Array& array, std::size_t count) {
  if (array.capacity() < count) {
    Array().swap(array);
    array.reserve(count + count / 16);
  }
  array.resize(count);
}

template <class Array>
void give_back(Array& array) {
  Array().swap(array);
}

/// Indices of candidates have 31 bits.
template <class Candidates>
void check_size(const std::vector<std::size_t>& within, const Candidates& found) {
  constexpr std::size_t most = std::size_t{1} << 31;
  std::size_t slots = 0;
  const auto add = [&](std::size_t pairs) { slots += (pairs + block_size - 1) / block_size * block_size; };
  for (std::size_t chunk = 0; chunk < within.size(); ++chunk)
    add(within[chunk]), add(found[chunk].size() - within[chunk]);
  if (slots >= most)
    throw Error("found " + std::to_string(slots) +
                " pairs of bodies that are near each other; allowed are fewer than " + std::to_string(most) +
                ": use fewer bodies, or sizes that differ less");
}

}  // namespace

void ContactTable::rebuild(const Bodies& bodies, const NeighbourSearch& search, bool periodic,
                           std::span<const StateField> fields, const Renumbering& now, const ChunkBoxes& boxes,
                           Ranks& ranks, Team& team) {
  set_fields(fields);
  const std::size_t count = bodies.count(), field_count = fields_.size();
  const std::vector<Sent> sent = exchange_histories(now, ranks);
  const auto slots_before = static_cast<std::uint32_t>(a_.size());
  bodies_ = count;
  take_chunks(ranks);

  std::vector<std::uint32_t> former_start(count + 1, 0);  // by lower body
  const auto each_former = [&](auto&& use) {
    for (std::size_t block = 0; block < touching_.size(); ++block)
      for (std::uint32_t mask = touching_[block]; mask != 0; mask &= mask - 1) {
        const auto slot = static_cast<std::uint32_t>(block * block_size + as_index(std::countr_zero(mask)));
        const std::uint32_t p = now(a_[slot]), q = now(b_[slot]);
        if (p != body_gone && q != body_gone) use(std::min(p, q), Former{std::max(p, q), slot, p > q, nowhere});
      }
    for (std::uint32_t k = 0; k < sent.size(); ++k) {
      const auto [p, q] = sent[k];
      use(std::min(p, q), Former{std::max(p, q), slots_before + k, p > q, nowhere});
    }
  };
  each_former([&](std::uint32_t lower, const Former&) { ++former_start[lower + 1]; });
  std::partial_sum(former_start.begin(), former_start.end(), former_start.begin());
  formers_.resize(former_start.back());
  const std::span<Former> formers(formers_);
  // While pairs are sorted in, the start of each lower body moves to that of the next.
  each_former([&](std::uint32_t lower, const Former& former) { formers[former_start[lower]++] = former; });
  std::move_backward(former_start.begin(), former_start.end() - 1, former_start.end());
  former_start.front() = 0;

  const std::size_t chunk_count = chunks_of(count);
  found_.resize(chunk_count), within_.assign(chunk_count, 0), widest_.assign(chunk_count, 0);
  team.each(last_own_ - first_own_, [&](std::size_t k) { find_pairs(first_own_ + k, bodies, search); });
  ranks.complete(widest_);
  if (ranks.several()) find_pairs_below(bodies, search, boxes, team);
  check_size(within_, found_);
  chunks_.resize(chunk_count);
  std::uint32_t blocks = 0;
  const auto take = [&](std::size_t pairs) {
    const std::uint32_t first = blocks;
    blocks += static_cast<std::uint32_t>((pairs + block_size - 1) / block_size);
    return Blocks{first, first, blocks};
  };
  for (std::size_t chunk = 0; chunk < chunk_count; ++chunk) chunks_[chunk].within = take(within_[chunk]);
  first_cross_ = std::size_t{blocks} * block_size;
  for (std::size_t chunk = 0; chunk < chunk_count; ++chunk)
    chunks_[chunk].across = take(found_[chunk].size() - within_[chunk]);

  const std::size_t slots = std::size_t{blocks} * block_size;
  // Padding pairs a body with the dummy body far away.
  const auto pad = static_cast<std::uint32_t>(count);
  make_room(a_, slots), make_room(b_, slots), make_room(near_, slots), make_room(image_, periodic ? slots : 0);
  touching_.assign(blocks, 0), acting_.assign(search.reach() > 0 ? blocks : 0, 0), asleep_until_.resize(blocks);
  team.each(chunk_count, [&](std::size_t chunk) {
    const auto pad_to = [&](std::size_t slot, std::uint32_t block) {
      for (; slot < std::size_t{block} * block_size; ++slot) {
        a_[slot] = static_cast<std::uint32_t>(chunk * chunk_bodies), b_[slot] = pad, near_[slot] = 0;
        if (periodic) image_[slot] = 0;
      }
    };
    std::size_t slot = std::size_t{chunks_[chunk].within.first} * block_size;
    for (std::size_t n = 0; n < found_[chunk].size(); ++n) {
      if (n == within_[chunk]) {
        pad_to(slot, chunks_[chunk].within.last);
        slot = std::size_t{chunks_[chunk].across.first} * block_size;
      }
      const Found& c = found_[chunk][n];
      const auto a = static_cast<std::uint32_t>(chunk * chunk_bodies + c.a);
      a_[slot] = a, b_[slot] = c.b, near_[slot] = c.touching();
      float& asleep_until = asleep_until_[slot / block_size];
      asleep_until = slot % block_size == 0 ? c.gap : std::min(asleep_until, c.gap);
      if (slot % block_size == 0) {
        Blocks& own = n < within_[chunk] ? chunks_[chunk].within : chunks_[chunk].across;
        if (c.touching()) own.near = static_cast<std::uint32_t>(slot / block_size + 1);
      }
      if (periodic) image_[slot] = c.image;
      for (std::uint32_t m = former_start[a]; m < former_start[a + 1]; ++m) {
        if (formers[m].other != c.b) continue;
        touching_[slot / block_size] |= static_cast<std::uint8_t>(1u << (slot % block_size));
        formers[m].to = static_cast<std::uint32_t>(slot);
      }
      ++slot;
    }
    const bool none_across = found_[chunk].size() == within_[chunk];
    give_back(found_[chunk]);
    pad_to(slot, none_across ? chunks_[chunk].within.last : chunks_[chunk].across.last);
  });

  // Contact histories are permuted in place, field by field, so that only one field needs a copy. All histories of a
  // chunk's blocks belong to its bodies.
  const std::size_t lines = std::size_t{blocks} * field_count;
  // Reserved but unused pages take no memory; while the reserve suffices, nothing is copied.
  if (state_.capacity() < lines) state_.reserve(lines + lines / 2);
  state_.resize(std::max(state_.size(), lines));
  const auto number = [&](std::size_t slot, std::size_t f) -> double& {
    return state_[slot / block_size * field_count + f].lane[slot % block_size];
  };
  const auto former_number = [&](std::size_t from, std::size_t f) {
    return from < slots_before ? number(from, f) : received_[(from - slots_before) * field_count + f];
  };
  field_.resize(field_count > 0 ? formers.size() : 0);
  for (std::size_t f = 0; f < field_count + 1; ++f)
    team.each(chunk_count, [&](std::size_t chunk) {
      const std::size_t first = former_start[chunk * chunk_bodies];
      const std::size_t last = former_start[std::min(count, (chunk + 1) * chunk_bodies)];
      if (f > 0) {
        for (const Blocks own : {chunks_[chunk].within, chunks_[chunk].across})
          for (std::size_t block = own.first; block < own.last; ++block) state_[block * field_count + f - 1] = {};
        for (std::size_t m = first; m < last; ++m)
          if (formers[m].to != nowhere) number(formers[m].to, f - 1) = field_[m];
      }
      if (f == field_count) return;
      for (std::size_t m = first; m < last; ++m)
        field_[m] = former_number(formers[m].from, f) * (formers[m].swapped ? fields_[f].swap : 1.0);
    });
  state_.resize(lines);
  give_back(received_);

  // Rows of contacts are written before they are read. Those of pairs that were near but do not interact are read
  // without being written.
  make_room(row_, slots - first_cross_);
  team.each(chunk_count, [&](std::size_t chunk) {
    const auto row = [&](std::uint32_t block) {
      return row_.begin() + std::ptrdiff_t(block * block_size - first_cross_);
    };
    std::fill(row(chunks_[chunk].across.first), row(chunks_[chunk].across.near), ContactRow{});
  });
  make_inbox(count);
  find_reached();
  find_evaluated();
}

void ContactTable::take_chunks(const Ranks& ranks) {
  cuts_ = ranks.cuts();
  first_own_ = ranks.first(), last_own_ = ranks.last();
  whole_ = !ranks.several();
}

void ContactTable::find_evaluated() {
  evaluated_.clear(), shared_.clear();
  is_shared_.assign(chunks_.size(), 0);
  const auto owns = [this](std::size_t chunk) { return chunk >= first_own_ && chunk < last_own_; };
  for (std::size_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    if (!owns(chunk) && chunks_[chunk].across.first == chunks_[chunk].across.last) continue;
    evaluated_.push_back(static_cast<std::uint32_t>(chunk));
    if (owns(chunk) && std::ranges::all_of(reached_[chunk], owns)) continue;
    shared_.push_back(static_cast<std::uint32_t>(chunk)), is_shared_[chunk] = 1;
  }
}

std::vector<ContactTable::Sent> ContactTable::exchange_histories(const Renumbering& now, Ranks& ranks) {
  received_.clear();
  if (whole_) return {};  // all ranks have all pairs
  std::vector<std::vector<Sent>> pairs(ranks.count());
  std::vector<std::vector<double>> numbers(ranks.count());
  for (const Kind kind : {Kind::within, Kind::across}) {
    const Blocks own = own_blocks(kind);
    each_touching(own.first, own.last, [&](std::size_t c) {
      const std::uint32_t p = now(a_[c]), q = now(b_[c]);
      if (p == body_gone || q == body_gone) return;
      const unsigned to = ranks.cuts().owner_of_body(p), other = ranks.cuts().owner_of_body(q);
      const auto send = [&](unsigned rank) {
        if (rank == ranks.rank() || rank == cuts_.owner_of_body(b_[c])) return;
        pairs[rank].push_back({p, q});
        for (std::size_t f = 0; f < fields_.size(); ++f) numbers[rank].push_back(history_of(c, f));
      };
      send(to);
      if (other != to) send(other);
    });
  }
  const std::vector<std::vector<Sent>> found = ranks.exchange(pairs);
  std::vector<Sent> sent;
  for (const auto& list : found) sent.insert(sent.end(), list.begin(), list.end());
  for (const auto& list : ranks.exchange(numbers)) received_.insert(received_.end(), list.begin(), list.end());
  return sent;
}

// Candidates, chunk by chunk: first those within the chunk, then those across; of each kind first those that touch,
// then the others by their gap, to within a 64th of the largest.
void ContactTable::find_pairs(std::size_t chunk, const Bodies& bodies, const NeighbourSearch& search) {
  static thread_local std::vector<Candidate> found;
  found.clear();
  const ChunkRange range(chunk, bodies.count());
  for (std::size_t i = range.first; i < range.last; ++i)
    search.neighbours(bodies, static_cast<std::uint32_t>(i), found);
  widest_[chunk] = std::numeric_limits<float>::min();
  for (const Candidate& c : found) widest_[chunk] = std::max(widest_[chunk], c.gap);
  sort_pairs(chunk, found, range.last);
}

void ContactTable::find_pairs_below(const Bodies& bodies, const NeighbourSearch& search, const ChunkBoxes& boxes,
                                    Team& team) {
  const std::vector<std::size_t> near = boxes.near_below(first_own_, last_own_);
  const auto below = static_cast<std::uint32_t>(first_own_ * chunk_bodies);
  std::vector<std::vector<Candidate>> by_chunk(last_own_ - first_own_);
  team.each(by_chunk.size(), [&](std::size_t k) {
    const std::size_t chunk = first_own_ + k;
    if (std::ranges::none_of(near, [&](std::size_t other) { return boxes.near(chunk, other); })) return;
    const ChunkRange range(chunk, bodies.count());
    for (std::size_t i = range.first; i < range.last; ++i)
      search.neighbours_below(bodies, static_cast<std::uint32_t>(i), below, by_chunk[k]);
  });
  std::vector<Candidate> found;
  for (auto& list : by_chunk) {
    found.insert(found.end(), list.begin(), list.end());
    give_back(list);
  }
  std::ranges::sort(found, [](const Candidate& x, const Candidate& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  for (auto begin = found.begin(); begin != found.end();) {
    const std::size_t chunk = begin->a / chunk_bodies;
    const auto end = std::find_if(begin, found.end(), [&](const Candidate& c) { return c.a / chunk_bodies != chunk; });
    sort_pairs(chunk, {begin, end}, (chunk + 1) * chunk_bodies);
    begin = end;
  }
}

void ContactTable::sort_pairs(std::size_t chunk, std::span<const Candidate> found, std::size_t last) {
  constexpr std::size_t steps = 64, kinds = 1 + steps;
  const float widest = widest_[chunk];
  const auto place = [&](const Candidate& c) {
    const std::size_t step =
        c.touching() ? 0 : 1 + std::min(steps - 1, static_cast<std::size_t>(c.gap / widest * steps));
    return c.b < last ? step : kinds + step;
  };
  std::array<std::size_t, 2 * kinds + 1> next{};
  for (const Candidate& c : found) ++next[place(c) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  within_[chunk] = next[kinds];
  found_[chunk].resize(found.size());
  const std::size_t first = chunk * chunk_bodies;
  for (const Candidate& c : found)
    found_[chunk][next[place(c)]++] = {c.b, c.gap, static_cast<std::uint8_t>(c.a - first), c.image};
}

void ContactTable::make_inbox(std::size_t bodies) {
  const auto pad = static_cast<std::uint32_t>(bodies);
  std::vector<std::uint32_t> next(chunks_.size() + 1, 0);
  for (std::size_t c = first_cross_; c < b_.size(); ++c)
    if (b_[c] != pad) ++next[b_[c] / chunk_bodies + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t chunk = 0; chunk < chunks_.size(); ++chunk) {
    chunks_[chunk].inbox_first = next[chunk];
    chunks_[chunk].inbox_last = next[chunk + 1];
  }
  make_room(inbox_, next.back());
  for (std::size_t c = first_cross_; c < b_.size(); ++c)
    if (b_[c] != pad) inbox_[next[b_[c] / chunk_bodies]++] = {static_cast<std::uint32_t>(c - first_cross_), b_[c]};
  for (Chunk& chunk : chunks_) sort_inbox(chunk);
}

void ContactTable::sort_inbox(Chunk& chunk) {
  const auto kind = [this](const Letter& one) {
    return (near_[first_cross_ + one.row] != 0 ? 0 : chunk_bodies) + one.body % chunk_bodies;
  };
  std::array<std::uint32_t, 2 * chunk_bodies + 1> next{};
  const std::vector<Letter> letters(inbox_.begin() + std::ptrdiff_t(chunk.inbox_first),
                                    inbox_.begin() + std::ptrdiff_t(chunk.inbox_last));
  for (const Letter& one : letters) ++next[kind(one) + 1];
  next[0] = chunk.inbox_first;
  std::partial_sum(next.begin(), next.end(), next.begin());
  chunk.inbox_far = next[chunk_bodies];
  for (const Letter& one : letters) inbox_[next[kind(one)]++] = one;
}

void ContactTable::gather(std::size_t chunk, BodySum* sum) const {
  const auto add = [=, this](const Letter& letter) {
    sum[letter.body].force += load(row_[letter.row].force), sum[letter.body].moment += load(row_[letter.row].moment);
  };
  const Chunk& own = chunks_[chunk];
  for (std::uint32_t e = own.inbox_first; e < own.inbox_far; ++e) {
    if (e + gather_ahead < own.inbox_far) __builtin_prefetch(&row_[inbox_[e + gather_ahead].row]);
    add(inbox_[e]);
  }
  for (std::uint32_t e = own.inbox_far; e < own.inbox_last; ++e)
    if (contacts(first_cross_ + inbox_[e].row)) add(inbox_[e]);
}

void ContactTable::find_reached() {
  reached_.assign(chunks_.size(), {});
  for (std::size_t chunk = 0; chunk < chunks_.size(); ++chunk)
    for (std::uint32_t e = chunks_[chunk].inbox_first; e < chunks_[chunk].inbox_last; ++e) {
      auto& from = reached_[a_[first_cross_ + inbox_[e].row] / chunk_bodies];
      if (from.empty() || from.back() != chunk) from.push_back(static_cast<std::uint32_t>(chunk));
    }
}

void ContactTable::set_fields(std::span<const StateField> fields) {
  const std::size_t before = fields_.size(), after = fields.size();
  const std::vector<FieldMove> moves = moves_of_fields(fields_, fields);
  const bool same = same_fields(fields_, fields);
  fields_.assign(fields.begin(), fields.end());
  if (same) return;
  LargeArray<StateLine> state(touching_.size() * after);
  for (std::size_t block = 0; block < touching_.size(); ++block)
    for (const auto& [from, to] : moves) state[block * after + to] = state_[block * before + from];
  state_ = std::move(state);
}

PairBatch ContactTable::batch(Blocks blocks, const Instant& at, std::uint32_t last_body) const {
  return {.position = at.bodies.position.data(),
          .velocity = at.bodies.velocity.data(),
          .spin = at.bodies.spin.data(),
          .a = a_.data(),
          .b = b_.data(),
          .image = image_.empty() ? nullptr : image_.data(),
          .material = at.one_material ? nullptr : at.bodies.material.data(),
          .shifts = at.shifts,
          .first_block = blocks.first,
          .last_block = blocks.last,
          .last_near = blocks.near,
          .last_body = last_body,
          .dummy_body = static_cast<std::uint32_t>(at.bodies.count()),
          .next = nullptr,
          .next_first = 0,
          .next_count = 0,
          .dt = at.dt,
          .again = at.again,
          .closing = 0,
          .state = nullptr,
          .touching = nullptr,
          .acting = nullptr,
          .asleep_until = nullptr,
          .row = nullptr,
          .sum = nullptr,
          .largest_overlap = 0,
          .losses = nullptr};
}

double ContactTable::evaluate(Kind kind, std::size_t chunk, const Instant& at, BodySum* sum, Losses* losses) {
  const auto bodies = static_cast<std::uint32_t>(at.bodies.count());
  const auto end = static_cast<std::uint32_t>(std::min<std::size_t>(bodies, (chunk + 1) * chunk_bodies));
  const Blocks blocks = chunks_[chunk].of(kind), across = chunks_[chunk].across;
  if (blocks.first == blocks.last) return 0;
  PairBatch pairs = batch(blocks, at, end - 1);
  // Meanwhile, bodies of other chunks are prefetched, then those of the chunk that is likely next.
  if (kind == Kind::within) {
    pairs.next = b_.data() + std::size_t{across.first} * block_size;
    pairs.next_count = static_cast<std::uint32_t>((across.near - across.first) * block_size);
    pairs.closing = closing_within(chunk, at.skins);
  } else {
    pairs.row = row_.data() + (std::size_t{across.first} * block_size - first_cross_);
    pairs.next_first = end;
    pairs.next_count = std::min(bodies, end + static_cast<std::uint32_t>(chunk_bodies)) - end;
    pairs.closing = closing_across(chunk, at.skins);
  }
  pairs.state = state_.empty() ? nullptr : state_.front().lane;
  pairs.touching = touching_.data();
  pairs.acting = acting_.empty() ? nullptr : acting_.data();
  pairs.asleep_until = asleep_until_.data();
  pairs.sum = sum;
  pairs.losses = losses;
  at.law.evaluate_pairs(pairs);
  return pairs.largest_overlap;
}

void ContactTable::evaluate_again(std::size_t first_block, std::size_t last_block, const Instant& at,
                                  std::vector<ContactRow>& rows) const {
  const std::size_t fields = fields_.size(), first = first_block * block_size;
  const auto part = [](auto& array, std::size_t from, std::size_t to) {
    return std::vector(array.begin() + static_cast<std::ptrdiff_t>(from),
                       array.begin() + static_cast<std::ptrdiff_t>(to));
  };
  // A separate batch: blocks from 0 on, and a history that is discarded.
  auto state = part(state_, first_block * fields, last_block * fields);
  auto touching = part(touching_, first_block, last_block);
  rows.assign((last_block - first_block) * block_size, {});
  const auto blocks = static_cast<std::uint32_t>(last_block - first_block);
  PairBatch pairs = batch({0, blocks, blocks}, at, 0);
  pairs.a += first, pairs.b += first;
  if (pairs.image != nullptr) pairs.image += first;
  pairs.again = true;
  pairs.state = state.empty() ? nullptr : state.front().lane;
  pairs.touching = touching.data();
  pairs.row = rows.data();
  at.law.evaluate_pairs(pairs);
}

std::vector<double> ContactTable::state(std::size_t c) const {
  std::vector<double> numbers(fields_.size());
  for (std::size_t f = 0; f < numbers.size(); ++f) numbers[f] = history_of(c, f);
  return numbers;
}

std::size_t ContactTable::bytes() const {
  const auto bytes = [](const auto&... arrays) { return (... + (arrays.capacity() * sizeof(*arrays.data()))); };
  return bytes(a_, b_, image_, touching_, acting_, asleep_until_, row_, inbox_, near_, formers_, field_) +
         state_.size() * sizeof(StateLine);
}

void ContactTable::finish(Ranks ranks) {
  if (!ranks.several()) ranks.resize(chunks_.size());
  take_chunks(ranks);
  // Rows of pairs in contact are written before they are read.
  row_.assign(a_.size() - first_cross_, {});
  make_inbox(bodies_);
  find_reached();
  find_evaluated();
}

ContactTable::Blocks ContactTable::own_blocks(Kind kind) const {
  if (first_own_ == last_own_) return {};
  const std::uint32_t first = chunks_[first_own_].of(kind).first, last = chunks_[last_own_ - 1].of(kind).last;
  return {first, first, last};
}

std::size_t ContactTable::touching_count() const {
  std::size_t count = 0;
  for (const Kind kind : {Kind::within, Kind::across}) {
    const Blocks own = own_blocks(kind);
    for (std::size_t block = own.first; block < own.last; ++block)
      count += static_cast<std::size_t>(std::popcount(acting_.empty() ? touching_[block] : acting_[block]));
  }
  return count;
}

}  // namespace grit
