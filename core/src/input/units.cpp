#include "input/units.hpp"

#include <udunits2.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <regex>
#include <sstream>
#include <utility>

#include "format/resources.hpp"
#include "grit/error.hpp"

namespace grit {
namespace {

struct Spellings {
  std::vector<std::string> friendly;  // may be chosen for printing
  std::vector<std::string> also;
};

const std::map<std::string, Spellings>& table() {
  static const std::map<std::string, Spellings> spellings{
      {"1", {{"", "%"}, {}}},
      {"m", {{"m", "mm", "um"}, {"cm", "km", "µm", "nm"}}},
      {"m^2", {{"m^2", "mm^2"}, {"cm^2", "m2", "cm2", "mm2"}}},
      {"m^3", {{"m^3", "mm^3"}, {"cm^3", "l", "m3", "cm3", "mm3"}}},
      {"s", {{"s", "ms", "us"}, {"µs", "ns", "min", "h"}}},
      {"kg", {{"kg", "g", "mg", "t"}, {"ug", "µg"}}},
      {"kg/s", {{"kg/s", "g/s"}, {"kg/min", "kg/h", "t/h"}}},
      {"Pa", {{"Pa", "kPa", "MPa", "GPa"}, {"hPa", "mbar", "bar", "N/m^2", "kN/m^2", "MN/m^2", "N/mm^2"}}},
      {"N", {{"N", "mN", "kN", "MN"}, {"uN", "µN"}}},
      {"N m", {{"N m", "kN m"}, {"mN m", "N mm", "N cm"}}},
      {"rad", {{"deg", "rad"}, {"mrad", "degree", "degrees", "°"}}},
      {"m/s", {{"m/s", "mm/s", "um/s"}, {"cm/s", "m/min", "mm/min", "mm/h", "m/h", "km/h"}}},
      {"m/s^2", {{"m/s^2", "mm/s^2"}, {"cm/s^2", "m/s2", "mm/s2", "m s-2"}}},
      {"rad/s", {{"rad/s"}, {"mrad/s", "deg/s", "deg/min", "rpm"}}},
      {"1/s", {{"1/s"}, {"s-1", "%/s", "1/min", "%/min", "1/h", "%/h", "Hz", "kHz"}}},
      {"Hz", {{"Hz", "kHz"}, {"MHz", "1/s", "1/min"}}},
      {"1/m", {{"1/m", "1/mm"}, {"1/cm"}}},
      {"kg/m^3", {{"kg/m^3"}, {"g/cm^3", "t/m^3", "kg/m3", "g/cm3", "t/m3"}}},
      {"N/m^3", {{"N/m^3", "kN/m^3"}, {"MN/m^3", "N/m3", "kN/m3"}}},
      {"kg m^2", {{"kg m^2"}, {"g mm^2", "g cm^2", "kg mm^2"}}},
      {"J", {{"J", "mJ", "uJ", "kJ"}, {"µJ", "nJ", "N m"}}},
      {"J/m^2", {{"J/m^2", "mJ/m^2"}, {"J/m2", "mJ/m2", "N/m", "mN/m"}}},
      {"J/m^3", {{"J/m^3", "kJ/m^3"}, {"J/m3"}}},
      {"W", {{"W", "mW", "kW"}, {}}},
      {"N/m", {{"N/m", "kN/m", "MN/m"}, {"N/mm", "mN/m"}}},
      {"N m/rad", {{"N m/rad"}, {"N m/deg", "N mm/rad"}}},
      {"N s/m", {{"N s/m"}, {"kN s/m"}}},
      {"Pa s", {{"Pa s", "mPa s"}, {}}},
      {"Pa/m", {{"Pa/m", "kPa/m", "MPa/m"}, {"kPa/mm", "MPa/mm"}}},
      {"Pa/s", {{"Pa/s", "kPa/s", "MPa/s"}, {"kPa/min"}}},
  };
  return spellings;
}

/// From a spelling to SI.
struct Scale {
  double factor = 1;
  std::optional<int> exponent;  // if the factor is a power of ten
};

/// More than enough for the unit database in memory.
constexpr std::size_t database_bytes = 1 << 24;

/// The UDUNITS-2 library. Its parser is not thread-safe.
class Udunits {
 public:
  static Udunits& only() {
    static Udunits instance;
    return instance;
  }

  /// Throws PluginError for units that do not convert, as only a wrong declaration can cause it.
  Scale scale(const std::string& spelling, const std::string& unit) {
    const std::lock_guard lock(mutex_);
    auto [found, is_new] = scales_.try_emplace({spelling, unit});
    if (is_new) {
      try {
        found->second = make_scale(spelling, unit);
      } catch (...) {
        scales_.erase(found);
        throw;
      }
    }
    return found->second;
  }

  bool knows(const std::string& text) {
    const std::lock_guard lock(mutex_);
    return parse(text) != nullptr;
  }

 private:
  using System = std::unique_ptr<ut_system, decltype(&ut_free_system)>;
  using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;
  using Converter = std::unique_ptr<cv_converter, decltype(&cv_free)>;

  Udunits() : system_(nullptr, ut_free_system) {
    ut_set_error_message_handler(ut_ignore);
    if (!can_take(database_bytes)) throw std::bad_alloc();  // the library would crash
    errno = 0;
    system_.reset(ut_read_xml(nullptr));
    if (!system_) fail(ut_get_status(), errno);
    // The usual symbol, which the database lacks.
    ut_map_symbol_to_unit("deg", UT_ASCII, parse("degree").get());
  }

  [[noreturn]] static void fail(ut_status status, int error) {
    if (error == ENOMEM) throw std::bad_alloc();
    ut_status found{};
    const char* const path = ut_get_path_xml(nullptr, &found);
    const bool is_missing = status == UT_OPEN_DEFAULT || status == UT_OPEN_ENV;
    throw FileError(std::string(path == nullptr ? "udunits2.xml" : path) + ": the unit database of UDUNITS-2 " +
                    (is_missing ? "does not open; install libudunits2-data, or set UDUNITS2_XML_PATH to its path"
                                : "does not read: it is damaged, or there is no memory left"));
  }

  Unit parse(const std::string& text) const {
    return {ut_parse(system_.get(), text.empty() ? "1" : text.c_str(), UT_UTF8), ut_free};
  }

  Scale make_scale(const std::string& spelling, const std::string& unit) const {
    const Unit from = parse(spelling), to = parse(unit);
    const Converter converter(from && to ? ut_get_converter(from.get(), to.get()) : nullptr, cv_free);
    if (!converter)
      throw PluginError("the unit \"" + spelling + "\" does not convert to \"" + unit +
                        "\"; declare a unit of UDUNITS-2");
    Scale scale;
    scale.factor = cv_convert_double(converter.get(), 1.0);
    const double exponent = std::round(std::log10(scale.factor));
    if (std::abs(scale.factor - std::pow(10, exponent)) < 1e-14 * scale.factor)
      scale.exponent = static_cast<int>(exponent);
    return scale;
  }

  std::mutex mutex_;
  System system_;
  std::map<std::pair<std::string, std::string>, Scale> scales_;
};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("^$\\.*+?()[]{}|").find(c) != std::string_view::npos) result += '\\';
    result += c;
  }
  return result;
}

/// number × 10^shift, rounded once.
double shifted(const std::string& number, int shift) {
  const auto e = number.find_first_of("eE");
  std::string text = number.substr(0, e);
  if (e != std::string::npos) shift += std::atoi(number.c_str() + e + 1);
  if (text.front() == '+') text.erase(0, 1);
  text += 'e' + std::to_string(shift);
  double value = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc::result_out_of_range)
    value = shift > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  return value;
}

std::string six_digits(double value) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(6);
  text << value;
  return text.str();
}

}  // namespace

std::vector<std::string> unit_spellings(const std::string& unit) {
  const auto row = table().find(unit);
  if (row == table().end()) return {unit};
  auto all = row->second.friendly;
  all.insert(all.end(), row->second.also.begin(), row->second.also.end());
  return all;
}

bool is_unit(const std::string& text) { return !text.empty() && Udunits::only().knows(text); }

std::string unit_list(const std::string& unit) {
  std::string text;
  for (const auto& spelling : unit_spellings(unit))
    if (!spelling.empty()) text += (text.empty() ? "" : ", ") + spelling;
  return text;
}

std::string quantity_pattern(const std::string& unit) {
  std::string units;
  bool first = true;
  for (const auto& spelling : unit_spellings(unit)) {
    if (!std::exchange(first, false)) units += '|';
    units += escaped(spelling);
  }
  return "^([-+]?(?:[0-9]+\\.?[0-9]*|\\.[0-9]+)(?:[eE][-+]?[0-9]{1,4})?) *(" + units + ")$";
}

std::optional<Quantity> parse_quantity(const std::string& text, const std::string& unit) {
  static std::mutex mutex;
  static std::map<std::string, std::regex> patterns;
  std::smatch parts;
  {
    const std::lock_guard lock(mutex);
    auto pattern = patterns.find(unit);
    if (pattern == patterns.end()) pattern = patterns.emplace(unit, std::regex(quantity_pattern(unit))).first;
    // Long texts are not quantities, and std::regex recurses along them.
    if (text.size() > 100 || !std::regex_match(text, parts, pattern->second)) return std::nullopt;
  }
  const std::string number = parts[1], spelling = parts[2];
  const Scale scale = Udunits::only().scale(spelling, unit);
  return Quantity{scale.exponent ? shifted(number, *scale.exponent) : shifted(number, 0) * scale.factor, spelling};
}

std::string quantity_text(double value, const std::string& unit, const std::string& spelling) {
  const Scale scale = Udunits::only().scale(spelling, unit);
  return six_digits(value / scale.factor) + (spelling.empty() || spelling == "%" ? "" : " ") + spelling;
}

std::string friendly_text(double value, const std::string& unit) {
  const auto row = table().find(unit);
  if (value == 0 || row == table().end() || unit == "1")
    return quantity_text(value, unit, unit_spellings(unit).front());
  std::string best;
  for (const auto& spelling : row->second.friendly) {
    std::string text = quantity_text(value, unit, spelling);
    if (best.empty() || text.size() < best.size()) best = std::move(text);
  }
  return best;
}

}  // namespace grit
