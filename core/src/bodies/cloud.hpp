// Grains at random positions without overlaps.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bodies/random.hpp"
#include "description/description.hpp"
#include "grit/world.hpp"

namespace grit {

/// The periodic axes of the cell that a box spans. Throws grit::Error, beginning with the name of the source, for a box
/// that is empty or leaves a periodic cell.
std::array<bool, 3> wrapped_axes(const std::string& source, const Region& box, const Cell& cell);

/// The part of a box that a cloud fills.
struct CloudShape {
  std::string name;                                              ///< for messages
  double volume = 0;                                             ///< m³
  std::function<bool(const Vec3& centre, double radius)> holds;  ///< whether a grain is inside
};

/// Inserts a grain of each diameter [m] into the box by random sequential insertion, the largest first. Returns centres
/// [m], w: radius [m], in random order. Grains are inside the box; where it spans a periodic axis of the cell they may
/// extend across its sides and do not overlap the images on the other side. They do not overlap `others` (centre, w:
/// radius; anywhere) and their images. `flat`: all centres are in the middle plane of the box normal to this axis.
/// `shape`: grains are inside this part of the box.
/// Identical results for identical arguments. Throws grit::Error if there is no space within a hundred thousand tries
/// (with the count and solid fraction reached), for a grain larger than the box, and for a box that is empty or leaves
/// a periodic cell.
std::vector<Row> place_at_random(const Region& box, const Cell& cell, std::vector<double> diameters, Random& random,
                                 std::span<const Row> others = {}, std::optional<int> flat = {},
                                 const CloudShape* shape = nullptr);

/// The grains of a description; `shape_diameter` as for draw_diameters(). Throws grit::Error as place_at_random() does,
/// and for a mesh that cannot be used.
std::vector<Row> make_cloud(const CloudSource& cloud, const Cell& cell, Random& random,
                            std::span<const Row> others = {}, std::optional<double> shape_diameter = {});

/// Throws as make_cloud() does for a region that cannot be used.
void check_region(const CloudSource& cloud);

}  // namespace grit
