#include "output/scale.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace grit {
namespace {

std::string with_minus(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "−");
  return text;
}

}  // namespace

bool drawable(double value) { return std::abs(value) < 1e30; }

double nice_step(double span, int pieces) {
  const double rough = span / pieces;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double lead = rough / power;
  return power * (lead < std::sqrt(2.0) ? 1 : lead < std::sqrt(10.0) ? 2 : lead < std::sqrt(50.0) ? 5 : 10);
}

std::vector<double> ticks(double low, double high, int pieces) {
  // Of a narrower range the steps have no digits left.
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high))) || !std::isfinite(high - low)) return {low};
  const double step = nice_step(high - low, pieces);
  std::vector<double> marks;
  for (auto i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) marks.push_back(i * step);
  return marks;
}

AxisTicks axis_ticks(double low, double high, AxisEnds ends, const std::function<bool(const AxisTicks&)>& fits) {
  constexpr int fewest = 4, most = 8;
  if (!std::isfinite(high - low)) low = 0, high = 1;
  constexpr double nothing = 1e-300;  // below which steps lose their digits
  if (const double size = std::max(std::abs(low), std::abs(high)); !(high - low > std::max(1e-12 * size, nothing))) {
    const double room = size > nothing ? 0.5 * size : 1;
    low -= room, high += room;
  }
  std::optional<AxisTicks> best;
  for (double step = nice_step(high - low, 4 * most);; step = nice_step(2 * step, 1)) {
    const double first = ends == AxisEnds::kept ? std::ceil(low / step - 1e-9) : std::floor(low / step + 1e-9),
                 last = ends == AxisEnds::kept ? std::floor(high / step + 1e-9) : std::ceil(high / step - 1e-9);
    const double count = last - first + 1;
    if (count > most) continue;
    if (count < fewest) break;
    AxisTicks axis{low, high, step, {}};
    if (ends == AxisEnds::whole_steps) axis.low = first * step, axis.high = last * step;
    for (int i = 0; i < count; ++i) axis.marks.push_back((first + i) * step);
    best = std::move(axis);
    if (fits(*best)) break;
  }
  return best ? *best : axis_ticks(low, high, AxisEnds::whole_steps, fits);
}

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

ReadableUnit readable(const std::string& unit, double largest) {
  if (unit == "rad") return {180 / std::numbers::pi, "deg"};
  if (unit.starts_with("kg") && (unit.size() == 2 || unit[2] == ' ') && largest > 0 && largest < 1 && unit != "kg m-3")
    return {1e3, unit.substr(1)};
  if (unit != "m" && unit != "Pa" && unit != "N" && unit != "J" && unit != "m/s" && unit != "W") return {1, unit};
  struct Prefix {
    double size;
    const char* letter;
  };
  constexpr std::array<Prefix, 6> prefixes{{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "µ"}}};
  const bool length = unit.front() == 'm';
  for (const auto& [size, letter] : prefixes)
    if (largest >= size && !(length && size > 1)) return {1 / size, letter + unit};
  return largest > 0 ? ReadableUnit{1e6, "µ" + unit} : ReadableUnit{1, unit};
}

std::string axis_title(const std::string& label, const std::string& unit) {
  return unit.empty() || unit == "1" ? label : label + " [" + unit + "]";
}

std::string spelled(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::string grouped(std::uint64_t number) {
  auto digits = std::to_string(number);
  for (auto place = static_cast<std::ptrdiff_t>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), "\u202f");
  return digits;
}

}  // namespace grit
