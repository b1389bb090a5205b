// The order of bodies along a space-filling curve, and what grids of cells are made of.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "bodies/bodies.hpp"
#include "grit/world.hpp"
#include "threads/team.hpp"

namespace grit {

/// All chunks of so many bodies.
std::vector<std::uint32_t> all_chunks(std::size_t bodies);

/// Radii and centres of some bodies.
struct Extent {
  double smallest = std::numeric_limits<double>::max(), largest = 0;  ///< radii [m]
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;

  void add(const Extent& other) {
    smallest = std::min(smallest, other.smallest), largest = std::max(largest, other.largest);
    low = low.cwiseMin(other.low), high = high.cwiseMax(other.high);
  }
  /// Extends it over the whole cell along periodic axes.
  void take_periods(const Cell& cell);
};
Extent extent(const Bodies& bodies, std::span<const std::uint32_t> chunks, Team& team);

/// Number of cells along each axis: of at least `width`, but not many more than bodies, even if a body is far away.
std::array<int, 3> grid_size(const Vec3& length, double width, std::size_t bodies);

/// A body on a Morton curve through cells of about the largest diameter.
struct CurvePlace {
  std::uint64_t key = 0;
  std::uint32_t id = 0, body = 0;
  // Ids break ties, so that the order depends on positions only and not on the history.
  bool operator<(const CurvePlace& other) const { return key != other.key ? key < other.key : id < other.id; }
};

class Curve {
 public:
  /// Through the extent of so many bodies.
  Curve(const Extent& box, std::size_t bodies);
  CurvePlace place(const Bodies& bodies, std::size_t body) const {
    return {key(xyz(bodies.position[body])), bodies.id[body], static_cast<std::uint32_t>(body)};
  }
  /// Of the largest key.
  int bits() const;

 private:
  std::uint64_t key(const Vec3& x) const;

  Vec3 low_, length_;
  std::array<int, 3> size_;
};
/// Sorts places of a curve.
void sort_along(const Curve& curve, std::vector<CurvePlace>& places, Team& team);

/// The order of bodies along the curve.
std::vector<std::uint32_t> spatial_order(const Bodies& bodies, const Cell& cell, Team& team);

}  // namespace grit
