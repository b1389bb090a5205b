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
  /// Updates values of other ranks' bodies.
  void exchange(std::vector<double>& by_body, Ranks& ranks) const;
  /// The same of positions, velocities and spins, and of a number of each of their chunks.
  void exchange(Bodies& bodies, const std::function<double&(std::size_t chunk)>& of_chunk, Ranks& ranks) const;
  /// Chunks of other ranks with such bodies.
  const std::vector<std::uint32_t>& chunks() const { return chunks_; }
  /// The same of their present indices.
  void exchange(Renumbering& now, Ranks& ranks) const;

 private:
  struct Lists {
    std::vector<std::uint32_t> bodies, chunks;  // in ascending order
  };
  /// `pack(to, list)` writes so many numbers of each body, and as many of each chunk; `unpack(from, list)` reads them.
  template <class Pack, class Unpack>
  void exchange(std::size_t of_body, std::size_t of_chunk, Pack pack, Unpack unpack, Ranks& ranks) const;

  std::size_t pairs_ = 0, shared_pairs_ = 0;
  std::vector<std::uint32_t> chunks_;
  std::vector<Lists> sent_, received_;                 // by rank
  mutable std::vector<std::vector<double>> out_, in_;  // by rank; kept, as new pages cost more than the messages
};

}  // namespace grit
