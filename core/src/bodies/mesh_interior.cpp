#include "bodies/mesh_interior.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "grit/error.hpp"
#include "grit/toolkit/stl_file.hpp"

namespace grit {
namespace {

using Corner = std::tuple<double, double, double>;

Corner key_of(const Vec3& point) { return {point.x(), point.y(), point.z()}; }

double distance_to_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((point - a).dot(along) / length, 0.0, 1.0) : 0;
  return (point - a - share * along).norm();
}

/// Whether an edge passes a point of the y-z plane on its high-z side: 1 towards high y, −1 towards low y, else 0. The
/// same bits for both triangles of an edge, so that no point is between them.
int crossing(double y, double z, const Vec3& from, const Vec3& to) {
  const bool up = from.y() <= y && to.y() > y, down = to.y() <= y && from.y() > y;
  if (!up && !down) return 0;
  const Vec3 &low = up ? from : to, &high = up ? to : from;
  const double there = low.z() + (y - low.y()) / (high.y() - low.y()) * (high.z() - low.z());
  return there > z ? (up ? 1 : -1) : 0;
}

[[noreturn]] void refuse(const std::string& path, const std::string& found, const std::string& allowed) {
  throw ParameterError({{"region/path", found.starts_with(path) ? found : path + ": " + found, allowed}});
}

}  // namespace

double distance_to_triangle(const Vec3& point, const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 normal = (b - a).cross(c - a);
  const double area = normal.norm();
  const auto is_within = [&](const Vec3& from, const Vec3& to) {
    return normal.dot((to - from).cross(point - from)) >= 0;
  };
  if (area > 0 && is_within(a, b) && is_within(b, c) && is_within(c, a)) return std::abs(normal.dot(point - a)) / area;
  return std::min(
      {distance_to_segment(point, a, b), distance_to_segment(point, b, c), distance_to_segment(point, c, a)});
}

MeshInterior::MeshInterior(const MeshRegion& region) {
  const Stl stl = read_stl(region.path);
  if (!stl.defects.empty()) refuse(region.path, stl.defects.front().found, stl.defects.front().allowed);
  for (const Stl::Facet& facet : stl.facets) triangles_.push_back(facet.corners);
  check_closed(region.path);
  bounds_ = {Vec3::Constant(std::numeric_limits<double>::infinity()),
             Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (Triangle& triangle : triangles_)
    for (Vec3& corner : triangle) {
      corner = region.position + region.scale * corner;
      bounds_.low = bounds_.low.cwiseMin(corner), bounds_.high = bounds_.high.cwiseMax(corner);
    }
  const Vec3 middle = 0.5 * (bounds_.low + bounds_.high);
  for (const auto& [a, b, c] : triangles_) volume_ += (a - middle).dot((b - middle).cross(c - middle)) / 6;
  if (!(std::abs(volume_) > 0)) refuse(region.path, "a surface without an inside", "a surface around a volume");
  volume_ = std::abs(volume_);  // of facets in either order
  sort_into_columns();
}

void MeshInterior::check_closed(const std::string& path) const {
  std::map<std::pair<Corner, Corner>, int> edges;  // how often along it less how often against it
  for (const Triangle& triangle : triangles_)
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner from = key_of(triangle[k]), to = key_of(triangle[(k + 1) % 3]);
      if (from == to) continue;
      if (from < to) ++edges[{from, to}];
      else --edges[{to, from}];
    }
  const auto free = std::ranges::count_if(edges, [](const auto& edge) { return edge.second != 0; });
  if (free > 0)
    refuse(path,
           "a surface that is not closed, with " + std::to_string(free) +
               " edges of which the facets on both sides are not there or differ in their corners or their order",
           "a closed surface; export the file again");
}

void MeshInterior::sort_into_columns() {
  constexpr double most = 512;
  const double wanted = std::clamp(std::sqrt(static_cast<double>(triangles_.size())), 1.0, most);
  count_ = {static_cast<int>(wanted), static_cast<int>(wanted)};
  columns_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]));
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const auto& [a, b, c] = triangles_[i];
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const auto ys = columns(1, low.y(), high.y()), zs = columns(2, low.z(), high.z());
    for (int z = zs[0]; z <= zs[1]; ++z)
      for (int y = ys[0]; y <= ys[1]; ++y)
        columns_[static_cast<std::size_t>(z) * static_cast<std::size_t>(count_[0]) + static_cast<std::size_t>(y)]
            .push_back(static_cast<std::uint32_t>(i));
  }
}

std::array<int, 2> MeshInterior::columns(int axis, double low, double high) const {
  const int count = count_[static_cast<std::size_t>(axis - 1)];
  const double width = (bounds_.high[axis] - bounds_.low[axis]) / count;
  const auto at = [&](double place) {
    const double column = width > 0 ? std::floor((place - bounds_.low[axis]) / width) : 0;
    return static_cast<int>(std::clamp(column, 0.0, static_cast<double>(count - 1)));
  };
  return {at(low), at(high)};
}

bool MeshInterior::holds(const Vec3& centre, double radius) const {
  const auto ys = columns(1, centre.y() - radius, centre.y() + radius),
             zs = columns(2, centre.z() - radius, centre.z() + radius);
  for (int z = zs[0]; z <= zs[1]; ++z)
    for (int y = ys[0]; y <= ys[1]; ++y)
      for (const std::uint32_t i : column(y, z))
        if (distance_to_triangle(centre, triangles_[i]) < radius) return false;
  // The number of times that the surface winds around a line from the centre along x.
  int turns = 0;
  for (const std::uint32_t i : column(columns(1, centre.y(), centre.y())[0], columns(2, centre.z(), centre.z())[0])) {
    const auto& [a, b, c] = triangles_[i];
    const int around = crossing(centre.y(), centre.z(), a, b) + crossing(centre.y(), centre.z(), b, c) +
                       crossing(centre.y(), centre.z(), c, a);
    if (around == 0) continue;
    // Where the line meets the triangle; of a narrow one along x the plane alone is not precise.
    const Vec3 normal = (b - a).cross(c - a);
    const auto [low, high] = std::minmax({a.x(), b.x(), c.x()});
    const double rise = normal.y() * (centre.y() - a.y()) + normal.z() * (centre.z() - a.z());
    const double x = normal.x() != 0 ? std::clamp(a.x() - rise / normal.x(), low, high) : low;
    if (x > centre.x()) turns += around;
  }
  return turns != 0;
}

}  // namespace grit
