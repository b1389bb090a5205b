#include "input/reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>
#include <set>
#include <tuple>

#include "format/names.hpp"
#include "format/number.hpp"
#include "grit/error.hpp"
#include "grit/toolkit/did_you_mean.hpp"
#include "input/range.hpp"
#include "input/units.hpp"

namespace grit {
namespace {

/// `unknown key "colour"; did you mean "color"? Allowed are color, view`
std::string unknown(const std::string& what, const std::string& found, const std::vector<std::string>& names) {
  return "unknown " + what + ' ' + in_quotes(found) +
         did_you_mean(found, names, (names.size() == 1 ? "allowed is " : "allowed are ") + listed(names));
}

class Reader {
 public:
  Reader(const Document& document, std::vector<Problem>& problems) : document_(document), problems_(problems) {}

  bool object(const Description& value, const std::string& at, Parameters& parameters) {
    if (!value.is_object()) return wrong(at, value, "an object");
    const std::size_t before = problems_.size();
    const bool chosen = choose(value, at, parameters);
    const auto names = declared(parameters, at);
    bool is_part = false;
    if (chosen && !parameters.is_open())
      for (const auto& [key, _] : value.items())
        if (std::ranges::find(names, key) == names.end()) is_part |= refuse(key, at, names, parameters);
    if (is_part) return false;

    std::set<std::string> unclean;
    for (const auto& parameter : parameters.entries())
      if (!entry(value, at, parameter)) unclean.insert(parameter.name());
    const bool clean = problems_.size() == before;
    for (const auto& check : parameters.checks()) {
      const auto is_clean = [&](const std::string& key) { return !unclean.contains(key); };
      if (!check.despite_problems && !(check.about.empty() ? clean : std::ranges::all_of(check.about, is_clean)))
        continue;
      const auto known = faults_;
      check.run([&](std::string_view key, std::string_view found, std::string_view allowed) {
        const std::string where = key.empty() ? at : at + '/' + std::string(key);
        if (check.despite_problems && has_fault(known, where)) return;
        complain(where, fault_text(std::string(found), std::string(allowed)));
      });
    }
    if (problems_.size() != before) return false;
    for (const auto& call : parameters.calls_when_read()) call();
    return true;
  }
  /// A named entry.
  bool named(const Description& entry, const std::string& name, const std::string& at, Parameters& parameters) {
    return has_good_name(name, at) && object(entry, at, parameters);
  }

 private:
  bool complain(const std::string& at, std::string message) { return complain(at, at, std::move(message)); }
  /// `fault` is the invalid pointer, e.g. that of a key missing in the object `at`.
  bool complain(const std::string& at, const std::string& fault, std::string message) {
    problems_.push_back(document_.problem(at, std::move(message)));
    faults_.push_back(fault);
    return false;
  }
  /// Whether one of `faults` lies at, above or below a pointer.
  static bool has_fault(const std::vector<std::string>& faults, const std::string& at) {
    return std::ranges::any_of(faults, [&](const std::string& fault) {
      const auto& [shorter, longer] = fault.size() < at.size() ? std::tie(fault, at) : std::tie(at, fault);
      return longer.starts_with(shorter) && (longer.size() == shorter.size() || longer[shorter.size()] == '/');
    });
  }
  bool wrong(const std::string& at, const Description& found, const std::string& allowed) {
    return complain(at, "found " + describe_value(found) + "; allowed is " + allowed);
  }

  /// Reports an unknown key. Returns whether it is probably one that is resolved before the object is read: then the
  /// object is only a part of what is meant, and what is missing in it is no fault.
  bool refuse(const std::string& key, const std::string& at, std::vector<std::string> names,
              const Parameters& parameters) {
    const auto& earlier = parameters.keys_resolved_before();
    const std::string pointer = at + '/' + pointer_token(key);
    if (std::ranges::find(earlier, key) != earlier.end()) {
      complain(pointer, "found " + in_quotes(key) + ", which has an effect in a file only; write it in the file");
      return true;
    }
    names.insert(names.end(), earlier.begin(), earlier.end());
    complain(pointer, unknown("key", key, names));
    const auto meant = nearest(key, names);
    return meant && std::ranges::find(earlier, *meant) != earlier.end();
  }

  /// Makes the choice of an object and declares its parameters. False if the choice is invalid.
  bool choose(const Description& value, const std::string& at, Parameters& parameters) {
    Choice* const choice = parameters.choice();
    if (choice == nullptr) return true;
    const auto types = choice->types();
    const auto type = value.find("type");
    if (type == value.end())
      return complain(at, at + "/type",
                      "missing key \"type\", the " + choice->what() + "; allowed are " + listed(types));
    if (!type->is_string()) return wrong(at + "/type", *type, "a text that names the " + choice->what());
    const auto& name = type->get_ref<const std::string&>();
    if (std::ranges::find(types, name) == types.end())
      return complain(at + "/type", unknown(choice->what(), name, types) + how_to_add(*choice));
    choice->choose(name);
    choice->declare(parameters);
    return true;
  }

  static std::string how_to_add(const Choice& choice) {
    const std::string text = choice.how_to_add();
    return text.empty() ? "" : "; " + text;
  }

  static std::vector<std::string> declared(const Parameters& parameters, const std::string& at) {
    std::vector<std::string> names;
    if (parameters.choice() != nullptr) names.push_back("type");
    for (const auto& parameter : parameters.entries()) {
      if (std::ranges::find(names, parameter.name()) != names.end())
        throw PluginError(
            "the key " + in_quotes(parameter.name()) + " is declared twice in the object " + in_quotes(at) +
            (parameters.choice()
                 ? ", whose " + parameters.choice()->what() + " is " + in_quotes(parameters.choice()->type())
                 : "") +
            "; let the plugin give its parameter another name");
      names.push_back(parameter.name());
    }
    return names;
  }

  bool entry(const Description& object, const std::string& at, const Parameter& parameter) {
    const auto value = object.find(parameter.name());
    const std::string pointer = at + '/' + pointer_token(parameter.name());
    if (value != object.end())
      return std::visit([&](const auto& target) { return read(*value, pointer, parameter, target); },
                        parameter.target());
    if (!parameter.is_required()) return true;
    const std::string unit = parameter.unit() == "1" ? "" : " [" + parameter.unit() + ']';
    return complain(
        at, pointer,
        "missing key " + in_quotes(parameter.name()) + unit + (parameter.doc().empty() ? "" : ": " + parameter.doc()));
  }

  // ---- numbers

  bool number(const Description& value, const std::string& at, const Parameter& parameter, double& target) {
    const std::string& unit = parameter.unit();
    if (value.is_number()) {
      const double found = value.get<double>();
      const std::string spelling = unit == "1" ? "" : unit;
      if (!parameter.allows(found))
        return out_of_range(at, quantity_text(found, unit, spelling) + degrees_meant(found, parameter), parameter,
                            spelling);
      target = found;
      return true;
    }
    if (!value.is_string()) return wrong(at, value, quantities(parameter));
    const auto& text = value.get_ref<const std::string&>();
    const auto found = parse_quantity(text, unit);
    if (!found) {
      const bool bare = unit != "1" && parse_quantity(text, "1");
      return complain(at, "found " + describe_value(value) + (bare ? ", a number without a unit" : "") +
                              "; allowed is " + quantities(parameter));
    }
    if (!parameter.allows(found->value)) return out_of_range(at, text, parameter, found->spelling);
    target = found->value;
    return true;
  }
  /// For an angle that would be allowed in degrees.
  static std::string degrees_meant(double found, const Parameter& parameter) {
    if (parameter.unit() != "rad") return "";
    const std::string degrees = quantity_text(found * std::numbers::pi / 180, "rad", "deg");
    const auto meant = parse_quantity(degrees, "rad");
    return meant && parameter.allows(meant->value) ? "; did you mean \"" + degrees + "\"?" : "";
  }
  static std::string quantities(const Parameter& parameter) {
    const std::string& unit = parameter.unit();
    if (unit == "1") return "a number, or a text such as \"5 %\"";
    return "a number of " + unit + ", or a text with a number and one of " + unit_list(unit);
  }
  bool out_of_range(const std::string& at, const std::string& found, const Parameter& parameter,
                    const std::string& spelling) {
    return complain(at, fault_text(found, range_text(parameter, spelling)));
  }

  bool read(const Description& value, const std::string& at, const Parameter& parameter, double* target) {
    return number(value, at, parameter, *target);
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter,
            std::optional<double>* target) {
    double found = 0;
    if (!number(value, at, parameter, found)) return false;
    *target = found;
    return true;
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter, std::int64_t* target) {
    constexpr double most = 9e15;  // above it, double skips integers
    const double found = value.is_number() ? value.get<double>() : std::nan("");
    if (!(found == std::floor(found) && std::abs(found) < most)) return wrong(at, value, "an integer");
    if (!parameter.allows(found)) return out_of_range(at, value.dump(), parameter, "");
    *target = static_cast<std::int64_t>(found);
    return true;
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter, Vec3* target) {
    if (!value.is_array() || value.size() != 3) return wrong_length(at, value, "3 numbers, of x, y and z");
    bool clean = true;
    for (int k = 0; k < 3; ++k)
      clean &= number(value[as_index(k)], at + '/' + std::to_string(k), parameter, (*target)[k]);
    return clean;
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter, std::optional<Vec3>* target) {
    Vec3 found = Vec3::Zero();
    if (!read(value, at, parameter, &found)) return false;
    *target = found;
    return true;
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter, std::vector<double>* target) {
    if (!long_enough(value, at, parameter, "numbers")) return false;
    target->assign(value.size(), 0.0);
    bool clean = true;
    for (std::size_t i = 0; i < value.size(); ++i)
      clean &= number(value[i], at + '/' + std::to_string(i), parameter, (*target)[i]);
    return clean;
  }

  // ---- flags and texts

  bool read(const Description& value, const std::string& at, const Parameter&, bool* target) {
    if (!value.is_boolean()) return wrong(at, value, "true or false");
    *target = value.get<bool>();
    return true;
  }
  bool read(const Description& value, const std::string& at, const Parameter&, std::array<bool, 3>* target) {
    if (!value.is_array() || value.size() != 3) return wrong_length(at, value, "3 flags, of x, y and z");
    bool clean = true;
    for (std::size_t k = 0; k < 3; ++k)
      clean &= value[k].is_boolean() || wrong(at + '/' + std::to_string(k), value[k], "true or false");
    if (clean) *target = value.get<std::array<bool, 3>>();
    return clean;
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter, std::string* target) {
    const auto& choices = parameter.choices();
    if (!value.is_string()) return wrong(at, value, choices.empty() ? "a text" : "one of " + listed(choices));
    std::string found = value.get<std::string>();
    if (!choices.empty() && std::ranges::find(choices, found) == choices.end())
      return complain(at, fault_text(in_quotes(found) + did_you_mean(found, choices), "one of " + listed(choices)));
    if (parameter.is_file()) {
      const std::filesystem::path path = document_.origin(at).source->directory / found;
      found = found.empty() ? found : std::filesystem::absolute(path).lexically_normal().string();
    }
    *target = std::move(found);
    return true;
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter,
            std::vector<std::string>* target) {
    if (!long_enough(value, at, parameter, "texts")) return false;
    target->assign(value.size(), {});
    bool clean = true;
    for (std::size_t i = 0; i < value.size(); ++i)
      clean &= read(value[i], at + '/' + std::to_string(i), parameter, &(*target)[i]);
    return clean;
  }
  bool read(const Description& value, const std::string&, const Parameter&, Description* target) {
    *target = value;
    return true;
  }

  // ---- objects

  bool read(const Description& value, const std::string& at, const Parameter&, const ObjectTarget& target) {
    Parameters inner;
    target.declare(inner);
    return object(value, at, inner);
  }
  bool read(const Description& value, const std::string& at, const Parameter&, const OptionalTarget& target) {
    Parameters inner;
    target.create(inner);
    return object(value, at, inner);
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter, const ListTarget& target) {
    if (!long_enough(value, at, parameter, "objects")) return false;
    target.clear();
    bool clean = true;
    for (std::size_t i = 0; i < value.size(); ++i) {
      Parameters inner;
      target.append(inner);
      clean &= object(value[i], at + '/' + std::to_string(i), inner);
    }
    return clean;
  }
  bool read(const Description& value, const std::string& at, const Parameter& parameter, const MapTarget& target) {
    if (!value.is_object()) return wrong(at, value, "an object with a name for each of its entries");
    if (value.size() < parameter.least_entries()) return too_few(at, value, parameter);
    target.clear();
    bool clean = true;
    for (const auto& [name, entry] : value.items()) {
      const std::string pointer = at + '/' + pointer_token(name);
      if (!has_good_name(name, pointer)) {
        clean = false;
        continue;
      }
      Parameters inner;
      target.insert(name, inner);
      clean &= object(entry, pointer, inner);
    }
    return clean;
  }

  bool has_good_name(const std::string& name, const std::string& at) {
    static const std::regex pattern(name_pattern);
    return (name.size() <= 100 && std::regex_match(name, pattern)) ||
           complain(at, "found the name " + in_quotes(name) +
                            "; allowed are letters, digits and _ . + -, 100 at most, the first a letter, a digit or _");
  }

  // ---- lengths

  bool long_enough(const Description& value, const std::string& at, const Parameter& parameter,
                   const std::string& what) {
    if (!value.is_array()) return wrong(at, value, "a list of " + what);
    return value.size() >= parameter.least_entries() || too_few(at, value, parameter);
  }
  bool too_few(const std::string& at, const Description& value, const Parameter& parameter) {
    return complain(at, "found " + counted(value.size(), "entry", "entries") + "; allowed are " +
                            std::to_string(parameter.least_entries()) + " or more");
  }
  bool wrong_length(const std::string& at, const Description& value, const std::string& allowed) {
    if (!value.is_array()) return wrong(at, value, "a list of " + allowed);
    return complain(at, "found a list of " + std::to_string(value.size()) + "; allowed is a list of " + allowed);
  }

  const Document& document_;
  std::vector<Problem>& problems_;
  std::vector<std::string> faults_;  // pointers with a problem
};

}  // namespace

bool read(const Document& document, const std::string& pointer, Parameters& parameters,
          std::vector<Problem>& problems) {
  return Reader(document, problems).object(document.json().at(Description::json_pointer(pointer)), pointer, parameters);
}

bool read_entry(const Document& document, const std::string& section, const std::string& name, Parameters& parameters,
                std::vector<Problem>& problems) {
  return Reader(document, problems)
      .named(document.json().at(section).at(name), name, '/' + section + '/' + pointer_token(name), parameters);
}

void read(const Document& document, Parameters& parameters) {
  std::vector<Problem> problems;
  if (!read(document, "", parameters, problems)) throw DescriptionError(std::move(problems));
}

}  // namespace grit
