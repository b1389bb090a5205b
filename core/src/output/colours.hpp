// Colours that every reader tells apart, wherever pictures and pages need some.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace grit {

/// Okabe and Ito's colours, on white and on black; the last is for what is none of the others.
inline constexpr std::array<const char*, 7> series_colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                           "#e69f00", "#56b4e9", "#8a8a86"};

using Rgb = std::array<double, 3>;  ///< 0 to 255

/// ColorBrewer's RdBu from negative to positive, about zero: safe for colour-blind readers; red is positive.
inline constexpr std::array<Rgb, 7> diverging_colours{
    {{20, 78, 140}, {67, 147, 195}, {164, 207, 228}, {246, 246, 244}, {246, 178, 147}, {214, 96, 77}, {160, 18, 40}}};

/// Viridis, from small to large.
inline constexpr std::array<Rgb, 7> sequential_colours{
    {{68, 1, 84}, {68, 57, 131}, {49, 104, 142}, {33, 145, 140}, {53, 183, 121}, {144, 215, 67}, {253, 231, 37}}};

/// What 98 % of sizes stay below, where colours end: a fast one leaves the others theirs. 0 without any.
double colour_limit(std::vector<double> sizes);

/// "#rrggbb" at a place of a scale, 0 to 1; the nearest end beyond.
std::string colour_at(std::span<const Rgb> scale, double place);

}  // namespace grit
