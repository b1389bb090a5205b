#include "contact/halo.hpp"

#include <algorithm>

namespace grit {

void Halo::build(const ContactTable& pairs, const Ranks& ranks) {
  sent_.assign(ranks.count(), {}), received_.assign(ranks.count(), {});
  out_.resize(ranks.count()), in_.resize(ranks.count());
  pairs_ = shared_pairs_ = 0;
  if (!ranks.several()) return;
  const auto add = [&](std::uint32_t own, std::uint32_t other) {
    const unsigned rank = ranks.cuts().owner_of_body(other);
    sent_[rank].push_back(own), received_[rank].push_back(other);
    ++shared_pairs_;
  };
  // Both ranks of a pair have it.
  pairs.each_candidate([&](std::size_t c) {
    const std::uint32_t a = pairs.a(c), b = pairs.b(c);
    ++pairs_;
    if (!ranks.owns_body(a)) add(b, a);
    else if (!ranks.owns_body(b)) add(a, b);
  });
  for (auto* lists : {&sent_, &received_})
    for (auto& list : *lists) {
      std::ranges::sort(list);
      const auto doubles = std::ranges::unique(list);
      list.erase(doubles.begin(), doubles.end());
    }
}

std::size_t Halo::bodies() const {
  std::size_t count = 0;
  for (const auto& list : received_) count += list.size();
  return count;
}

template <class Pack, class Unpack>
void Halo::exchange(std::size_t numbers, Pack pack, Unpack unpack, Ranks& ranks) const {
  if (!ranks.several()) return;
  std::vector<Communicator::Message> sent, received;
  for (unsigned r = 0; r < ranks.count(); ++r) {
    out_[r].resize(sent_[r].size() * numbers), in_[r].resize(received_[r].size() * numbers);
    for (std::size_t k = 0; k < sent_[r].size(); ++k) pack(sent_[r][k], &out_[r][k * numbers]);
    Ranks::add(sent, r, out_[r]), Ranks::add(received, r, in_[r]);
  }
  ranks.exchange(sent, received);
  for (unsigned r = 0; r < ranks.count(); ++r)
    for (std::size_t k = 0; k < received_[r].size(); ++k) unpack(received_[r][k], &in_[r][k * numbers]);
}

void Halo::exchange(std::vector<double>& by_body, Ranks& ranks) const {
  exchange(
      1, [&](std::uint32_t i, double* to) { *to = by_body[i]; },
      [&](std::uint32_t i, const double* from) { by_body[i] = *from; }, ranks);
}

void Halo::exchange(Renumbering& now, Ranks& ranks) const {
  exchange(
      1, [&](std::uint32_t i, double* to) { *to = now(i); },
      [&](std::uint32_t i, const double* from) { now.set(i, static_cast<std::uint32_t>(*from)); }, ranks);
}

void Halo::exchange(Bodies& bodies, Ranks& ranks) const {
  // Radius, mass and inertia are known.
  const auto each = [&](std::uint32_t i, auto* at, auto copy) {
    for (auto* array : {&bodies.position, &bodies.velocity, &bodies.spin}) {
      Row& row = (*array)[i];
      copy(row.x, *at++), copy(row.y, *at++), copy(row.z, *at++);
    }
  };
  exchange(
      9, [&](std::uint32_t i, double* to) { each(i, to, [](double own, double& sent) { sent = own; }); },
      [&](std::uint32_t i, const double* from) { each(i, from, [](double& own, double found) { own = found; }); },
      ranks);
}

}  // namespace grit
