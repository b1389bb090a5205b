// The group of each body by number, for frames and pictures.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "grit/world.hpp"

namespace grit {

struct GroupIndex {
  std::vector<std::string> names;       ///< ascending
  std::vector<std::int32_t> of_bodies;  ///< index of the name of each body's group
};

inline GroupIndex group_index(const World& world) {
  GroupIndex index;
  for (const BodyGroup& group : world.groups()) index.names.push_back(group.name);
  std::ranges::sort(index.names);
  index.names.erase(std::unique(index.names.begin(), index.names.end()), index.names.end());
  std::vector<std::int32_t> of_entries;
  for (const BodyGroup& group : world.groups())
    of_entries.push_back(
        static_cast<std::int32_t>(std::ranges::lower_bound(index.names, group.name) - index.names.begin()));
  for (const std::uint32_t id : world.ids()) {
    const auto next = std::ranges::upper_bound(world.groups(), id, {}, &BodyGroup::first_id);
    index.of_bodies.push_back(
        of_entries.empty() ? 0 : of_entries[static_cast<std::size_t>(next - world.groups().begin()) - 1]);
  }
  return index;
}

}  // namespace grit
