// Numbers as text.
#pragma once

#include <spdlog/fmt/fmt.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace grit {

/// Four significant digits, for messages.
inline std::string number(double value) { return fmt::format("{:.4g}", value); }

/// "1 entry", "2 entries".
inline std::string counted(std::size_t count, const char* one, const char* several) {
  return std::to_string(count) + ' ' + (count == 1 ? one : several);
}

/// Three significant digits, with U+2212 for minus.
std::string short_number(double value);

/// Label of a tick of an axis with this step, with U+2212 for minus.
std::string tick_label(double value, double step);

/// 1234567 as "1 234 567", with narrow no-break spaces.
std::string grouped(std::uint64_t number);

/// "2.1 %" of a fraction of 0.021; "?" if it is not finite.
std::string percent(double fraction);

/// A ratio with up to three digits.
std::string ratio_text(double ratio);

}  // namespace grit
