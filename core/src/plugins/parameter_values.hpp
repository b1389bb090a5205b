// Values of declared parameters, in SI, as JSON: reads and sets all values of a declaration, or single numbers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "grit/description.hpp"
#include "grit/parameters.hpp"

namespace grit {

/// All present values of a declaration, with defaults, numbers in SI; reading them gives the same values. Absent
/// optional values and choices that were not made are omitted. Values of free form stay as they were read.
Description write(Parameters& parameters);

/// The value of one parameter; none if it is absent.
std::optional<Description> write(const Parameter& parameter);

/// Sets a declaration to values that write() returned for the same declaration. Omitted values become absent or empty.
/// Objects in lists and maps whose length and names do not change are kept. Nothing is checked.
void assign(Parameters& parameters, const Description& values);

/// Reference to a number: a declared member, or a value of a component that is described but not created.
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

/// How a number is declared.
struct Declared {
  std::optional<Parameter> parameter;  ///< its range; of a list or a vector: that of each entry
  std::vector<Check> checks;           ///< of all objects that contain it
};

/// The number at `keys` in a declaration; none if there is no number at present. It stays valid as long as the declared
/// members, and the lists and maps in them, are not moved; so do the checks added to `declared`.
std::optional<NumberPlace> find_number(Parameters& parameters, std::span<const std::string> keys,
                                       Declared* declared = nullptr);

}  // namespace grit
