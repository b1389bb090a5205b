// Traits of a contact law: its optional parts and the fields of its contact history.
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

/// Announces the optional parts of a law. An announced part that is missing, or a part that is not announced, is an
/// error at compile time; a misspelt name is thus found.
struct LawTraits {
  /// The law can be evaluated in single precision; users choose it by the parameter `precision`.
  bool single_precision = false;
  /// The law has losses(), so that the energy balance includes its dissipation; else it is part of the closure error.
  bool losses = false;
  /// Bodies interact before their surfaces touch, or after: the law has reach(). Its overlaps may then be negative.
  bool reach = false;
  /// Names of features that are evaluated only where needed, in the order of their bits; the law then has features().
  /// The loop is compiled once for each combination that `prerequisites` leaves.
  const char* features[4] = {};
  /// For each feature, the bits of others that are always evaluated with it; fewer combinations are then compiled.
  unsigned prerequisites[4] = {};
};

/// LawField::needed_by of a field that every combination of features needs.
inline constexpr unsigned always = ~0u;

/// One member of a law's State, in the order of the members.
struct LawField {
  const char* name;             ///< name of the member, snake_case; components of a vector get the suffixes _x, _y, _z
  const char* unit;             ///< UDUNITS spelling
  const char* doc;              ///< one line
  std::size_t width = 1;        ///< 1 for a number, 3 for a vector
  double swap = 1;              ///< −1 if the sign changes when a and b are exchanged
  unsigned needed_by = always;  ///< bits of the features that need it; contacts keep it while one of them is on
};

namespace detail {

template <class Law>
inline constexpr unsigned feature_count = static_cast<unsigned>(
    std::ranges::count_if(Law::traits.features, [](const char* name) { return name != nullptr; }));

/// `features` and their prerequisites.
template <class Law>
constexpr unsigned with_prerequisites(unsigned features) {
  for (unsigned before = ~features; before != features;) {
    before = features;
    for (unsigned bit = 0; bit < feature_count<Law>; ++bit)
      if ((features >> bit & 1) != 0) features |= Law::traits.prerequisites[bit];
  }
  return features;
}

/// The members of State that `features` need, one bit per number.
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

/// One entry per number of State.
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
