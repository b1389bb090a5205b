// The members of a law's structs as numbers, by index.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <type_traits>

#include "grit/contact/law_traits.hpp"

namespace grit::detail {

/// Member `i` of a struct that consists of lanes. (std::bit_cast was measured to copy through memory.)
template <class L, class Members>
[[gnu::always_inline]] constexpr L& member(Members& members, std::size_t i) {
  static_assert((std::is_empty_v<Members> || sizeof(Members) % sizeof(L) == 0) &&
                std::is_trivially_copyable_v<Members>);
  return reinterpret_cast<L*>(&members)[i];
}
template <class Members, class L>
inline constexpr std::size_t member_count = sizeof(Members) / sizeof(L);

/// Indices of the bits that are set.
template <unsigned mask>
inline constexpr auto places_of_bits = [] {
  std::array<std::size_t, std::popcount(mask)> places{};
  for (std::size_t bit = 0, k = 0; k < places.size(); ++bit)
    if ((mask >> bit & 1) != 0) places[k++] = bit;
  return places;
}();
/// Indices in State of the fields that contacts keep.
template <class Law, unsigned Features>
inline constexpr auto kept_fields = places_of_bits<fields_used<Law>(Features)>;

}  // namespace grit::detail
