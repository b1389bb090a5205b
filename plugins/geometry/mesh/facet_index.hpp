// Spatial index of facets.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "grit/geometry.hpp"

namespace grit {

/// An R-tree of boxes: the cost of a query grows with the logarithm of their number.
class FacetIndex {
 public:
  /// Bounding boxes with facet numbers.
  explicit FacetIndex(const std::vector<std::pair<Bounds, std::uint32_t>>& boxes);
  ~FacetIndex();
  /// Replaces `facets` by those whose boxes intersect `box`, in ascending order.
  void intersecting(const Bounds& box, std::vector<std::uint32_t>& facets) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace grit
