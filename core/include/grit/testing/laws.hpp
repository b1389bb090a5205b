// Creates contact laws for tests, with parameters set without a description.
#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "grit/contact/contact_law.hpp"
#include "grit/plugin.hpp"

namespace grit::test {

using Value = std::variant<double, bool, std::string>;
using Values = std::map<std::string, Value>;

/// Sets declared parameters by name. Throws std::invalid_argument for an unknown name, a wrong type or a value out of
/// range.
inline void assign(Parameters& parameters, const Values& values) {
  for (const auto& [name, value] : values) {
    const auto fail = [&, &key = name](const char* what) { throw std::invalid_argument(key + what); };
    const Parameter* found = nullptr;
    for (const Parameter& p : parameters.entries())
      if (p.name() == name) found = &p;
    if (found == nullptr) fail(": no such parameter");
    if (const double* number = std::get_if<double>(&value)) {
      if (!found->allows(*number)) fail(": out of range");
      if (const auto* plain = std::get_if<double*>(&found->target())) **plain = *number;
      else if (const auto* maybe = std::get_if<std::optional<double>*>(&found->target())) **maybe = *number;
      else fail(": not a number");
    } else if (const bool* flag = std::get_if<bool>(&value)) {
      **std::get_if<bool*>(&found->target()) = *flag;
    } else {
      **std::get_if<std::string*>(&found->target()) = std::get<std::string>(value);
    }
  }
}

/// Parameters of a law, of its materials by index, and of interfaces by pairs of indices.
struct LawValues {
  Values settings;
  std::vector<Values> materials;
  std::map<std::pair<std::size_t, std::size_t>, Values> interfaces;
};

/// Creates the law of the plugin that the test is linked with; materials have the names "m0", "m1", ….
inline std::unique_ptr<ContactLaw> make_law(const LawValues& values) {
  std::unique_ptr<ContactLaw> law(grit_plugin()->make_contact());
  Parameters settings;
  law->declare(settings);
  assign(settings, values.settings);
  std::vector<std::string> names;
  for (std::size_t m = 0; m < values.materials.size(); ++m) {
    names.push_back("m" + std::to_string(m));
    Parameters p;
    law->declare_material(names.back(), p);
    assign(p, values.materials[m]);
  }
  for (const auto& [pair, overrides] : values.interfaces) {
    Parameters p;
    law->declare_interface(names[pair.first], names[pair.second], p);
    assign(p, overrides);
  }
  law->mix(names, names.size());
  return law;
}

}  // namespace grit::test
