// Merging of corners, and the distance at which it closes a surface.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "grit/vec.hpp"

namespace grit {

/// Numbers points. A point that is no further than `distance` from an earlier one gets the number of that one.
class Weld {
 public:
  explicit Weld(double distance) : distance_(distance) {}

  std::uint32_t number(const Vec3& point);
  /// The first point of each number.
  const std::vector<Vec3>& points() const { return points_; }

 private:
  using Cell = std::array<double, 3>;
  Cell cell(const Vec3& point) const;
  std::optional<std::uint32_t> close_to(const Vec3& point) const;

  double distance_;
  std::vector<Vec3> points_;
  std::map<std::tuple<double, double, double>, std::uint32_t> exact_;
  std::map<Cell, std::vector<std::uint32_t>> cells_;  // of side distance_
};

using Segment = std::array<Vec3, 2>;

/// The smallest distance, rounded up to two digits, at which merging the ends of `free` edges leaves none free; nothing
/// if none below the shortest of `all` edges does. Each edge of `all` then belongs to two facets, or to more if
/// `crowded`.
std::optional<double> closing_distance(std::span<const Segment> free, std::span<const Segment> all, bool crowded);

}  // namespace grit
