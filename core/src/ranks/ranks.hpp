// The ranks that share a simulation, as its parts see them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "ranks/communicator.hpp"
#include "ranks/cuts.hpp"
#include "ranks/traffic.hpp"
#include "threads/stopwatch.hpp"

namespace grit {

/// Every rank runs the whole program, but evaluates and moves its own chunks of bodies only; it then completes what it
/// needs of others. So all take the same decisions, and results have the same bits for any number of ranks. With one
/// rank, all functions return at once.
class Ranks {
 public:
  /// Without a communicator there is one rank.
  explicit Ranks(Communicator* all = nullptr)
      : all_(all != nullptr && all->count() > 1 ? all : nullptr), cuts_(count(), {}) {}

  bool several() const { return all_ != nullptr; }
  unsigned rank() const { return several() ? all_->rank() : 0; }
  unsigned count() const { return several() ? all_->count() : 1; }

  const Cuts& cuts() const { return cuts_; }
  void resize(std::size_t chunks) { cuts_.resize(chunks); }
  /// Divides the chunks among the ranks again. `weights`: of each, equal on all ranks.
  void divide(std::span<const double> weights) { cuts_ = Cuts(count(), weights); }
  /// The own chunks are first() … last() − 1.
  std::size_t first() const { return cuts_.first(rank()); }
  std::size_t last() const { return cuts_.last(rank()); }
  bool owns(std::size_t chunk) const { return cuts_.owns(rank(), chunk); }
  bool owns_body(std::size_t body) const { return owns(body / chunk_bodies); }

  /// Fills in values of other ranks' chunks; those of own ones are there.
  template <class Values>
  void complete(Values& by_chunk) {
    if (several()) gather(bytes_of(by_chunk), starts(sizeof(by_chunk[0]), 1, by_chunk.size()));
  }
  /// The same of values by body.
  template <class Values>
  void complete_bodies(Values& by_body, std::size_t bodies) {
    if (several())
      gather(bytes_of(by_body).first(bodies * sizeof(by_body[0])), starts(sizeof(by_body[0]), chunk_bodies, bodies));
  }
  /// The lists of all ranks, one after the other.
  template <class T, class Allocator>
  std::vector<T, Allocator> all(const std::vector<T, Allocator>& own) {
    if (!several()) return own;
    const std::vector<std::size_t> starts = starts_of(own.size() * sizeof(T));
    std::vector<T, Allocator> found(starts.back() / sizeof(T));
    std::copy(own.begin(), own.end(), found.begin() + static_cast<std::ptrdiff_t>(starts[rank()] / sizeof(T)));
    gather(bytes_of(found), starts);
    return found;
  }
  /// The same on the first rank; nothing on others. They are sent in pieces.
  template <class T>
  std::vector<T> collected(const std::vector<T>& own) {
    static_assert(std::is_trivially_destructible_v<T>, "values without memory of their own");
    if (!several()) return own;
    std::vector<T> found;
    constexpr std::size_t at_once = (std::size_t{1} << 20) / sizeof(T);
    if (rank() == 0) {
      found = own;
      for (unsigned from = 1; from < count(); ++from)
        receive_pieces(from, [&](std::span<const std::byte> piece) {
          const std::size_t before = found.size();
          found.resize(before + piece.size() / sizeof(T));
          std::memcpy(static_cast<void*>(found.data() + before), piece.data(), piece.size());
        });
    } else {
      for (std::size_t first = 0; first < own.size(); first += at_once)
        send_piece(0, std::as_bytes(std::span(own).subspan(first, std::min(at_once, own.size() - first))));
      send_piece(0, {});
    }
    return found;
  }
  /// The value of each rank.
  template <class T>
  std::vector<T> each(const T& own) {
    std::vector<T> found(count(), own);
    if (several()) gather(bytes_of(found), one_each(sizeof(T)));
    return found;
  }
  /// Adds the numbers of all ranks, entry by entry.
  void sum(std::span<std::uint64_t> numbers) {
    reduce(numbers, [&] { all_->sum(numbers); });
  }
  /// Takes the largest of all ranks, entry by entry; they are numbers.
  void largest(std::span<double> numbers) {
    reduce(numbers, [&] { all_->largest(numbers); });
  }
  /// Sends entry r to rank r, and takes in its place what that rank sends to this one.
  void transpose(std::span<std::uint64_t> by_rank) {
    reduce(by_rank, [&] { all_->transpose(by_rank); });
  }
  bool any(bool own) { return any(std::array{own}).front(); }
  /// For each entry, whether any rank says so.
  template <std::size_t count>
  std::array<bool, count> any(std::array<bool, count> own) {
    std::array<std::uint64_t, count> ranks{};
    std::ranges::copy(own, ranks.begin());
    sum(ranks);
    for (std::size_t k = 0; k < count; ++k) own[k] = ranks[k] > 0;
    return own;
  }
  /// Sends a list to each rank, and returns the list from each.
  template <class T>
  std::vector<std::vector<T>> exchange(const std::vector<std::vector<T>>& to) {
    std::vector<std::uint64_t> sizes;
    for (const auto& list : to) sizes.push_back(list.size());
    transpose(sizes);
    std::vector<std::vector<T>> from(count());
    std::vector<Communicator::Message> sent, received;
    for (unsigned r = 0; r < count(); ++r) {
      from[r].resize(sizes[r]);
      if (r == rank()) from[r] = to[r];
      else add(sent, r, to[r]), add(received, r, from[r]);
    }
    exchange(sent, received);
    return from;
  }
  /// Adds a message unless it is empty. The list of one that is sent is not changed.
  template <class List>
  static void add(std::vector<Communicator::Message>& messages, unsigned rank, List& list) {
    auto* const bytes = const_cast<std::byte*>(reinterpret_cast<const std::byte*>(list.data()));
    if (!list.empty()) messages.push_back({rank, {bytes, list.size() * sizeof(list[0])}});
  }
  /// Messages on their way; see Communicator.
  using Exchange = std::unique_ptr<Communicator::Exchange>;
  /// Begins to exchange messages of known lengths, between several ranks.
  [[nodiscard]] Exchange begin(std::span<const Communicator::Message> sent,
                               std::span<const Communicator::Message> received) {
    refuse_alone();
    const Stopwatch watch(traffic_.seconds);
    for (const Communicator::Message& one : sent)
      ++traffic_.messages, traffic_.bytes += static_cast<double>(one.bytes.size());
    return all_->begin(sent, received);
  }
  /// Waits for them.
  void finish(Exchange one) {
    const Stopwatch watch(traffic_.seconds);
    one.reset();
  }
  void exchange(std::span<const Communicator::Message> sent, std::span<const Communicator::Message> received) {
    if (several()) finish(begin(sent, received));
  }
  /// Sends a list to another rank, in pieces that it takes one after the other. An empty one is the last.
  void send_piece(unsigned to, std::span<const std::byte> piece);
  template <class Take>
  void receive_pieces(unsigned from, Take take) {
    for (std::vector<std::byte> piece; !(piece = receive_piece(from)).empty();) take(std::span<const std::byte>(piece));
  }
  const Traffic& traffic() const { return traffic_; }
  bool is_alone() const { return alone_ > 0; }

  /// While it lives, one rank does what others do not, such as writing: what needs others is a defect, and throws.
  class Alone {
   public:
    explicit Alone(Ranks& ranks) : ranks_(ranks) { ++ranks_.alone_; }
    ~Alone() { --ranks_.alone_; }
    Alone(const Alone&) = delete;

   private:
    Ranks& ranks_;
  };

 private:
  template <class Values>
  static std::span<std::byte> bytes_of(Values& values) {
    static_assert(std::is_trivially_destructible_v<typename Values::value_type>, "values without memory of their own");
    return {reinterpret_cast<std::byte*>(values.data()), values.size() * sizeof(values[0])};
  }
  /// Bytes before the own chunks of each rank, and those of all `count` values, of which each chunk has `per_chunk`.
  std::vector<std::size_t> starts(std::size_t size, std::size_t per_chunk, std::size_t count) const;
  /// The same for so many bytes of each rank.
  std::vector<std::size_t> one_each(std::size_t size) const;
  /// The same for as many bytes of each rank as it says.
  std::vector<std::size_t> starts_of(std::size_t own);
  void gather(std::span<std::byte> all, const std::vector<std::size_t>& starts) {
    refuse_alone();
    const Stopwatch watch(traffic_.seconds);
    ++traffic_.gathers, traffic_.gathered += static_cast<double>(all.size() - (starts[rank() + 1] - starts[rank()]));
    all_->gather(all, starts);
  }
  template <class T, class Work>
  void reduce(std::span<T> numbers, Work work) {
    if (!several()) return;
    refuse_alone();
    const Stopwatch watch(traffic_.seconds);
    ++traffic_.gathers, traffic_.gathered += static_cast<double>(numbers.size_bytes());
    work();
  }
  std::vector<std::byte> receive_piece(unsigned from);
  void refuse_alone() const;

  Communicator* all_;
  Cuts cuts_;  // until bodies are divided, the last rank has all
  int alone_ = 0;
  Traffic traffic_;
};

}  // namespace grit
