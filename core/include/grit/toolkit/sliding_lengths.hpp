// Along how much of a wall a specimen slides on it, and along how much it shears in itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/parameters.hpp"
#include "grit/probe.hpp"
#include "grit/toolkit/specimen.hpp"
#include "grit/toolkit/wall_names.hpp"

namespace grit {

/// Tells the two from displacements along the wall of points next to it, be they bodies or parts of a picture.
class SlidingLengths {
 public:
  std::string wall, driven_by;
  double strip = 1, reach = 1;  ///< mean diameters
  double share = 0.5;

  void declare(Parameters& p) {
    p.add("wall", wall).required().doc("along which the specimen slides, or not");
    p.add("driven_by", driven_by).required().doc("wall whose displacement relative to that one is all of it");
    p.add("strip", strip)
        .at_least(0.1)
        .doc("length of the strips of the wall that are told apart, over the mean diameter");
    p.add("reach", reach)
        .above(0)
        .doc("points count that are nearer than this to the specimen's face, or behind it, over the mean diameter");
    p.add("share", share)
        .above(0)
        .below(1)
        .doc("of the displacement of `driven_by`: a strip slides whose points have gone further than that");
  }
  /// `right` and `up` are the axes of the plane that is looked at. Throws Error, beginning with `who`, for a wall that
  /// does not exist or that is not perpendicular to one of them.
  void prepare(const World& world, int right, int up, const std::string& who) {
    wall_ = wall_index(world, wall, who + ", /sliding/wall");
    driver_ = wall_index(world, driven_by, who + ", /sliding/driven_by");
    const Vec3& normal = world.walls()[wall_].normal;
    if (!(normal.cwiseAbs().maxCoeff(&across_) > 1 - 1e-9) || (across_ != right && across_ != up))
      throw Error(who + ", /sliding/wall: wall \"" + wall + "\" is not perpendicular to " + "xyz"[right] + " or " +
                  "xyz"[up] + ", the plane that the probe looks at; name another wall, or another depth_axis");
    along_ = across_ == right ? up : right;
  }
  int along() const { return along_; }  ///< 0, 1, 2: x, y, z
  int across() const { return across_; }

  /// Where both walls are along the wall, from which displacements count [m]; 0: as they were when the stage began.
  struct Start {
    double wall = 0, driver = 0;
  };
  Start now(const World& world) const {
    return {world.walls()[wall_].stage_position[along_], world.walls()[driver_].stage_position[along_]};
  }
  struct Point {
    double along, across;  ///< where it is now [m]
    double moved;          ///< along the wall since the start [m]
  };
  /// m; NaN before `driven_by` has moved.
  struct Lengths {
    double on_surface, internal;
    double contact_factor() const { return on_surface / (on_surface + internal); }
  };
  /// Strips without a point are neither.
  Lengths of(const World& world, std::span<const Point> points, const Start& start) const {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const Start at = now(world);
    const double moved = at.wall - start.wall, driven = at.driver - start.driver - moved;
    const Region box = specimen_box(world);
    const double diameter = world.mean_diameter(), length = box.high[along_] - box.low[along_];
    const double strips = std::max(1.0, std::round(length / (strip * diameter)));
    if (driven == 0 || !(diameter > 0) || !(length > 0) || !(strips < 1e7)) return {unknown, unknown};
    const bool below = world.walls()[wall_].normal[across_] > 0;
    const double face = (below ? box.low : box.high)[across_];
    struct Sum {
      double moved = 0, count = 0;
    };
    std::vector<Sum> sums(static_cast<std::size_t>(strips));
    for (const Point& point : points) {
      const double above = below ? point.across - face : face - point.across;
      const double place = (point.along - box.low[along_]) / length;
      if (!std::isfinite(point.moved) || !(above < reach * diameter) || !(place >= 0 && place < 1)) continue;
      Sum& sum = sums[static_cast<std::size_t>(place * strips)];
      sum.moved += point.moved, ++sum.count;
    }
    Lengths found{0, 0};
    for (const Sum& sum : sums) {
      if (sum.count == 0) continue;
      const double slip = sum.moved / sum.count - moved;
      (slip / driven > share ? found.on_surface : found.internal) += length / strips;
    }
    return found;
  }

  static std::vector<Channel> channels() {
    const std::string since = "; NaN before the driving wall has moved, in this stage";
    return {{"surface_length", "m", "b_w of EN 1991-4: of the wall along which the specimen slides on it" + since, {}},
            {"internal_length", "m", "b_i: along which it stays at the wall and shears in itself" + since, {}},
            {"contact_factor", "1", "a_w = b_w / (b_w + b_i)" + since, {}}};
  }
  static void fill(const Lengths& lengths, std::span<const std::span<double>> values) {
    values[0][0] = lengths.on_surface, values[1][0] = lengths.internal, values[2][0] = lengths.contact_factor();
  }

 private:
  std::size_t wall_ = 0, driver_ = 0;
  int along_ = 0, across_ = 2;
};

}  // namespace grit
