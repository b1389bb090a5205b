// Indices of bodies after they have been sorted in space.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grit {

/// Index that marks a body as removed.
inline constexpr std::uint32_t body_gone = ~0u;

/// The present index of each body by its former one, or body_gone. `order[i]` is the former index of the body that now
/// has index i; empty if all have left. Bodies may have been appended since there were `before` of them.
inline std::vector<std::uint32_t> present_indices(std::span<const std::uint32_t> order, std::size_t before) {
  const std::size_t known = order.empty() ? 0 : std::size_t{std::ranges::max(order)} + 1;
  std::vector<std::uint32_t> now(std::max(before, known), body_gone);
  for (std::size_t i = 0; i < order.size(); ++i) now[order[i]] = static_cast<std::uint32_t>(i);
  return now;
}

}  // namespace grit
