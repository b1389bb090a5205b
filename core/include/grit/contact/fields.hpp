// Fields of the contact history. They change when other features of a law become necessary.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "grit/contact/contact_law.hpp"

namespace grit {

/// A field that exists before and after a change: its index before, `from`, and its index now, `to`.
struct FieldMove {
  std::size_t from, to;
};

inline std::vector<FieldMove> moves_of_fields(std::span<const StateField> before, std::span<const StateField> now) {
  std::vector<FieldMove> moves;
  for (std::size_t to = 0; to < now.size(); ++to)
    if (const auto same = std::ranges::find(before, now[to].name, &StateField::name); same != before.end())
      moves.push_back({static_cast<std::size_t>(same - before.begin()), to});
  return moves;
}

inline bool same_fields(std::span<const StateField> a, std::span<const StateField> b) {
  return std::ranges::equal(a, b, {}, &StateField::name, &StateField::name);
}

}  // namespace grit
