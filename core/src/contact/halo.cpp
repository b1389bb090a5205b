#include "contact/halo.hpp"

#include <algorithm>
#include <array>

namespace grit {

void Halo::build(const ContactTable& pairs, const Ranks& ranks) {
  sent_.assign(ranks.count(), {}), received_.assign(ranks.count(), {});
  if (!ranks.several()) return;
  const auto add = [&](std::uint32_t own, std::uint32_t other) {
    const unsigned rank = ranks.cuts().owner_of_body(other);
    sent_[rank].push_back(own), received_[rank].push_back(other);
  };
  // Both ranks of a pair have it.
  pairs.each_candidate([&](std::size_t c) {
    const std::uint32_t a = pairs.a(c), b = pairs.b(c);
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

template <class Pack, class Unpack>
void Halo::exchange(Pack pack, Unpack unpack, Ranks& ranks) const {
  using Value = decltype(pack(std::uint32_t{}));
  std::vector<std::vector<Value>> out(sent_.size()), in(received_.size());
  std::vector<Communicator::Message> sent, received;
  for (unsigned r = 0; r < out.size(); ++r) {
    for (const std::uint32_t body : sent_[r]) out[r].push_back(pack(body));
    in[r].resize(received_[r].size());
    Ranks::add(sent, r, out[r]), Ranks::add(received, r, in[r]);
  }
  ranks.exchange(sent, received);
  for (unsigned r = 0; r < in.size(); ++r)
    for (std::size_t k = 0; k < in[r].size(); ++k) unpack(received_[r][k], in[r][k]);
}

void Halo::exchange(std::vector<double>& by_body, Ranks& ranks) const {
  exchange([&](std::uint32_t i) { return by_body[i]; }, [&](std::uint32_t i, double value) { by_body[i] = value; },
           ranks);
}

void Halo::exchange(Bodies& bodies, Ranks& ranks) const {
  using Moved = std::array<Row, 3>;
  exchange(
      [&](std::uint32_t i) {
        return Moved{bodies.position[i], bodies.velocity[i], bodies.spin[i]};
      },
      [&](std::uint32_t i, const Moved& moved) {
        bodies.position[i] = moved[0], bodies.velocity[i] = moved[1], bodies.spin[i] = moved[2];
      },
      ranks);
}

std::size_t Halo::count() const {
  std::size_t count = 0;
  for (const auto& list : received_) count += list.size();
  return count;
}

}  // namespace grit
