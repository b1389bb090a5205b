#include "facet_index.hpp"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>

namespace grit {
namespace {

namespace index = boost::geometry::index;
using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
using Box = boost::geometry::model::box<Point>;

Box box(const Bounds& b) { return {{b.low.x(), b.low.y(), b.low.z()}, {b.high.x(), b.high.y(), b.high.z()}}; }

std::vector<std::pair<Box, std::uint32_t>> entries(const std::vector<std::pair<Bounds, std::uint32_t>>& boxes) {
  std::vector<std::pair<Box, std::uint32_t>> entries;
  entries.reserve(boxes.size());
  for (const auto& [bounds, facet] : boxes) entries.emplace_back(box(bounds), facet);
  return entries;
}

}  // namespace

struct FacetIndex::Tree : index::rtree<std::pair<Box, std::uint32_t>, index::quadratic<16>> {
  using rtree::rtree;
};

FacetIndex::FacetIndex(const std::vector<std::pair<Bounds, std::uint32_t>>& boxes)
    : tree_(std::make_unique<const Tree>(entries(boxes))) {}
FacetIndex::~FacetIndex() = default;

void FacetIndex::intersecting(const Bounds& bounds, std::vector<std::uint32_t>& facets) const {
  facets.clear();
  tree_->query(index::intersects(box(bounds)),
               boost::make_function_output_iterator([&](const auto& entry) { facets.push_back(entry.second); }));
  std::ranges::sort(facets);
}

}  // namespace grit
