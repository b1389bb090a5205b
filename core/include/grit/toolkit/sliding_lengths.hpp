// Lengths of a wall along which a specimen slides on it and along which it shears internally.
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

/// Finds both lengths from the displacements of points near the wall: bodies, or patches of a picture.
class SlidingLengths {
 public:
  std::string wall, driven_by;
  double strip = 1, max_distance = 1;  ///< mean diameters
  double min_fraction = 0.5;

  void declare(Parameters& p) {
    p.add("wall", wall).required().doc("wall along which the specimen may slide");
    p.add("driven_by", driven_by)
        .required()
        .doc("moving wall, whose displacement relative to `wall` is the whole displacement");
    p.add("strip", strip)
        .at_least(0.1)
        .doc("length of the strips into which the wall is divided, over the mean diameter");
    p.add("max_distance", max_distance)
        .above(0)
        .doc(
            "maximum distance of points from the specimen's face, over the mean diameter; points behind the face "
            "count");
    p.add("min_fraction", min_fraction)
        .above(0)
        .below(1)
        .doc("fraction of the displacement of `driven_by` above which a strip counts as sliding");
  }
  /// `right` and `up` are the axes of the observed plane, `key` is the parameter that holds this object. Throws
  /// ParameterError for a wall that does not exist or is not perpendicular to one of the axes.
  void prepare(const World& world, int right, int up, const std::string& key) {
    wall_ = wall_index(world, wall, key + "/wall");
    driver_ = wall_index(world, driven_by, key + "/driven_by");
    const Vec3& normal = world.walls()[wall_].normal;
    if (!(normal.cwiseAbs().maxCoeff(&across_) > 1 - 1e-9) || (across_ != right && across_ != up))
      throw ParameterError({{key + "/wall", "wall \"" + wall + '"',
                             std::string("a wall perpendicular to ") + "xyz"[right] + " or " + "xyz"[up] +
                                 ", the axes of the probe's plane; name another wall, or another depth_axis"}});
    along_ = across_ == right ? up : right;
  }
  int along() const { return along_; }  ///< 0, 1, 2: x, y, z
  int across() const { return across_; }

  /// Positions of both walls along the wall from which displacements count [m]; 0: those at the start of the stage.
  struct Start {
    double wall = 0, driver = 0;
  };
  Start now(const World& world) const {
    return {world.walls()[wall_].stage_position[along_], world.walls()[driver_].stage_position[along_]};
  }
  /// A point of the wall along which the bodies slide.
  struct Point {
    double along, across;  ///< present position [m]
    double moved;          ///< displacement along the wall since the start [m]
  };
  /// Both lengths [m]; NaN before `driven_by` has moved.
  struct Lengths {
    double on_surface, internal;
    double contact_factor() const { return on_surface / (on_surface + internal); }
  };
  /// Strips without points count for neither length.
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
      if (!std::isfinite(point.moved) || !(above < max_distance * diameter) || !(place >= 0 && place < 1)) continue;
      Sum& sum = sums[static_cast<std::size_t>(place * strips)];
      sum.moved += point.moved, ++sum.count;
    }
    Lengths found{0, 0};
    for (const Sum& sum : sums) {
      if (sum.count == 0) continue;
      const double slip = sum.moved / sum.count - moved;
      (slip / driven > min_fraction ? found.on_surface : found.internal) += length / strips;
    }
    return found;
  }

  static std::vector<Channel> channels() {
    const std::string since = "; NaN before the driving wall has moved in this stage";
    return {{"surface_length", "m", "b_w of EN 1991-4: length along which the specimen slides on the wall" + since, {}},
            {"internal_length", "m", "b_i: length along which it sticks to the wall and shears internally" + since, {}},
            {"contact_factor", "1", "a_w = b_w / (b_w + b_i)" + since, {}}};
  }
  static void fill(const Lengths& lengths, ChannelValues& values) {
    values["surface_length"] = lengths.on_surface;
    values["internal_length"] = lengths.internal;
    values["contact_factor"] = lengths.contact_factor();
  }

 private:
  std::size_t wall_ = 0, driver_ = 0;
  int along_ = 0, across_ = 2;
};

}  // namespace grit
