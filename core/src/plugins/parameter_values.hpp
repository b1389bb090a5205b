// Values of declared parameters, in SI, as JSON: taken from where they are declared, set there again, and single
// numbers among them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>

#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// All present values of a declaration, defaults too, numbers in SI; reading them gives the same values. What is
/// optional and absent, and choices that were not made, are left out. Values of free form stay as they were read.
Description write(Parameters& parameters);

/// The value of one parameter; nothing if it is absent.
std::optional<Description> write(const Parameter& parameter);

/// Sets a declaration to values that write() gave for the same declaration; what they leave out becomes absent or
/// empty. Objects in lists and maps whose length and names stay are kept. Nothing is checked.
void assign(Parameters& parameters, const Description& values);

/// A number where it is kept: a declared member, or a value of a described component.
class NumberPlace {
 public:
  using Place = std::variant<double*, std::int64_t*, Description*>;
  explicit NumberPlace(Place place) : place_(place) {}
  void set(double value) const;
  double get() const;
  bool is_integer() const;

 private:
  Place place_;
};

/// The number that `keys` lead to in a declaration; nothing if there is no number, or none at present. It stays valid
/// as long as the members that were declared, and the lists and maps in them, stay where they are.
std::optional<NumberPlace> find_number(Parameters& parameters, std::span<const std::string> keys);

}  // namespace grit
