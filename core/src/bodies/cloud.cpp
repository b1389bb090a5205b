#include "bodies/cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <utility>

#include "bodies/mesh_interior.hpp"
#include "bodies/regions.hpp"
#include "bodies/size_limits.hpp"
#include "bodies/sizes.hpp"
#include "format/number.hpp"
#include "grit/error.hpp"

namespace grit {

namespace {

constexpr int most_tries = 100'000;  // for one grain
// Of a region, positions outside it are tried in vain, too.
constexpr int most_tries_in_region = 10 * most_tries;

/// Finds free space: grains on cell grids, one grid per factor of two in size.
class Room {
 public:
  Room(const Region& box, const std::array<bool, 3>& periodic, std::span<const double> radii)
      : low_(box.low), size_(box.high - box.low), periodic_(periodic) {
    largest_ = *std::max_element(radii.begin(), radii.end());
    for (const double radius : radii) {
      const std::size_t place = level_of(radius);
      if (place >= levels_.size()) levels_.resize(place + 1);
      levels_[place].largest = std::max(levels_[place].largest, radius);
      ++levels_[place].expected;
    }
    for (auto& level : levels_) lay_out(level);
    grains_.reserve(radii.size());
    next_.reserve(radii.size());
  }

  void add(const Row& grain) {
    Level& level = levels_[level_of(grain.w)];
    std::array<int, 3> cell;
    Vec3 centre = xyz(grain);
    for (int k = 0; k < 3; ++k) {
      if (periodic_[as_index(k)]) centre[k] -= size_[k] * std::floor((centre[k] - low_[k]) / size_[k]);
      cell[as_index(k)] = std::clamp(level.cell(k, centre[k] - low_[k]), 0, level.cells[as_index(k)] - 1);
    }
    auto& first = level.first[level.index(cell[0], cell[1], cell[2])];
    next_.push_back(first);
    first = static_cast<std::int32_t>(grains_.size());
    grains_.push_back({centre[0], centre[1], centre[2], grain.w});
  }

  bool has_room(const Row& grain) const {
    // Most positions are occupied, usually by a grain in the same cell.
    for (const auto& level : levels_)
      if (level.expected > 0 && !free_own_cell(level, grain)) return false;
    for (const auto& level : levels_)
      if (level.expected > 0 && !free_neighbours(level, grain)) return false;
    return true;
  }

 private:
  struct Level {
    double largest = 0;  // radius
    std::size_t expected = 0;
    std::array<int, 3> cells{};
    Vec3 per_length = Vec3::Zero();   // cells per metre
    std::vector<std::int32_t> first;  // grain of each cell; the others follow by next_

    int cell(int axis, double offset) const { return static_cast<int>(std::floor(offset * per_length[axis])); }
    std::size_t index(int x, int y, int z) const {
      return (as_index(z) * as_index(cells[1]) + as_index(y)) * as_index(cells[0]) + as_index(x);
    }
  };

  std::size_t level_of(double radius) const { return static_cast<std::size_t>(std::ilogb(largest_ / radius)); }

  void lay_out(Level& level) const {
    if (level.expected == 0) return;
    // As wide as the grains, but not many more cells than grains.
    const double side = std::max(2 * level.largest, std::cbrt(size_.prod() / static_cast<double>(level.expected)));
    for (int k = 0; k < 3; ++k) {
      level.cells[as_index(k)] = std::max(1, static_cast<int>(size_[k] / side));
      level.per_length[k] = level.cells[as_index(k)] / size_[k];
    }
    level.first.assign(level.index(0, 0, level.cells[2]), -1);
  }

  /// Whether all grains of a list keep clear; `at` is shifted to the image of the list's cell.
  bool free_list(std::int32_t grain, const Vec3& at, double radius) const {
    for (; grain >= 0; grain = next_[as_index(grain)]) {
      const Row& other = grains_[as_index(grain)];
      const double x = other.x - at[0], y = other.y - at[1], z = other.z - at[2], reach = other.w + radius;
      if (x * x + y * y + z * z < reach * reach) return false;
    }
    return true;
  }

  bool free_own_cell(const Level& level, const Row& grain) const {
    const Vec3 at = xyz(grain);
    std::array<int, 3> cell;
    for (int k = 0; k < 3; ++k)
      cell[as_index(k)] = std::clamp(level.cell(k, at[k] - low_[k]), 0, level.cells[as_index(k)] - 1);
    return free_list(level.first[level.index(cell[0], cell[1], cell[2])], at, grain.w);
  }

  bool free_neighbours(const Level& level, const Row& grain) const {
    const double reach = grain.w + level.largest;
    const Vec3 at = xyz(grain);
    std::array<int, 3> from, to;
    for (int k = 0; k < 3; ++k) {
      from[as_index(k)] = level.cell(k, at[k] - low_[k] - reach),
      to[as_index(k)] = level.cell(k, at[k] - low_[k] + reach);
      if (periodic_[as_index(k)]) continue;
      from[as_index(k)] = std::clamp(from[as_index(k)], 0, level.cells[as_index(k)] - 1),
      to[as_index(k)] = std::clamp(to[as_index(k)], 0, level.cells[as_index(k)] - 1);
    }
    // A cell beyond a periodic side is one inside, seen from a position shifted by whole periods.
    Vec3 seen;
    const auto wrap = [&](int axis, int cell) {
      const int cells = level.cells[as_index(axis)];
      const int turns = cell < 0 ? -((cells - 1 - cell) / cells) : cell / cells;
      seen[axis] = turns == 0 ? at[axis] : at[axis] - turns * size_[axis];
      return cell - turns * cells;
    };
    for (int z = from[2]; z <= to[2]; ++z) {
      const int cell_z = wrap(2, z);
      for (int y = from[1]; y <= to[1]; ++y) {
        const int cell_y = wrap(1, y);
        for (int x = from[0]; x <= to[0]; ++x) {
          const int cell_x = wrap(0, x);
          if (!free_list(level.first[level.index(cell_x, cell_y, cell_z)], seen, grain.w)) return false;
        }
      }
    }
    return true;
  }

  Vec3 low_, size_;
  std::array<bool, 3> periodic_;
  double largest_;
  std::vector<Level> levels_;
  std::vector<Row> grains_;
  std::vector<std::int32_t> next_;
};

std::string text(const Region& box) {
  std::ostringstream out;
  out << '(' << box.low.transpose() << ") … (" << box.high.transpose() << ") m";
  return out.str();
}

/// The grains of `others`, and their images, that may overlap a grain in the box with at most this radius. Along
/// wrapped axes no images are needed: free space is searched across these sides anyway.
std::vector<Row> near_box(const Region& box, const Cell& cell, const std::array<bool, 3>& wrapped,
                          std::span<const Row> others, double radius) {
  Vec3 period = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (cell.periodic[as_index(k)] && !wrapped[as_index(k)]) period[k] = cell.high[k] - cell.low[k];
  std::vector<Row> near;
  for (const Row& other : others) {
    const Vec3 reach = Vec3::Constant(other.w + radius);
    for (std::uint8_t image = 0; image < 27; ++image) {
      const std::array<int, 3> turns{image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
      Vec3 centre = xyz(other);
      bool counts = true;
      for (int k = 0; k < 3; ++k) {
        counts = counts && (turns[as_index(k)] == 0 || period[k] > 0);
        centre[k] += turns[as_index(k)] * period[k];
        counts = counts &&
                 (wrapped[as_index(k)] || (centre[k] > box.low[k] - reach[k] && centre[k] < box.high[k] + reach[k]));
      }
      if (counts) near.push_back({centre.x(), centre.y(), centre.z(), other.w});
    }
  }
  return near;
}

}  // namespace

std::array<bool, 3> wrapped_axes(const std::string& source, const Region& box, const Cell& cell) {
  std::array<bool, 3> wrapped;
  for (int k = 0; k < 3; ++k) {
    if (!(box.low[k] < box.high[k]) || !std::isfinite(box.high[k] - box.low[k]))
      throw Error(source + ": the box " + text(box) +
                  " is empty or infinite; its low corner must be below its high corner");
    if (cell.periodic[as_index(k)] && (box.low[k] < cell.low[k] || box.high[k] > cell.high[k]))
      throw Error(source + ": the box " + text(box) + " leaves the periodic cell " + text({cell.low, cell.high}) +
                  "; keep it inside");
    wrapped[as_index(k)] = cell.periodic[as_index(k)] && box.low[k] == cell.low[k] && box.high[k] == cell.high[k];
  }
  return wrapped;
}

std::vector<Row> place_at_random(const Region& box, const Cell& cell, std::vector<double> diameters, Random& random,
                                 std::span<const Row> others, std::optional<int> flat, const CloudShape* shape) {
  const auto wrapped = wrapped_axes("cloud", box, cell);
  if (diameters.empty()) return {};
  std::sort(diameters.begin(), diameters.end(), std::greater<>());
  if (!(0.5 * diameters.back() >= least_body_radius && 0.5 * diameters.front() <= most_body_radius))
    throw Error("cloud: found diameters from " + number(diameters.back()) + " to " + number(diameters.front()) +
                " m; allowed are " + number(2 * least_body_radius) + " to " + number(2 * most_body_radius) +
                " m; are the units right?");
  const Vec3 size = box.high - box.low;
  const std::string what = shape != nullptr ? shape->name : "box",
                    place = (shape != nullptr ? shape->name + " in the box " : "box ") + text(box);
  if (diameters.front() > size.minCoeff()) {
    std::ostringstream out;
    out << "cloud: a grain of diameter " << diameters.front() << " m does not fit into the " << place
        << "; use a larger " << what << " or smaller grains";
    throw Error(out.str());
  }

  std::vector<double> radii;
  for (const double diameter : diameters) radii.push_back(0.5 * diameter);
  const auto in_the_way = near_box(box, cell, wrapped, others, radii.front());
  for (const auto& other : in_the_way) radii.push_back(other.w);
  Room room(box, wrapped, radii);
  for (const auto& other : in_the_way) room.add(other);

  std::vector<Row> placed;
  placed.reserve(diameters.size());
  const auto coordinate = [&](int axis, double radius) {
    if (axis == flat) return 0.5 * (box.low[axis] + box.high[axis]);
    const double margin = wrapped[as_index(axis)] ? 0 : radius;
    const double at = box.low[axis] + margin + random.uniform() * std::max(0.0, size[axis] - 2 * margin);
    return std::min(at, box.high[axis] - margin);
  };
  for (const double diameter : diameters) {
    Row grain;
    grain.w = 0.5 * diameter;
    int tries = 0, outside = 0;
    const auto is_inside = [&] {
      if (shape == nullptr || shape->holds(xyz(grain), grain.w)) return true;
      ++outside;
      return false;
    };
    do {
      if (tries++ == most_tries + outside || tries > most_tries_in_region) {
        double solid = 0;
        for (const auto& one : placed) solid += 4.0 / 3.0 * std::numbers::pi * one.w * one.w * one.w;
        std::ostringstream out;
        out << "cloud: only " << placed.size() << " of " << diameters.size() << " grains fit into the " << place
            << ": solid fraction " << solid / (shape != nullptr ? shape->volume : size.prod())
            << ", no space found for a grain of diameter " << diameter << " m in " << tries - 1
            << " tries; random insertion of equal grains reaches about 0.38: use a larger " << what
            << ", or fewer or smaller grains" << (in_the_way.empty() ? "" : "; bodies of other groups take space, too");
        throw Error(out.str());
      }
      grain.x = coordinate(0, grain.w), grain.y = coordinate(1, grain.w), grain.z = coordinate(2, grain.w);
    } while (!is_inside() || !room.has_room(grain));
    room.add(grain);
    placed.push_back(grain);
  }
  random.shuffle(placed);
  return placed;
}

namespace {

/// A region with the box around it.
struct BoundedShape {
  Region bounds;
  CloudShape shape;
};

BoundedShape shape_of(const BoxRegion& box, const Cell&) {
  return {{box.low, box.high}, {"box", (box.high - box.low).prod(), nullptr}};
}

BoundedShape shape_of(const SphereRegion& sphere, const Cell&) {
  const Vec3 reach = Vec3::Constant(sphere.radius);
  const auto holds = [sphere](const Vec3& centre, double radius) { return contains_sphere(sphere, centre, radius); };
  return {{sphere.centre - reach, sphere.centre + reach},
          {"sphere", 4.0 / 3.0 * std::numbers::pi * sphere.radius * sphere.radius * sphere.radius, holds}};
}

/// Grains cross its ends where these are opposite sides of a periodic cell.
BoundedShape shape_of(const CylinderRegion& cylinder, const Cell& cell) {
  const Vec3 way = cylinder.end - cylinder.start;
  const double length = way.norm();
  const Vec3 axis = way / length;
  const Vec3 reach = cylinder.radius * (Vec3::Ones() - axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  BoundedShape all{{cylinder.start.cwiseMin(cylinder.end) - reach, cylinder.start.cwiseMax(cylinder.end) + reach}, {}};
  const auto wrapped = wrapped_axes("cloud", all.bounds, cell);
  bool endless = false;
  for (int k = 0; k < 3; ++k) endless = endless || (std::abs(way[k]) == length && wrapped[static_cast<std::size_t>(k)]);
  const auto holds = [cylinder, endless](const Vec3& centre, double radius) {
    return contains_sphere(cylinder, endless, centre, radius);
  };
  all.shape = {"cylinder", std::numbers::pi * cylinder.radius * cylinder.radius * length, holds};
  return all;
}

BoundedShape shape_of(const MeshRegion& mesh, const Cell&) {
  const auto inside = std::make_shared<const MeshInterior>(mesh);
  const auto holds = [inside](const Vec3& centre, double radius) { return inside->holds(centre, radius); };
  return {inside->bounds(), {"mesh", inside->volume(), holds}};
}

BoundedShape shape_of(const CloudRegion& region, const Cell& cell) {
  return std::visit(
      [&]<class R>(const R& one) -> BoundedShape {
        if constexpr (std::same_as<R, std::monostate>) throw Error("cloud: no region was chosen");
        else return shape_of(one, cell);
      },
      region.is.value());
}

}  // namespace

std::vector<Row> make_cloud(const CloudSource& cloud, const Cell& cell, Random& random, std::span<const Row> others,
                            std::optional<double> shape_diameter) {
  const auto count = static_cast<std::size_t>(std::max<std::int64_t>(cloud.count, 0));
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();  // of the indices in Room
  if (count + others.size() > most)
    throw Error("cloud: " + std::to_string(count) + " bodies beside " + std::to_string(others.size()) +
                " others; allowed are up to " + std::to_string(most) + " in all");
  const std::optional<int> flat =
      cloud.plane_normal == "none" ? std::nullopt : std::optional(cloud.plane_normal[0] - 'x');
  auto diameters = draw_diameters(cloud.sizes, count, random, shape_diameter);
  if (!cloud.region)
    return place_at_random({*cloud.low, *cloud.high}, cell, std::move(diameters), random, others, flat);
  const auto [bounds, shape] = shape_of(*cloud.region, cell);
  return place_at_random(bounds, cell, std::move(diameters), random, others, flat, shape.holds ? &shape : nullptr);
}

void check_region(const CloudSource& cloud) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  if (cloud.region) shape_of(*cloud.region, {Vec3::Constant(-endless), Vec3::Constant(endless)});
}

}  // namespace grit
