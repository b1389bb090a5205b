// A box is cut along a face of a wall that is not all of the wall in the box, until there is none.
#include "free_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace grit {

namespace {

constexpr std::size_t most_boxes = 500;

/// A plane across an axis.
struct Face {
  int axis;
  double at;  ///< m
};

class BoxCarver {
 public:
  BoxCarver(const World& world, const Region& box, double reach)
      : world_(world),
        reach_(reach),
        slack_(1e-12 * std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff())) {}

  /// False where that cannot be done.
  bool carve(Region box, const std::vector<std::size_t>& walls) {
    if (++boxes_ > most_boxes) return false;
    for (auto wall = walls.begin(); wall != walls.end(); ++wall) {
      if ((box.high - box.low).minCoeff() <= 16 * slack_) return true;
      const View view(*this, box, *wall);
      if (view.is_out_of_reach() || view.is_before()) continue;
      if (view.is_behind()) return true;
      if (const auto face = view.face_all_over()) {
        (view.middle.normal[face->axis] > 0 ? box.high : box.low)[face->axis] = face->at;
        continue;
      }
      const auto face = view.face_inside();
      if (!face) return false;
      const std::vector<std::size_t> rest(wall, walls.end());
      Region upper = box;
      upper.low[face->axis] = box.high[face->axis] = face->at;
      return carve(box, rest) && carve(upper, rest);
    }
    found_.push_back(box);
    return true;
  }

  std::vector<Region> found() { return std::move(found_); }

 private:
  static constexpr double straight = 1e-12;

  Clearance clearance(std::size_t wall, const Vec3& point) const {
    return world_.clearance(wall, point, reach_)
        .value_or(Clearance{std::numeric_limits<double>::infinity(), Vec3::Zero()});
  }

  /// A wall as it is seen from the middle of a box, and from its corners.
  struct View {
    View(const BoxCarver& carver, const Region& box, std::size_t wall)
        : carver(carver),
          box(box),
          wall(wall),
          centre(0.5 * (box.low + box.high)),
          half(0.5 * (box.high - box.low)),
          middle(carver.clearance(wall, centre)) {
      middle.normal.cwiseAbs().maxCoeff(&axis);
      if (is_out_of_reach()) return;
      // A hair inside: what is right at a corner belongs to more than one face.
      for (std::size_t k = 0; k < corners.size(); ++k) corners[k] = carver.clearance(wall, centre + way_to(k));
    }

    bool is_out_of_reach() const { return middle.distance >= half.norm(); }
    /// Whether all of the box is free: a wall that bulges lies behind its tangent plane, a container's wall shows at
    /// the corners.
    bool is_before() const {
      return middle.normal.cwiseAbs().dot(half) <= middle.distance + carver.slack_ &&
             std::ranges::all_of(corners, [](const Clearance& corner) { return corner.distance > 0; });
    }
    bool is_behind() const {
      return is_along_axis() && half[axis] <= carver.slack_ - middle.distance &&
             std::ranges::all_of(corners, [](const Clearance& corner) { return corner.distance < 0; });
    }
    /// The face that is all of the wall in the box, if there is one: a face is convex, so that the corners tell.
    std::optional<Face> face_all_over() const {
      if (!is_along_axis()) return {};
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (!(std::abs(corners[k].distance - (middle.distance - middle.normal.dot(way_to(k)))) <= carver.slack_) ||
            !((corners[k].normal - middle.normal).norm() <= 1e-9))
          return {};
      return Face{axis, centre[axis] + middle.distance * middle.normal[axis]};
    }
    /// A face that cuts the box, with all of it or a part.
    std::optional<Face> face_inside() const {
      if (const auto face = face_near(centre, middle)) return face;
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (const auto face = face_near(centre + way_to(k), corners[k])) return face;
      return {};
    }

    const BoxCarver& carver;
    const Region& box;
    std::size_t wall;
    Vec3 centre, half;
    Clearance middle;
    int axis = 0;  // that the wall is seen along
    std::array<Clearance, 8> corners{};

   private:
    bool is_along_axis() const { return std::abs(middle.normal[axis]) >= 1 - straight; }
    Vec3 way_to(std::size_t corner) const {
      const Vec3 way = half.array() - 2 * carver.slack_;
      return {corner & 1 ? way.x() : -way.x(), corner & 2 ? way.y() : -way.y(), corner & 4 ? way.z() : -way.z()};
    }
    /// At an edge, or a rim, the faces on both sides of it.
    std::optional<Face> face_near(const Vec3& point, const Clearance& seen) const {
      if (!std::isfinite(seen.distance)) return {};
      const Vec3 on_wall = point + seen.distance * seen.normal;
      for (int k = 0; k < 3; ++k) {
        if (std::abs(seen.normal[k]) <= straight) continue;
        if (!(on_wall[k] > box.low[k] + 4 * carver.slack_ && on_wall[k] < box.high[k] - 4 * carver.slack_)) continue;
        if (is_along(k, on_wall, seen.normal[k])) return Face{k, on_wall[k]};
      }
      return {};
    }
    /// Whether the wall is seen along an axis from a point a little off it along that axis.
    bool is_along(int k, Vec3 point, double normal) const {
      if (std::abs(normal) >= 1 - straight) return true;
      const double off = std::max(1e-3 * half.minCoeff(), 1e5 * carver.slack_);
      point[k] -= std::copysign(off, normal);
      return std::abs(carver.clearance(wall, point).distance - off) <= 1e-6 * off;
    }
  };

  const World& world_;
  double reach_, slack_;  ///< slack: what counts as the same place [m]
  std::size_t boxes_ = 0;
  std::vector<Region> found_;
};

}  // namespace

std::optional<std::vector<Region>> free_boxes(const World& world, const Region& box,
                                              const std::vector<std::size_t>& walls, double reach) {
  BoxCarver carver(world, box, reach);
  if (!carver.carve(box, walls)) return {};
  return carver.found();
}

}  // namespace grit
