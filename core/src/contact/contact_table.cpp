#include "contact/contact_table.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace grit {
namespace {

/// Where a touching pair's memory lay before the rebuild, filed by the pair's lower body as it is now.
struct Memory {
  std::uint32_t other, slot;
  bool swapped;
};

}  // namespace

void ContactTable::rebuild(const Bodies& bodies, const NeighbourSearch& search, bool periodic,
                           std::span<const StateField> fields, std::span<const std::uint32_t> order, Team& team) {
  set_fields(fields);
  const std::size_t count = bodies.count(), field_count = fields_.size();
  std::vector<std::uint32_t> now(count);
  if (order.empty()) std::iota(now.begin(), now.end(), 0u);
  else
    for (std::size_t i = 0; i < count; ++i) now[order[i]] = static_cast<std::uint32_t>(i);

  // Old memories by their lower body.
  std::vector<std::uint32_t> memory_start(count + 1, 0);
  const auto each_memory = [&](auto&& use) {
    for (std::size_t block = 0; block < touching_.size(); ++block)
      for (std::uint32_t mask = touching_[block]; mask != 0; mask &= mask - 1) {
        const auto slot = static_cast<std::uint32_t>(block * block_size + std::countr_zero(mask));
        const std::uint32_t p = now[a_[slot]], q = now[b_[slot]];
        use(std::min(p, q), Memory{std::max(p, q), slot, p > q});
      }
  };
  each_memory([&](std::uint32_t lower, const Memory&) { ++memory_start[lower + 1]; });
  std::partial_sum(memory_start.begin(), memory_start.end(), memory_start.begin());
  std::vector<Memory> memories(memory_start.back());
  auto next = memory_start;
  each_memory([&](std::uint32_t lower, const Memory& memory) { memories[next[lower]++] = memory; });

  // Candidates, chunk by chunk, touching ones first.
  const std::size_t chunk_count = chunks_of(count);
  found_.resize(chunk_count);
  team.each(chunk_count, [&](std::size_t chunk) {
    auto& found = found_[chunk];
    found.clear();
    const std::size_t first = chunk * chunk_bodies, last = std::min(count, first + chunk_bodies);
    for (std::size_t i = first; i < last; ++i) search.neighbours(bodies, static_cast<std::uint32_t>(i), found);
    std::stable_partition(found.begin(), found.end(), [](const Candidate& c) { return c.touching != 0; });
  });
  chunks_.resize(chunk_count);
  std::uint32_t blocks = 0;
  for (std::size_t chunk = 0; chunk < chunk_count; ++chunk) {
    const auto own = static_cast<std::uint32_t>((found_[chunk].size() + block_size - 1) / block_size);
    chunks_[chunk] = {blocks, blocks + own};
    blocks += own;
  }

  const std::size_t slots = std::size_t{blocks} * block_size;
  const auto old_state = std::move(state_);
  // Padding pairs a body with the one that is far away.
  const auto pad = static_cast<std::uint32_t>(count);
  a_.resize(slots), b_.resize(slots), near_.resize(slots), image_.resize(periodic ? slots : 0);
  row_.assign(slots, {});
  touching_.assign(blocks, 0);
  state_.assign(std::size_t{blocks} * field_count, {});
  team.each(chunk_count, [&](std::size_t chunk) {
    std::size_t slot = std::size_t{chunks_[chunk].first_block} * block_size;
    for (const Candidate& c : found_[chunk]) {
      a_[slot] = c.a, b_[slot] = c.b, near_[slot] = c.touching;
      if (periodic) image_[slot] = c.image;
      for (std::uint32_t m = memory_start[c.a]; m < memory_start[c.a + 1]; ++m) {
        const Memory& memory = memories[m];
        if (memory.other != c.b) continue;
        touching_[slot / block_size] |= static_cast<std::uint8_t>(1u << (slot % block_size));
        for (std::size_t f = 0; f < field_count; ++f)
          state_[slot / block_size * field_count + f].lane[slot % block_size] =
              old_state[memory.slot / block_size * field_count + f].lane[memory.slot % block_size] *
              (memory.swapped ? fields_[f].swap : 1.0);
      }
      ++slot;
    }
    for (; slot < std::size_t{chunks_[chunk].last_block} * block_size; ++slot) {
      a_[slot] = static_cast<std::uint32_t>(std::min(count - 1, chunk * chunk_bodies)), b_[slot] = pad, near_[slot] = 0;
      if (periodic) image_[slot] = 0;
    }
  });
  make_inbox(count);
}

void ContactTable::make_inbox(std::size_t bodies) {
  const auto pad = static_cast<std::uint32_t>(bodies);
  inbox_start_.assign(bodies + 1, 0), inbox_far_.assign(bodies, 0);
  for (std::size_t c = 0; c < b_.size(); ++c)
    if (b_[c] != pad) ++inbox_start_[b_[c] + 1], inbox_far_[b_[c]] += near_[c];
  std::partial_sum(inbox_start_.begin(), inbox_start_.end(), inbox_start_.begin());
  inbox_.resize(inbox_start_.back());
  std::vector<std::uint32_t> next_near(inbox_start_.begin(), inbox_start_.end() - 1), next_far(bodies);
  for (std::size_t i = 0; i < bodies; ++i) next_far[i] = inbox_far_[i] += inbox_start_[i];
  for (std::size_t c = 0; c < b_.size(); ++c)
    if (b_[c] != pad) inbox_[near_[c] != 0 ? next_near[b_[c]]++ : next_far[b_[c]]++] = static_cast<std::uint32_t>(c);
}

void ContactTable::set_fields(std::span<const StateField> fields) {
  const std::size_t before = fields_.size(), after = fields.size();
  fields_.assign(fields.begin(), fields.end());
  if (before == after) return;
  LargeArray<StateLine> state(touching_.size() * after);
  for (std::size_t block = 0; block < touching_.size(); ++block)
    std::copy_n(state_.begin() + static_cast<std::ptrdiff_t>(block * before), std::min(before, after),
                state.begin() + static_cast<std::ptrdiff_t>(block * after));
  state_ = std::move(state);
}

double ContactTable::evaluate(std::size_t chunk, const ContactLaw& law, const Bodies& bodies, bool one_material,
                              const ImageShift* shifts, double dt, BodySum* sum) {
  PairBatch batch{.position = bodies.position.data(),
                  .velocity = bodies.velocity.data(),
                  .spin = bodies.spin.data(),
                  .a = a_.data(),
                  .b = b_.data(),
                  .image = image_.empty() ? nullptr : image_.data(),
                  .material = one_material ? nullptr : bodies.material.data(),
                  .shifts = shifts,
                  .first_block = chunks_[chunk].first_block,
                  .last_block = chunks_[chunk].last_block,
                  .dt = dt,
                  .state = state_.empty() ? nullptr : state_.front().lane,
                  .touching = touching_.data(),
                  .row = row_.data(),
                  .sum = sum,
                  .largest_overlap = 0};
  law.evaluate_pairs(batch);
  return batch.largest_overlap;
}

std::vector<double> ContactTable::state(std::size_t c) const {
  std::vector<double> numbers(fields_.size());
  for (std::size_t f = 0; f < numbers.size(); ++f)
    numbers[f] = state_[c / block_size * fields_.size() + f].lane[c % block_size];
  return numbers;
}

std::size_t ContactTable::touching_count() const {
  std::size_t count = 0;
  for (const std::uint8_t mask : touching_) count += static_cast<std::size_t>(std::popcount(mask));
  return count;
}

}  // namespace grit
