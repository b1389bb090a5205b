#include "output/colours.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace grit {

double colour_limit(std::vector<double> sizes) {
  if (sizes.empty()) return 0;
  constexpr double fraction = 0.98;
  const auto nth = sizes.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(sizes.size() - 1));
  std::ranges::nth_element(sizes, nth);
  return *nth;
}

ColourRange with_ends(ColourRange range, const ScaleEnds& ends, bool symmetric) {
  if (range.low < ends.most) range.high = std::min(range.high, ends.most);
  if (ends.low) range.low = *ends.low;
  if (ends.high) range.high = *ends.high;
  if (symmetric && ends.low && !ends.high) range.high = -*ends.low;
  if (symmetric && ends.high && !ends.low) range.low = -*ends.high;
  if (range.low < range.high) return range;
  const double set = ends.low ? range.low : range.high, width = set != 0 ? std::abs(set) : 1;
  return ends.low ? ColourRange{set, set + width} : ColourRange{set - width, set};
}

std::string colour_at(std::span<const Rgb> scale, double place) {
  const double along = std::clamp(place, 0.0, 1.0) * static_cast<double>(scale.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(along), scale.size() - 2);
  const double part = along - static_cast<double>(i);
  std::array<int, 3> mixed{};
  for (std::size_t k = 0; k < 3; ++k)
    mixed[k] = static_cast<int>(std::lround(scale[i][k] * (1 - part) + scale[i + 1][k] * part));
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

}  // namespace grit
