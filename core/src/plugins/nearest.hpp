// Suggestions for misspelt names.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace grit {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn one text into the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The first of the closest names; none if more than half of it would have to change.
std::optional<std::string> nearest(std::string_view name, std::span<const std::string> names);

}  // namespace grit
