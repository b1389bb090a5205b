// Colour-blind-safe colours of pictures and pages.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grit {

/// Okabe and Ito's colours, for white and black backgrounds; the last is for everything else.
inline constexpr std::array<const char*, 7> series_colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                           "#e69f00", "#56b4e9", "#8a8a86"};

using Rgb = std::array<double, 3>;  ///< 0 to 255

/// ColorBrewer's RdBu from negative to positive, about zero: safe for colour-blind readers; red is positive.
inline constexpr std::array<Rgb, 7> diverging_colours{
    {{20, 78, 140}, {67, 147, 195}, {164, 207, 228}, {246, 246, 244}, {246, 178, 147}, {214, 96, 77}, {160, 18, 40}}};

/// Viridis, from small to large.
inline constexpr std::array<Rgb, 7> sequential_colours{
    {{68, 1, 84}, {68, 57, 131}, {49, 104, 142}, {33, 145, 140}, {53, 183, 121}, {144, 215, 67}, {253, 231, 37}}};

/// The 98th percentile of magnitudes, where the colour scale ends, so that outliers do not dominate it. 0 if empty.
double colour_limit(std::vector<double> sizes);

struct ColourRange {
  double low, high;
};
/// Ends of a colour scale that do not follow from the values, in their unit.
struct ScaleEnds {
  std::optional<double> low, high;  ///< set by a description
  /// Largest upper end, unless it is set or all values are above.
  double most = std::numeric_limits<double>::infinity();
};
/// The range with these ends. One end of a symmetric range sets both. It is never empty.
ColourRange with_ends(ColourRange range, const ScaleEnds& ends, bool symmetric);

/// "#rrggbb" at a position of a scale, clamped to 0 … 1.
std::string colour_at(std::span<const Rgb> scale, double place);

}  // namespace grit
