#include "input/reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "format/names.hpp"
#include "input/range.hpp"
#include "input/units.hpp"

namespace grit {
namespace {

constexpr std::size_t columns = 6;
using Line = std::array<std::string, columns>;

/// Characters of a text in UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

class Table {
 public:
  Table() { lines_.push_back({"name", "symbol", "unit or type", "default", "allowed", "meaning"}); }

  void object(Parameters& parameters, int depth) {
    for (const auto& parameter : parameters.entries()) entry(parameter, depth);
    if (Choice* const choice = parameters.choice()) types(*choice, depth);
  }

  std::string text() const {
    std::array<std::size_t, columns> widths{};
    for (const auto& line : lines_)
      for (std::size_t c = 0; c < columns; ++c) widths[c] = std::max(widths[c], width(line[c]));
    std::string all;
    for (const auto& line : lines_) {
      std::string row;
      for (std::size_t c = 0; c < columns; ++c) row += line[c] + std::string(widths[c] - width(line[c]) + 2, ' ');
      all += row.substr(0, row.find_last_not_of(' ') + 1) + '\n';
    }
    return all;
  }

 private:
  static std::string indented(const std::string& name, int depth) {
    return std::string(2 * static_cast<std::size_t>(depth), ' ') + name;
  }

  void types(Choice& choice, int depth) {
    const std::string what = choice.what();
    const bool known = !seen_.insert(what).second;
    lines_.push_back({indented("type", depth), "", "one of", "required", listed(choice.types()),
                      what + (known ? ", as above" : "")});
    if (known) return;
    for (const auto& name : choice.types()) {
      const auto twin = choice.twin();
      twin->choose(name);
      Parameters inner;
      twin->declare(inner);
      lines_.push_back({indented('"' + name + '"', depth + 1), "", "", "", "", choice.type_doc(name)});
      object(inner, depth + 2);
    }
    seen_.erase(what);
  }

  void entry(const Parameter& p, int depth) {
    std::visit([&](const auto& target) { line(p, target, depth); }, p.target());
  }

  /// The line itself. A required parameter has no default.
  void add(const Parameter& p, int depth, std::string kind, std::string standard, std::string allowed) {
    lines_.push_back({indented(p.name(), depth), p.symbol(), std::move(kind),
                      p.is_required() ? "required" : std::move(standard), std::move(allowed), p.doc()});
  }
  static std::string unit_of(const Parameter& p) { return p.unit() == "1" ? "number" : p.unit(); }
  static std::string range_of(const Parameter& p) {
    if (!std::isfinite(p.low()) && !std::isfinite(p.high())) return "any";
    if (p.unit() == "1") return range_text(p, "");
    // In the unit that suits the bounds.
    const double bound = std::isfinite(p.high()) ? p.high() : p.low();
    const std::string friendly = friendly_text(bound, p.unit());
    for (const auto& spelling : unit_spellings(p.unit()))
      if (bound != 0 && friendly == quantity_text(bound, p.unit(), spelling)) return range_text(p, spelling);
    return range_text(p, p.unit());
  }
  static std::string entries_of(const Parameter& p) {
    return p.least_entries() > 0 ? std::to_string(p.least_entries()) + " or more" : "";
  }
  static std::string vector_text(const Vec3& v, const std::string& unit) {
    if (v.isZero(0.0)) return "0, 0, 0";
    return friendly_text(v.x(), unit) + ", " + friendly_text(v.y(), unit) + ", " + friendly_text(v.z(), unit);
  }

  void line(const Parameter& p, const double* v, int depth) {
    add(p, depth, unit_of(p), friendly_text(*v, p.unit()), range_of(p));
  }
  void line(const Parameter& p, const std::optional<double>* v, int depth) {
    add(p, depth, unit_of(p), *v ? friendly_text(**v, p.unit()) : "none", range_of(p));
  }
  void line(const Parameter& p, const std::int64_t* v, int depth) {
    add(p, depth, "integer", std::to_string(*v), range_of(p));
  }
  void line(const Parameter& p, const Vec3* v, int depth) {
    add(p, depth, "3 × " + unit_of(p), vector_text(*v, p.unit()), range_of(p));
  }
  void line(const Parameter& p, const std::optional<Vec3>* v, int depth) {
    add(p, depth, "3 × " + unit_of(p), *v ? vector_text(**v, p.unit()) : "none", range_of(p));
  }
  void line(const Parameter& p, const std::vector<double>* v, int depth) {
    std::vector<std::string> texts;
    for (const double x : *v) texts.push_back(friendly_text(x, p.unit()));
    add(p, depth, "list of " + unit_of(p), listed(texts, "empty"), range_of(p));
  }
  void line(const Parameter& p, const bool* v, int depth) { add(p, depth, "flag", *v ? "true" : "false", ""); }
  void line(const Parameter& p, const std::array<bool, 3>* v, int depth) {
    const auto text = [&](std::size_t k) { return std::string((*v)[k] ? "true" : "false"); };
    add(p, depth, "3 flags", text(0) + ", " + text(1) + ", " + text(2), "");
  }
  void line(const Parameter& p, const std::string* v, int depth) {
    add(p, depth, p.is_file() ? "file" : "text", v->empty() ? "\"\"" : *v, listed(p.choices(), ""));
  }
  void line(const Parameter& p, const std::vector<std::string>* v, int depth) {
    add(p, depth, "list of texts", listed(*v, "empty"), p.choices().empty() ? entries_of(p) : listed(p.choices()));
  }
  void line(const Parameter& p, const Description*, int depth) { add(p, depth, "JSON", "empty", ""); }

  void line(const Parameter& p, const ObjectTarget& target, int depth) {
    add(p, depth, "object", "", "");
    Parameters inner;
    target.declare(inner);
    object(inner, depth + 1);
  }
  void line(const Parameter& p, const OptionalTarget& target, int depth) {
    add(p, depth, "object", "none", "");
    Parameters inner;
    target.create(inner);
    object(inner, depth + 1);
  }
  void line(const Parameter& p, const ListTarget& target, int depth) {
    add(p, depth, "list of objects", "empty", entries_of(p));
    Parameters inner;
    target.append(inner);
    object(inner, depth + 1);
  }
  void line(const Parameter& p, const MapTarget& target, int depth) {
    add(p, depth, "objects by name", "empty", entries_of(p));
    Parameters inner;
    target.insert("a+b", inner);  // a name that is valid for interfaces too
    object(inner, depth + 1);
  }

  std::vector<Line> lines_;
  std::set<std::string> seen_;  // choices being listed, to stop at recursive ones
};

}  // namespace

std::string reference_text(Parameters& parameters) {
  Table table;
  table.object(parameters, 0);
  return table.text();
}

}  // namespace grit
