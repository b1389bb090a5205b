#include "contact/migration.hpp"

#include <algorithm>
#include <numeric>

namespace grit {
namespace {

struct Traveller {
  Row position, velocity, spin;
  Vec3 rotation, origin;
  CurvePlace place;
  std::uint8_t material;
};

Traveller traveller(const Bodies& bodies, const CurvePlace& place) {
  const std::size_t i = place.body;
  return {bodies.position[i],
          bodies.velocity[i],
          bodies.spin[i],
          bodies.rotation.empty() ? Vec3(Vec3::Zero()) : bodies.rotation[i],
          bodies.origin.empty() ? Vec3(Vec3::Zero()) : bodies.origin[i],
          place,
          bodies.material[i]};
}

void settle(const Traveller& one, std::size_t i, Bodies& bodies) {
  bodies.position[i] = one.position, bodies.velocity[i] = one.velocity, bodies.spin[i] = one.spin;
  bodies.id[i] = one.place.id, bodies.material[i] = one.material;
  if (!bodies.rotation.empty()) bodies.rotation[i] = one.rotation;
  if (!bodies.origin.empty()) bodies.origin[i] = one.origin;
}

/// With the padding at their end.
void resize(Bodies& bodies, std::size_t count) {
  const std::size_t before = bodies.count();
  const auto change = [&](auto&... arrays) {
    const auto one = [&](auto& array) {
      const auto padding = array[before];
      array.resize(count + 1);
      array[count] = padding;
    };
    (one(arrays), ...);
  };
  change(bodies.position, bodies.velocity, bodies.spin, bodies.material);
  bodies.id.resize(count);
  if (!bodies.rotation.empty()) bodies.rotation.resize(count);
  if (!bodies.origin.empty()) bodies.origin.resize(count);
}

/// For each rank but the first, the largest value of so many bits below which there are at most `most` entries of all
/// ranks. `below(rank, value)` counts own entries. Found bit by bit, for all ranks at once.
template <class Below>
std::vector<std::uint64_t> split(int bits, std::span<const std::uint64_t> most, Below below, Ranks& ranks) {
  std::vector<std::uint64_t> found(most.size(), 0), counts(most.size());
  for (int bit = bits - 1; bit >= 0; --bit) {
    const std::uint64_t one = std::uint64_t{1} << bit;
    for (std::size_t r = 0; r < found.size(); ++r) counts[r] = below(r, found[r] | one);
    ranks.sum(counts);
    for (std::size_t r = 0; r < found.size(); ++r)
      if (counts[r] <= most[r]) found[r] |= one;
  }
  return found;
}

}  // namespace

Migration::Migration(const Bodies& bodies, const std::vector<bool>& leaves, const Cell& cell, Ranks& ranks, Team& team)
    : before_(bodies.count()) {
  std::vector<std::uint32_t> chunks(ranks.last() - ranks.first());
  std::iota(chunks.begin(), chunks.end(), static_cast<std::uint32_t>(ranks.first()));
  // Bodies that leave shape the curve, too, as they do in spatial_order().
  Extent box = extent(bodies, chunks, team);
  for (const Extent& of_rank : ranks.each(box)) box.add(of_rank);
  box.take_periods(cell);
  const Curve curve(box, before_);
  bits_ = curve.bits();
  const std::size_t first = ChunkRange(ranks.first(), before_).first, last = ChunkRange(ranks.last(), before_).first;
  for (std::size_t i = first; i < last; ++i)
    if (leaves[i]) gone_.push_back(static_cast<std::uint32_t>(i));
    else own_.push_back(curve.place(bodies, i));
  sort_along(curve, own_, team);
  for (const std::size_t of_rank : ranks.each(own_.size())) count_ += of_rank;
}

std::vector<std::size_t> Migration::starts(Ranks& ranks) const {
  std::vector<std::uint64_t> most;  // bodies before those of each rank but the first
  for (unsigned r = 1; r < ranks.count(); ++r) most.push_back(std::min(ranks.cuts().first(r) * chunk_bodies, count_));
  const auto below = [this](std::uint64_t key, std::uint64_t id) {
    const auto at = std::ranges::lower_bound(own_, std::pair(key, id), {}, [](const CurvePlace& one) {
      return std::pair<std::uint64_t, std::uint64_t>(one.key, one.id);
    });
    return static_cast<std::size_t>(at - own_.begin());
  };
  const std::vector<std::uint64_t> keys = split(
      bits_, most, [&](std::size_t, std::uint64_t key) { return below(key, 0); }, ranks);
  const std::vector<std::uint64_t> ids = split(
      32, most, [&](std::size_t r, std::uint64_t id) { return below(keys[r], id); }, ranks);
  std::vector<std::size_t> starts{0};
  for (std::size_t r = 0; r < most.size(); ++r)
    starts.push_back(most[r] < count_ ? below(keys[r], ids[r]) : own_.size());
  starts.push_back(own_.size());
  return starts;
}

Renumbering Migration::move(Bodies& bodies, Ranks& ranks) {
  const std::vector<std::size_t> start = starts(ranks);
  std::vector<std::vector<Traveller>> to(ranks.count());
  for (unsigned r = 0; r < ranks.count(); ++r)
    for (std::size_t k = start[r]; k < start[r + 1]; ++k) to[r].push_back(traveller(bodies, own_[k]));
  const std::vector<std::vector<Traveller>> from = ranks.exchange(to);

  struct Arrival {
    CurvePlace place;
    std::uint32_t rank, index;
    bool operator<(const Arrival& other) const { return place < other.place; }
  };
  std::vector<Arrival> arrivals;
  std::vector<std::vector<std::uint32_t>> places(ranks.count());  // present indices, for the senders
  for (std::uint32_t r = 0; r < from.size(); ++r) {
    const auto before = static_cast<std::ptrdiff_t>(arrivals.size());
    for (std::uint32_t k = 0; k < from[r].size(); ++k) arrivals.push_back({from[r][k].place, r, k});
    std::inplace_merge(arrivals.begin(), arrivals.begin() + before, arrivals.end());
    places[r].resize(from[r].size());
  }
  resize(bodies, count_);
  const std::size_t first = ChunkRange(ranks.first(), count_).first;
  for (std::size_t k = 0; k < arrivals.size(); ++k) {
    const auto [place, rank, index] = arrivals[k];
    settle(from[rank][index], first + k, bodies);
    places[rank][index] = static_cast<std::uint32_t>(first + k);
  }
  Renumbering now(before_);
  const std::vector<std::vector<std::uint32_t>> answers = ranks.exchange(places);
  for (unsigned r = 0; r < ranks.count(); ++r)
    for (std::size_t k = 0; k < answers[r].size(); ++k) now.set(own_[start[r] + k].body, answers[r][k]);
  for (const std::uint32_t body : gone_) now.set(body, body_gone);
  return now;
}

}  // namespace grit
