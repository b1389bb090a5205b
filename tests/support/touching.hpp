// Which bodies touch: as the search has it, and by trying all.
#pragma once

#include <set>
#include <utility>

#include "support/scene.hpp"

namespace grit::test {

using Touching = std::set<std::pair<std::uint32_t, std::uint32_t>>;

inline Touching found(const Kernel& kernel) {
  Touching pairs;
  for (std::size_t c = 0; c < kernel.state().pairs.candidates(); ++c)
    if (kernel.state().pairs.contacts(c)) pairs.emplace(kernel.state().pairs.a(c), kernel.state().pairs.b(c));
  return pairs;
}
/// Not across periodic sides.
inline Touching there(const World& world) {
  Touching pairs;
  const auto x = world.positions();
  for (std::uint32_t a = 0; a < x.size(); ++a)
    for (std::uint32_t b = a + 1; b < x.size(); ++b)
      if ((xyz(x[b]) - xyz(x[a])).squaredNorm() < (x[a].w + x[b].w) * (x[a].w + x[b].w)) pairs.emplace(a, b);
  return pairs;
}

}  // namespace grit::test
