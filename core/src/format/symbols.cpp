#include "format/symbols.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <ranges>
#include <string_view>
#include <utility>
#include <vector>

namespace grit {
namespace {

struct Symbol {
  std::string_view name, letter;
};
/// Names that are written as Greek letters.
constexpr std::array<Symbol, 18> symbols{{{"alpha", "α"},
                                          {"beta", "β"},
                                          {"gamma", "γ"},
                                          {"delta", "δ"},
                                          {"epsilon", "ε"},
                                          {"eta", "η"},
                                          {"theta", "θ"},
                                          {"kappa", "κ"},
                                          {"lambda", "λ"},
                                          {"mu", "μ"},
                                          {"nu", "ν"},
                                          {"xi", "ξ"},
                                          {"rho", "ρ"},
                                          {"sigma", "σ"},
                                          {"tau", "τ"},
                                          {"phi", "φ"},
                                          {"psi", "ψ"},
                                          {"omega", "ω"}}};
constexpr std::array<const char*, 10> superscripts{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"},
    subscripts{"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Digits as superscripts or subscripts.
std::string in_small(const std::string& digits, const std::array<const char*, 10>& small) {
  std::string all;
  for (const char digit : digits) all += small[static_cast<std::size_t>(digit - '0')];
  return all;
}

/// A unit to a power, a factor of a product.
struct Factor {
  std::string unit;
  int power = 1;
  bool operator==(const Factor&) const = default;
};

/// The factors of a unit such as "kg m-2 s-1", "m/s", "m^2.s"; none for other notations.
std::optional<std::vector<Factor>> factors_of(const std::string& unit) {
  std::vector<Factor> factors;
  int sign = 1;
  for (std::size_t at = 0; at < unit.size();) {
    if (unit[at] == ' ' || unit[at] == '.') {
      ++at;
      continue;
    }
    if (unit[at] == '/') {
      if (sign < 0) return std::nullopt;  // "m//s", or a slash that begins another fraction
      sign = -1, ++at;
      continue;
    }
    const std::size_t end = std::min(unit.find_first_of(" ./", at), unit.size());
    const std::string factor = unit.substr(at, end - at);
    const auto letters = std::ranges::find_if(factor, [](char c) { return is_digit(c) || c == '-' || c == '^'; });
    Factor one{{factor.begin(), letters}, sign};
    if (letters != factor.end()) {
      const char *first = &*letters + (*letters == '^' ? 1 : 0), *last = factor.data() + factor.size();
      int power = 0;
      const auto [stop, error] = std::from_chars(first, last, power);
      if (error != std::errc() || stop != last) return std::nullopt;
      one.power *= power;
    }
    const auto is_strange = [](char c) { return c != '%' && std::ispunct(static_cast<unsigned char>(c)) != 0; };
    if (std::ranges::any_of(one.unit, is_strange)) return std::nullopt;
    if (one.unit.empty()) {
      if (factor != "1") return std::nullopt;
    } else {
      factors.push_back(std::move(one));
    }
    sign = 1, at = end;
  }
  return sign > 0 ? std::optional(std::move(factors)) : std::nullopt;
}

/// "kg/(m² s)", "1/m".
std::string written(const std::vector<Factor>& factors) {
  std::array<std::string, 2> above_and_below;
  int below = 0;
  for (const auto& [unit, power] : factors) {
    if (power == 0) continue;
    std::string& side = above_and_below[power < 0 ? 1 : 0];
    below += power < 0 ? 1 : 0;
    if (!side.empty()) side += ' ';
    side += unit + (std::abs(power) == 1 ? "" : in_small(std::to_string(std::abs(power)), superscripts));
  }
  const auto& [above, under] = above_and_below;
  if (below == 0) return above.empty() ? "1" : above;
  return (above.empty() ? "1" : above) + '/' + (below > 1 ? '(' + under + ')' : under);
}

}  // namespace

std::string written_unit(const std::string& unit) {
  if (unit == "degree" || unit == "degrees" || unit == "deg") return "°";
  const auto factors = factors_of(unit);
  return factors ? written(*factors) : unit;
}

ReadableUnit readable(const std::string& unit, double largest) {
  if (unit == "rad") return {180 / std::numbers::pi, "°"};
  auto factors = factors_of(unit);
  if (!factors || factors->empty() || factors->front().power != 1) return {1, written_unit(unit)};
  std::string& first = factors->front().unit;
  const bool density = factors->size() == 2 && factors->back() == Factor{"m", -3};
  if (first == "kg" && !density && largest > 0 && largest < 1) {
    first = "g";
    return {1e3, written(*factors)};
  }
  if (first != "m" && first != "Pa" && first != "N" && first != "J" && first != "W") return {1, written_unit(unit)};
  struct Prefix {
    double size;
    const char* letter;
  };
  constexpr std::array<Prefix, 6> prefixes{{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "µ"}}};
  const bool length = first == "m";
  for (const auto& [size, letter] : prefixes)
    if (largest >= size && !(length && size > 1)) {
      first.insert(0, letter);
      return {1 / size, written(*factors)};
    }
  if (!(largest > 0)) return {1, written(*factors)};
  first.insert(0, "µ");
  return {1e6, written(*factors)};
}

std::string after_number(const std::string& unit) {
  return unit.empty() || unit == "1" ? "" : unit == "°" ? unit : ' ' + unit;
}

std::string axis_title(const std::string& label, const std::string& unit) {
  return unit.empty() || unit == "1" ? label : label + " [" + unit + "]";
}

std::string spelled(const std::string& name) {
  constexpr std::size_t index_letters = 3;  // a longer word after a symbol is no index
  std::string all;
  bool after_symbol = false;
  for (const auto part : name | std::views::split('_')) {
    std::string word(part.begin(), part.end());
    const auto* const symbol = std::ranges::find(symbols, word, &Symbol::name);
    const bool number = after_symbol && !word.empty() && std::ranges::all_of(word, is_digit);
    if (symbol != symbols.end()) word = symbol->letter;
    else if (number) word = in_small(word, subscripts);
    if (!all.empty() && !number) all += after_symbol && word.size() <= index_letters ? '_' : ' ';
    all += word;
    after_symbol = symbol != symbols.end();
  }
  return all;
}

std::string with_symbols(const std::string& text) {
  const auto is_of_a_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  std::string all;
  for (auto at = text.begin(); at != text.end();) {
    const auto end = std::find_if_not(at, text.end(), is_of_a_name);
    if (end == at) {
      all += *at++;
      continue;
    }
    const std::string name(at, end);
    const bool symbol = name.find('_') != name.npos &&
                        std::ranges::find(symbols, name.substr(0, name.find('_')), &Symbol::name) != symbols.end();
    all += symbol ? spelled(name) : name;
    at = end;
  }
  return all;
}

std::string channel_label(const std::string& probe, const std::string& channel) {
  return probe == "test" || channel == "time" ? spelled(channel) : probe + ": " + spelled(channel);
}

}  // namespace grit
