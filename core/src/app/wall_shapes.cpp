#include "app/wall_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace grit {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The axis normal to an unbounded plane; -1 for other shapes.
int endless_across(const Geometry& geometry) {
  const Bounds bounds = geometry.bounds();
  int across = -1, endless = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(bounds.low[axis]) && bounds.low[axis] == bounds.high[axis]) across = axis;
    else if (std::isinf(bounds.low[axis]) && std::isinf(bounds.high[axis])) ++endless;
  }
  return endless == 2 && geometry.triangles().empty() ? across : -1;
}

/// The box to which unbounded planes are clipped for drawing.
Bounds drawn_box(const SceneDescription& scene, const LiveGeometries& geometries, const Bodies& bodies) {
  Bounds box{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
  for (const auto& [name, shape] : geometries.all()) {
    const Geometry& geometry = *shape;
    for (const Vec3& corner : geometry.triangles())
      box.low = box.low.cwiseMin(corner), box.high = box.high.cwiseMax(corner);
    if (const int across = endless_across(geometry); across >= 0) {
      const double position = geometry.bounds().low[across];
      box.low[across] = std::min(box.low[across], position), box.high[across] = std::max(box.high[across], position);
    }
  }
  const auto has_no_extent = [&](int axis) { return !(box.low[axis] < box.high[axis]); };
  for (int axis = 0; axis < 3; ++axis)
    if (const auto& low = scene.domain.low, &high = scene.domain.high;
        has_no_extent(axis) && low && high && std::isfinite((*high - *low)[axis]))
      box.low[axis] = (*low)[axis], box.high[axis] = (*high)[axis];
  if (!has_no_extent(0) && !has_no_extent(1) && !has_no_extent(2)) return box;
  Bounds grains{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    const Vec3 centre = xyz(bodies.position[i]), radius = Vec3::Constant(bodies.position[i].w);
    grains.low = grains.low.cwiseMin(centre - radius), grains.high = grains.high.cwiseMax(centre + radius);
  }
  const double margin = (grains.high - grains.low).maxCoeff();
  for (int axis = 0; axis < 3; ++axis)
    if (has_no_extent(axis)) box.low[axis] = grains.low[axis] - margin, box.high[axis] = grains.high[axis] + margin;
  return box;
}

/// Two triangles, counter-clockwise as seen from the bodies.
std::vector<Vec3> rectangle(const Geometry& plane, int across, const Bounds& box) {
  const int u = (across + 1) % 3, v = (across + 2) % 3;
  const auto corner = [&](bool far_u, bool far_v) {
    Vec3 at;
    at[across] = plane.bounds().low[across];
    at[u] = (far_u ? box.high : box.low)[u], at[v] = (far_v ? box.high : box.low)[v];
    return at;
  };
  Vec3 a = corner(false, false), b = corner(true, false), c = corner(true, true), d = corner(false, true);
  if (plane.normal()[across] < 0) std::swap(b, d);
  if (!(a.allFinite() && c.allFinite())) return {};
  return {a, b, c, a, c, d};
}

}  // namespace

std::vector<WallShape> wall_shapes(const Scene& scene, LiveGeometries geometries, const Bodies& bodies) {
  const SceneDescription& start = *scene.description;
  const bool has_endless =
      std::ranges::any_of(geometries.all(), [](const auto& shape) { return endless_across(*shape.second) >= 0; });
  const Bounds box = has_endless ? drawn_box(start, geometries, bodies) : Bounds{Vec3::Zero(), Vec3::Zero()};
  const auto triangles = [&](const Geometry& geometry) {
    const int across = endless_across(geometry);
    return across >= 0 && has_endless ? rectangle(geometry, across, box) : geometry.triangles();
  };
  struct Drawn {
    std::shared_ptr<const Geometry> geometry;
    std::vector<Vec3> first;
  };
  std::map<std::string, Drawn> drawn;
  std::map<std::string, std::vector<WallShape>> shapes;
  for (const auto& [name, geometry] : geometries.all()) {
    drawn[name] = {geometry, triangles(*geometry)};
    shapes[name] = {{.name = name, .triangles = drawn[name].first, .clipped = endless_across(*geometry) >= 0}};
  }
  CurrentScene current(start, scene.stages);
  for (const StageDescription& stage : start.stages) {
    current.begin_stage();
    geometries.follow(current.now());
    for (const auto& [name, geometry] : geometries.all()) {
      const Drawn& at_first = drawn.at(name);
      if (geometry == at_first.geometry) continue;
      if (auto now = triangles(*geometry); now != at_first.first)
        shapes[name].push_back({name, std::move(now), stage.name, endless_across(*geometry) >= 0});
    }
  }
  std::vector<WallShape> all;
  for (auto& [name, own] : shapes) std::ranges::move(own, std::back_inserter(all));
  return all;
}

}  // namespace grit
