#include "format/duration.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grit {

std::string written_time(double seconds) {
  constexpr double four_digits = 9999.5;  // from here on, {:.4g} would give an exponent
  if (std::abs(seconds) >= four_digits) return fmt::format("{:.0f} s", seconds);
  for (const auto& [size, unit] : {std::pair(1.0, "s"), std::pair(1e-3, "ms"), std::pair(1e-6, "µs")})
    if (std::abs(seconds) >= size) return fmt::format("{:.4g} {}", seconds / size, unit);
  return seconds == 0 ? "0 s" : fmt::format("{:.4g} ns", seconds * 1e9);
}

std::string duration_text(double seconds) {
  if (std::isnan(seconds)) return "unknown";
  const auto whole = static_cast<long>(std::lround(std::min(seconds, 1e9)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string cost_text(double seconds) {
  return seconds < 0.1     ? fmt::format("{:.2g} s", seconds)
         : seconds < 600   ? fmt::format("{:.{}f} s", seconds,
                                       seconds < 1    ? 2
                                         : seconds < 10 ? 1
                                                        : 0)
         : seconds < 36000 ? fmt::format("{:.0f} min", seconds / 60)
                           : fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace grit
