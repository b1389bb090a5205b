#include "contact/halo.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace grit {
namespace {

/// Of a body; its radius, mass and inertia are known.
constexpr std::array moving_arrays{&Bodies::position, &Bodies::velocity, &Bodies::spin};

}  // namespace

void Halo::build(const ContactTable& pairs, const Ranks& ranks) {
  messages_.reset();
  sent_.assign(ranks.count(), {}), received_.assign(ranks.count(), {});
  out_.resize(ranks.count()), in_.resize(ranks.count());
  pairs_ = shared_pairs_ = independent_pairs_ = 0;
  chunks_.clear();
  if (!ranks.several()) return;
  const auto add = [&](std::uint32_t own, std::uint32_t other) {
    const unsigned rank = ranks.cuts().owner_of_body(other);
    sent_[rank].bodies.push_back(own), received_[rank].bodies.push_back(other);
    ++shared_pairs_;
  };
  // Both ranks of a pair have it.
  pairs.each_candidate([&](std::size_t c) {
    const std::uint32_t a = pairs.a(c), b = pairs.b(c);
    ++pairs_;
    if (pairs.is_independent(c)) ++independent_pairs_;
    if (!ranks.owns_body(a)) add(b, a);
    else if (!ranks.owns_body(b)) add(a, b);
  });
  const auto keep_one_of_each = [](std::vector<std::uint32_t>& list) {
    const auto doubles = std::ranges::unique(list);
    list.erase(doubles.begin(), doubles.end());
  };
  for (auto* of_ranks : {&sent_, &received_})
    for (Lists& list : *of_ranks) {
      std::ranges::sort(list.bodies);
      keep_one_of_each(list.bodies);
      for (const std::uint32_t body : list.bodies) list.chunks.push_back(body / chunk_bodies);
      keep_one_of_each(list.chunks);
    }
  for (const Lists& list : received_) chunks_.insert(chunks_.end(), list.chunks.begin(), list.chunks.end());
}

std::size_t Halo::bodies() const {
  std::size_t count = 0;
  for (const Lists& list : received_) count += list.bodies.size();
  return count;
}

template <class Pack>
void Halo::begin(std::size_t of_body, std::size_t of_chunk, Pack pack, Ranks& ranks) {
  if (!ranks.several()) return;
  if (messages_) throw std::logic_error("bodies of other ranks are still on their way");
  const auto numbers = [&](const Lists& lists) {
    return of_body * lists.bodies.size() + of_chunk * lists.chunks.size();
  };
  std::vector<Communicator::Message> sent, received;
  for (unsigned r = 0; r < ranks.count(); ++r) {
    out_[r].resize(numbers(sent_[r])), in_[r].resize(numbers(received_[r]));
    pack(out_[r].data(), sent_[r]);
    Ranks::add(sent, r, out_[r]), Ranks::add(received, r, in_[r]);
  }
  messages_ = ranks.begin(sent, received);
}

template <class Unpack>
void Halo::finish(Unpack unpack, Ranks& ranks) {
  if (!messages_) return;
  ranks.finish(std::move(messages_));
  for (unsigned r = 0; r < ranks.count(); ++r) unpack(in_[r].data(), received_[r]);
}

void Halo::exchange(std::vector<double>& by_body, Ranks& ranks) {
  begin(
      1, 0,
      [&](double* to, const Lists& own) {
        for (const std::uint32_t i : own.bodies) *to++ = by_body[i];
      },
      ranks);
  finish(
      [&](const double* from, const Lists& others) {
        for (const std::uint32_t i : others.bodies) by_body[i] = *from++;
      },
      ranks);
}

void Halo::exchange(Renumbering& now, Ranks& ranks) {
  begin(
      1, 0,
      [&](double* to, const Lists& own) {
        for (const std::uint32_t i : own.bodies) *to++ = now(i);
      },
      ranks);
  finish(
      [&](const double* from, const Lists& others) {
        for (const std::uint32_t i : others.bodies) now.set(i, static_cast<std::uint32_t>(*from++));
      },
      ranks);
}

void Halo::begin(const Bodies& bodies, const OfChunk& of_chunk, Ranks& ranks) {
  begin(
      3 * moving_arrays.size(), 1,
      [&](double* to, const Lists& own) {
        for (const std::uint32_t i : own.bodies)
          for (const auto array : moving_arrays) {
            const Row& row = (bodies.*array)[i];
            *to++ = row.x, *to++ = row.y, *to++ = row.z;
          }
        for (const std::uint32_t chunk : own.chunks) *to++ = of_chunk(chunk);
      },
      ranks);
}

void Halo::finish(Bodies& bodies, const OfChunk& of_chunk, Ranks& ranks) {
  finish(
      [&](const double* from, const Lists& others) {
        for (const std::uint32_t i : others.bodies)
          for (const auto array : moving_arrays) {
            Row& row = (bodies.*array)[i];
            row.x = *from++, row.y = *from++, row.z = *from++;
          }
        for (const std::uint32_t chunk : others.chunks) of_chunk(chunk) = *from++;
      },
      ranks);
}

}  // namespace grit
