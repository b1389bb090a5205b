#include "plugins/nearest.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace grit {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_before, before(b.size() + 1), row(b.size() + 1);
  std::iota(before.begin(), before.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
    two_before = before;
    before = row;
  }
  return before.back();
}

std::optional<std::string> nearest(std::string_view name, std::span<const std::string> names) {
  const auto distance = [&](const std::string& other) { return edit_distance(name, other); };
  const auto closest = std::ranges::min_element(names, {}, distance);
  if (closest == names.end() || 2 * distance(*closest) > std::max(name.size(), closest->size())) return std::nullopt;
  return *closest;
}

}  // namespace grit
