// Bodies near those of other ranks.
#pragma once

#include <cstddef>
#include <cstdint>
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
  /// The same of positions, velocities and spins.
  void exchange(Bodies& bodies, Ranks& ranks) const;
  /// The same of their present indices.
  void exchange(Renumbering& now, Ranks& ranks) const;

 private:
  /// `pack(body, to)` writes so many numbers of a body, `unpack(body, from)` reads them.
  template <class Pack, class Unpack>
  void exchange(std::size_t numbers, Pack pack, Unpack unpack, Ranks& ranks) const;

  std::size_t pairs_ = 0, shared_pairs_ = 0;
  std::vector<std::vector<std::uint32_t>> sent_, received_;  // bodies by rank, in ascending order
  mutable std::vector<std::vector<double>> out_, in_;        // by rank; kept, as new pages cost more than the messages
};

}  // namespace grit
