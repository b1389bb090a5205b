// What a contact law says about itself: its optional parts, and the fields of its contact history.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string>
#include <type_traits>
#include <vector>

#include "grit/contact/contact_law.hpp"

namespace grit {

/// The optional parts of a law. The law announces here which it has: a part that is announced and missing, or there and
/// not announced, is an error, as is a misspelt name.
struct LawTraits {
  /// The law may be evaluated in single precision: a parameter `precision` offers it.
  bool single_precision = false;
  /// The law has losses(): the energy balance includes what its contacts dissipate. Else that is in the closure error.
  bool losses = false;
  /// Names of parts that can be switched off, in the order of their bits; then the law has features(). The loop is
  /// compiled once for each combination.
  const char* features[4] = {};
};

/// Of LawField::needed_by: whatever the features are.
inline constexpr unsigned always = ~0u;

/// One member of a law's State, in the order of the members.
struct LawField {
  const char* name;             ///< that of the member, snake_case; the numbers of a vector have _x, _y, _z behind it
  const char* unit;             ///< UDUNITS spelling
  const char* doc;              ///< one line
  std::size_t width = 1;        ///< 1 for a number, 3 for a vector
  double swap = 1;              ///< −1 if the member changes its sign where a and b are exchanged
  unsigned needed_by = always;  ///< bits of the features that need it; contacts keep it while one of them is on
};

namespace detail {

template <class Law>
inline constexpr unsigned feature_count = static_cast<unsigned>(
    std::ranges::count_if(Law::traits.features, [](const char* name) { return name != nullptr; }));

/// The members of State that `features` need, a bit for each of their numbers.
template <class Law>
constexpr unsigned fields_used(unsigned features) {
  unsigned used = 0;
  if constexpr (requires { Law::fields; }) {
    std::size_t bit = 0;
    for (const LawField& field : Law::fields)
      for (std::size_t k = 0; k < field.width; ++k, ++bit)
        if (field.needed_by == always || (field.needed_by & features) != 0) used |= 1u << bit;
  }
  return used;
}

/// One entry for each number of State.
template <class Law>
std::vector<StateField> state_fields() {
  std::vector<StateField> all;
  if constexpr (requires { Law::fields; })
    for (const LawField& field : Law::fields)
      for (std::size_t k = 0; k < field.width; ++k) {
        const std::string component = field.width == 1 ? "" : std::string("_") + "xyz"[k];
        all.push_back({field.name + component, field.unit, field.doc, field.swap});
      }
  return all;
}

}  // namespace detail
}  // namespace grit
