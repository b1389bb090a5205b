// Finds facets by where they are.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "grit/geometry.hpp"

namespace grit {

/// An R-tree of boxes: what is asked of it costs the logarithm of their number.
class FacetIndex {
 public:
  /// Of facets by their numbers.
  explicit FacetIndex(const std::vector<std::pair<Bounds, std::uint32_t>>& boxes);
  ~FacetIndex();
  /// The facets whose boxes meet this one, in rising order, in place of what was in `facets`.
  void meeting(const Bounds& box, std::vector<std::uint32_t>& facets) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace grit
