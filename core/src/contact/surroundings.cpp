#include "contact/surroundings.hpp"

#include <algorithm>
#include <numeric>

namespace grit {

void Surroundings::find(Bodies& bodies, const Cell& cell, const Skins& skins, Ranks& ranks, Team& team) {
  chunks_.resize(ranks.last() - ranks.first());
  std::iota(chunks_.begin(), chunks_.end(), static_cast<std::uint32_t>(ranks.first()));
  if (!ranks.several()) return;
  boxes_ = ChunkBoxes(bodies, cell, skins, ranks, team);
  find_near(ranks);
  fetch(bodies, ranks);
}

void Surroundings::find_near(const Ranks& ranks) {
  near_.assign(ranks.count(), {});
  const std::vector<std::uint32_t> own = chunks_;
  if (own.empty()) return;
  const auto around = boxes_.around(ranks.first(), ranks.last());
  for (unsigned r = 0; r < ranks.count(); ++r) {
    if (r == ranks.rank()) continue;
    for (std::size_t chunk = ranks.cuts().first(r); chunk < ranks.cuts().last(r); ++chunk)
      if (boxes_.near(chunk, around) &&
          std::ranges::any_of(own, [&](std::uint32_t one) { return boxes_.near(one, chunk); }))
        near_[r].push_back(static_cast<std::uint32_t>(chunk));
    chunks_.insert(chunks_.end(), near_[r].begin(), near_[r].end());
  }
  std::ranges::sort(chunks_);
}

void Surroundings::fetch(Bodies& bodies, Ranks& ranks) const {
  struct Guest {
    Row position, velocity, spin;
    std::uint32_t id;
    std::uint8_t material;
  };
  const auto each_body = [&](const std::vector<std::uint32_t>& chunks, auto use) {
    for (const std::uint32_t chunk : chunks) {
      const ChunkRange range(chunk, bodies.count());
      for (std::size_t i = range.first; i < range.last; ++i) use(i);
    }
  };
  const std::vector<std::vector<std::uint32_t>> asked = ranks.exchange(near_);
  std::vector<std::vector<Guest>> to(ranks.count());
  for (unsigned r = 0; r < ranks.count(); ++r)
    each_body(asked[r], [&](std::size_t i) {
      to[r].push_back({bodies.position[i], bodies.velocity[i], bodies.spin[i], bodies.id[i], bodies.material[i]});
    });
  const std::vector<std::vector<Guest>> from = ranks.exchange(to);
  for (unsigned r = 0; r < ranks.count(); ++r) {
    auto next = from[r].begin();
    each_body(near_[r], [&](std::size_t i) {
      bodies.position[i] = next->position, bodies.velocity[i] = next->velocity, bodies.spin[i] = next->spin;
      bodies.id[i] = next->id, bodies.material[i] = next->material;
      ++next;
    });
  }
}

}  // namespace grit
