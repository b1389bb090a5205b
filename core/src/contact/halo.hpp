// Bodies near those of other ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "bodies/bodies.hpp"
#include "bodies/reordering.hpp"
#include "contact/contact_table.hpp"
#include "ranks/ranks.hpp"

namespace grit {

/// Bodies of other ranks in pairs with own ones, whose values a rank needs, and own ones that others need.
class Halo {
 public:
  /// After neighbour lists were rebuilt.
  void build(const ContactTable& pairs, const Ranks& ranks);
  /// Bodies of other ranks whose values this one needs.
  std::size_t bodies() const;
  /// Pairs that this rank evaluates, and those among them that another one evaluates, too.
  std::size_t pairs() const { return pairs_; }
  std::size_t shared_pairs() const { return shared_pairs_; }
  /// Those that it can evaluate before it has the bodies of others.
  std::size_t independent_pairs() const { return independent_pairs_; }
  /// Chunks of other ranks with such bodies.
  const std::vector<std::uint32_t>& chunks() const { return chunks_; }
  /// Updates values of other ranks' bodies.
  void exchange(std::vector<double>& by_body, Ranks& ranks);
  /// The same of their present indices.
  void exchange(Renumbering& now, Ranks& ranks);
  using OfChunk = std::function<double&(std::size_t chunk)>;
  /// Begins to exchange positions, velocities and spins of bodies that have moved, and a number of each chunk of them.
  void begin(const Bodies& bodies, const OfChunk& of_chunk, Ranks& ranks);
  /// Waits for what others have sent, and updates their bodies. Nothing if they have not moved since.
  void finish(Bodies& bodies, const OfChunk& of_chunk, Ranks& ranks);

 private:
  struct Lists {
    std::vector<std::uint32_t> bodies, chunks;  // in ascending order
  };
  /// `pack(to, list)` writes so many numbers of each body, and as many of each chunk.
  template <class Pack>
  void begin(std::size_t of_body, std::size_t of_chunk, Pack pack, Ranks& ranks);
  /// `unpack(from, list)` reads them.
  template <class Unpack>
  void finish(Unpack unpack, Ranks& ranks);

  std::size_t pairs_ = 0, shared_pairs_ = 0, independent_pairs_ = 0;
  std::vector<std::uint32_t> chunks_;
  std::vector<Lists> sent_, received_;         // by rank
  std::vector<std::vector<double>> out_, in_;  // by rank; kept, as new pages cost more than the messages
  Ranks::Exchange messages_;                   // on their way from and to these
};

}  // namespace grit
