// Suggestions for misspelt names, in messages.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace grit {

/// Number of insertions, deletions, replacements and swaps of neighbours that turn one text into the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The first of the closest names. If more than half of it would have to change, the only name that begins or ends with
/// these words, as "hertz-mindlin" does with "hertz", or none. What comes before a slash in both does not count:
/// "packing/nope" is not near "packing/time".
std::optional<std::string> nearest(std::string_view name, std::span<const std::string> names);

/// What follows an unknown name: `; did you mean "color"?`, or nothing if no name is near.
std::string did_you_mean(std::string_view name, std::span<const std::string> names);

/// The same with a last clause: `; did you mean "color"? Allowed are color, view`, or `; allowed are color, view`.
std::string did_you_mean(std::string_view name, std::span<const std::string> names, std::string last);

}  // namespace grit
