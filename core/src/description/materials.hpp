// Materials, and interfaces of two.
#pragma once

#include <string>
#include <string_view>

#include "grit/contact/contact_law.hpp"
#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

struct MaterialDescription {
  double density = 2600;
  Description values = Description::object();  ///< of the parameters of the contact law, SI
  /// With a law: declares its parameters, for reading. Without: declares the present values.
  void declare(const std::string& name, ContactLaw* law, Parameters& p);
  bool operator==(const MaterialDescription&) const = default;
};
/// Contact of two materials, in either order.
struct InterfaceDescription {
  std::string a, b;                            ///< b is empty if the name had no "+"
  Description values = Description::object();  ///< of the parameters of the contact law, SI
  /// `name` as in the description, "a+b".
  explicit InterfaceDescription(const std::string& name);
  std::string name() const { return b.empty() ? a : a + '+' + b; }
  /// The same as name() == other.
  bool is_named(std::string_view other) const {
    return b.empty() ? other == a
                     : other.size() == a.size() + 1 + b.size() && other.starts_with(a) && other[a.size()] == '+' &&
                           other.ends_with(b);
  }
  /// As MaterialDescription::declare().
  void declare(ContactLaw* law, Parameters& p);
  bool operator==(const InterfaceDescription&) const = default;
};

}  // namespace grit
