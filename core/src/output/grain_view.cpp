#include "output/grain_view.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "grit/error.hpp"
#include "output/group_index.hpp"
#include "output/scale.hpp"
#include "output/strays.hpp"

namespace grit {
namespace {

/// Axes of a view. `away`: sign of the depth axis along the line of sight.
struct Sight {
  int right, up, depth;
  double away;
};

Sight sight(const std::string& view) {
  if (view == "xz") return {0, 2, 1, 1};
  if (view == "xy") return {0, 1, 2, -1};
  if (view == "yz") return {1, 2, 0, -1};
  throw Error("picture: found the view '" + view + "'; allowed are 'xz', 'xy' and 'yz'");
}

using Value = std::function<double(std::uint32_t)>;

/// Sets the meaning of colours in `shown`; returns a function that gives the value of a body.
Value colouring(const SeenBodies& seen, const Sight& look, const std::string& color, GrainView& shown) {
  const Value grey = [](std::uint32_t) { return std::numeric_limits<double>::quiet_NaN(); };
  if (color == "rotation") {
    shown.value = {"rotation", "rad"};
    shown.note = "clockwise +";
    if (seen.rotations.empty()) return grey;
    // A right-handed rotation about the line of sight appears clockwise.
    return [rotations = seen.rotations, look](std::uint32_t i) { return look.away * rotations[i][look.depth]; };
  }
  if (color == "displacement") {
    shown.value = {"displacement", "m"};
    shown.note = shown.horizontal + " +";
    if (seen.displacements.empty()) return grey;
    return [displacements = seen.displacements, look](std::uint32_t i) { return displacements[i][look.right]; };
  }
  if (color == "speed") {
    shown.value = {"speed", "m/s"};
    shown.symmetric = false;
    return [velocities = seen.velocities](std::uint32_t i) { return xyz(velocities[i]).norm(); };
  }
  if (color == "layer" && !seen.layers.empty()) {
    shown.value = {"layer", "1"};
    shown.symmetric = false;
    shown.layers = layer_count;
    return [layers = seen.layers](std::uint32_t i) {
      return layers[i] > 0 ? layers[i] : std::numeric_limits<double>::quiet_NaN();
    };
  }
  if (color == "radius") {
    shown.value = {"radius", "m"};
    shown.symmetric = false;
    return [rows = seen.positions](std::uint32_t i) { return rows[i].w; };
  }
  if (color == "group" && !seen.groups.empty()) {
    shown.value = {"group", "1"};
    shown.symmetric = false;
    shown.layers = static_cast<int>(seen.group_names.size());
    for (std::size_t k = 0; k < seen.group_names.size(); ++k)
      shown.note += (k > 0 ? ", " : "") + std::to_string(k + 1) + ' ' + seen.group_names[k];
    return [groups = seen.groups](std::uint32_t i) { return groups[i] + 1; };
  }
  if (names_a_field(color)) {
    if (!seen.values) {
      shown.value = {color, "1"};
      return grey;
    }
    shown.value = {seen.values->label, seen.values->unit};
    shown.symmetric = seen.values->is_signed;
    return [values = std::span(seen.values->of_bodies)](std::uint32_t i) { return values[i]; };
  }
  throw Error("picture: found the color '" + color +
              "'; allowed are 'rotation', 'displacement', 'speed', 'radius', 'group' and fields of probes");
}

/// Whether each body is no outlier.
std::vector<bool> those_in_sight(std::span<const Row> rows) {
  std::vector<double> positions, diameters;
  for (const Row& row : rows) {
    positions.insert(positions.end(), {row.x, row.y, row.z});
    diameters.push_back(2 * row.w);
  }
  const Fences fences(positions, median(diameters), far_to_draw);
  std::vector<bool> near;
  for (std::size_t i = 0; i < rows.size(); ++i) near.push_back(fences.hold(positions, i) && drawable(rows[i].w));
  return near;
}

/// Appends the section of the triangles with the plane at `depth`.
void cut(std::span<const Vec3> triangles, const Sight& look, double depth, std::vector<Segment>& segments) {
  for (std::size_t first = 0; first + 2 < triangles.size(); first += 3) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto &a = triangles[first + i], &b = triangles[first + (i + 1) % 3];
      const double from = a[look.depth] - depth, to = b[look.depth] - depth;
      if ((from < 0) != (to < 0)) points.push_back(a + (b - a) * (from / (from - to)));
    }
    if (points.size() == 2)
      segments.push_back({points[0][look.right], points[0][look.up], points[1][look.right], points[1][look.up]});
  }
}

}  // namespace

std::vector<Segment> cut_walls(std::span<const std::vector<Vec3>> walls, const std::string& view, double depth) {
  std::vector<Segment> segments;
  for (const auto& wall : walls) cut(wall, sight(view), depth, segments);
  return segments;
}

GrainView grain_view(const SeenBodies& seen, std::span<const std::vector<Vec3>> walls, const std::string& view,
                     const std::string& color) {
  const auto look = sight(view);
  GrainView shown;
  shown.horizontal = "xyz"[look.right];
  shown.vertical = "xyz"[look.up];
  const auto value = colouring(seen, look, color, shown);

  const auto rows = seen.positions;
  const std::vector<bool> near = those_in_sight(rows);
  shown.left_out = static_cast<std::size_t>(std::ranges::count(near, false));
  double low = std::numeric_limits<double>::infinity(), high = -low, radii = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!near[i]) continue;
    radii += rows[i].w;
    low = std::min(low, xyz(rows[i])[look.depth]);
    high = std::max(high, xyz(rows[i])[look.depth]);
  }
  const double mean_diameter = 2 * radii / static_cast<double>(std::max<std::size_t>(1, rows.size() - shown.left_out));
  const double third = high - low < 3 * mean_diameter ? 0 : (high - low) / 3;
  std::vector<std::uint32_t> bodies;
  for (std::uint32_t i = 0; i < rows.size(); ++i)
    if (const double depth = xyz(rows[i])[look.depth]; near[i] && depth >= low + third && depth <= high - third)
      bodies.push_back(i);
  std::ranges::stable_sort(bodies, std::greater(),
                           [&](std::uint32_t i) { return look.away * xyz(rows[i])[look.depth]; });
  for (const auto i : bodies) {
    const auto centre = xyz(rows[i]);
    shown.discs.push_back({centre[look.right], centre[look.up], rows[i].w, value(i)});
  }

  double middle = 0.5 * (low + high);
  if (!(low <= high)) {
    middle = 0.5 * (seen.specimen.low[look.depth] + seen.specimen.high[look.depth]);
  }
  shown.walls = cut_walls(walls, view, middle);
  return shown;
}

GrainView grain_view(const World& world, std::span<const WallShape> walls, const std::string& view,
                     const std::string& color, const BodyValues* values) {
  std::vector<std::vector<Vec3>> where;
  for (const WallView& wall : world.walls()) where.push_back(triangles_of(wall, walls, world.stage()));
  SeenBodies seen{world.positions(), world.velocities(), world.rotations(), world.displacements(), world.specimen()};
  GroupIndex groups;
  if (color == "group") groups = group_index(world);
  seen.groups = groups.of_bodies, seen.group_names = groups.names;
  seen.values = values;
  return grain_view(seen, where, view, color);
}

}  // namespace grit
