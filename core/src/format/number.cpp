#include "format/number.hpp"

#include <algorithm>
#include <cmath>

namespace grit {
namespace {

std::string with_minus(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text;
}

}  // namespace

std::string tick_label(double value, double step) {
  if (std::abs(value) < 1e-9 * step) return "0";
  if (step < 1e-4 || std::abs(value) >= 1e6) return with_minus(fmt::format("{:.3g}", value));
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  return with_minus(fmt::format("{:.{}f}", value, decimals));
}

std::string short_number(double value) {
  const double size = std::abs(value);
  if (size == 0) return "0";
  if (size < 1e-3 || size >= 1e5) return with_minus(fmt::format("{:.2e}", value));
  const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(size))));
  return with_minus(fmt::format("{:.{}f}", value, decimals));
}

std::string grouped(std::uint64_t number) {
  auto digits = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), "\u202f");
  return digits;
}

std::string percent(double fraction) {
  if (!std::isfinite(fraction)) return "?";
  const double value = 100 * fraction;
  return fmt::format("{:.{}f} %", value, value >= 9.95 ? 0 : value >= 0.1 ? 1 : 2);
}

std::string ratio_text(double ratio) { return fmt::format("{:.{}f}", ratio, ratio >= 10 ? 0 : ratio >= 3 ? 1 : 2); }

}  // namespace grit
