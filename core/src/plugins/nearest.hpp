// The name that somebody probably meant.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace grit {

/// How many insertions, deletions, replacements and swaps of neighbours make one text of the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The first of the closest names, unless more than half of it would have to change.
std::optional<std::string> nearest(std::string_view name, std::span<const std::string> names);

}  // namespace grit
