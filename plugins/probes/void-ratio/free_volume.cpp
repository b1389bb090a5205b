// Where walls are flat, along the axes, they are cut out. Elsewhere boxes are halved, along edges of cells first, until
// each is no longer cut by a wall or the wall's tangent plane cuts it as the planes of its halves do.
#include "free_volume.hpp"

#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <utility>

#include "free_boxes.hpp"

namespace grit {

namespace {

/// A wall that may cut a box.
struct Near {
  std::size_t wall;
  double reach;  ///< a sphere of this radius about the box's middle touches the wall [m]
  Clearance clearance;
};

using Walls = boost::container::small_vector<Near, 4>;

class Carver {
 public:
  Carver(const World& world, const AveragingCells& cells, double error)
      : world_(world), cells_(cells), error_(error), free_(cells.parts()) {}

  std::vector<double> carve() {
    if (free_.empty()) return {};
    Parts all{{0, 0, 0}, {}};
    for (int k = 0; k < 3; ++k) all.end[index(k)] = cells_.along(k).strips();
    const Box box = box_of(all);
    Walls walls;
    for (std::size_t w = 0; w < world_.walls().size(); ++w) {
      // Whatever has its surface outside of this is no wall of the region.
      reach_ = 2 * box.half_diagonal();
      if (const auto found = world_.clearance(w, box.middle, reach_)) walls.push_back({w, reach_, *found});
    }
    split(all, cut_by(box, walls), walls.size() + 1);
    return std::move(free_);
  }

 private:
  struct Box {
    Vec3 middle, size;
    double half_diagonal() const { return 0.5 * size.norm(); }
    double volume() const { return size.prod(); }
    /// Halves of all sides that are more than half as long as the longest, two to eight boxes.
    auto halves() const {
      boost::container::static_vector<Box, 8> found{*this};
      for (int k = 0; k < 3; ++k) {
        if (size[k] <= 0.5 * size.maxCoeff()) continue;
        const std::size_t before = found.size();
        for (std::size_t i = 0; i < before; ++i) {
          Box lower = found[i];
          lower.size[k] *= 0.5;
          found.push_back(lower);
          found[i].size[k] *= 0.5;
          found[i].middle[k] += 0.25 * size[k], found.back().middle[k] -= 0.25 * size[k];
        }
      }
      return found;
    }
  };
  struct Parts {
    std::array<std::size_t, 3> begin, end;
  };
  /// The walls that may cut a box, unless one has all of it behind.
  struct Cut {
    bool solid = false;
    Walls walls;
  };
  static std::size_t index(int k) { return static_cast<std::size_t>(k); }

  Box box_of(const Parts& parts) const {
    Vec3 low, high;
    for (int k = 0; k < 3; ++k) {
      low[k] = cells_.along(k).edges()[parts.begin[index(k)]];
      high[k] = cells_.along(k).edges()[parts.end[index(k)]];
    }
    return {0.5 * (low + high), high - low};
  }

  /// Of walls that are known from the middle of a box, those that may cut it.
  static Cut cut_by(const Box& box, const Walls& walls) {
    Cut cut;
    const double reach = box.half_diagonal();
    for (const Near& near : walls) {
      if (near.clearance.distance >= reach) continue;
      if (near.clearance.distance <= -reach) return {true, {}};
      cut.walls.push_back(near);
    }
    return cut;
  }

  /// The walls of a box as seen from the middle of one inside of it.
  Cut cut_by(const Box& inner, const Box& box, const Walls& walls) const {
    constexpr double rounding = 1e-9;
    const double moved = (inner.middle - box.middle).norm();
    Walls seen;
    for (const Near& near : walls) {
      // The shorter the reach the cheaper the answer; behind a face its distance may be longer than it seems.
      const double far = (1 + rounding) * (near.reach + moved),
                   close = (1 + rounding) * (std::abs(near.clearance.distance) + moved);
      double reach = std::min(close, far);
      auto found = world_.clearance(near.wall, inner.middle, reach);
      if (!found) found = world_.clearance(near.wall, inner.middle, reach = far);
      if (found) seen.push_back({near.wall, reach, *found});
    }
    return cut_by(inner, seen);
  }

  /// `tried`: so many walls were too many, or of the wrong kind, to be cut out.
  void split(const Parts& parts, const Cut& cut, std::size_t tried) {
    if (cut.solid) return;
    if (!cut.walls.empty() && cut.walls.size() < tried && all_flat(cut)) {
      if (cut_out(parts, cut)) return;
      tried = cut.walls.size();
    }
    const Box box = box_of(parts);
    int longest = -1;
    for (int k = 0; k < 3; ++k)
      if (parts.end[index(k)] - parts.begin[index(k)] > 1 && (longest < 0 || box.size[k] > box.size[longest]))
        longest = k;
    if (cut.walls.empty()) {
      for_each(parts, [&](std::size_t part, const Box& own) { free_[part] = own.volume(); });
    } else if (longest < 0) {
      for_each(parts,
               [&](std::size_t part, const Box&) { free_[part] = box.volume() * (1 - solid_fraction(box, cut)); });
    } else {
      Parts lower = parts, upper = parts;
      lower.end[index(longest)] = upper.begin[index(longest)] =
          parts.begin[index(longest)] + (parts.end[index(longest)] - parts.begin[index(longest)]) / 2;
      split(lower, cut_by(box_of(lower), box, cut.walls), tried);
      split(upper, cut_by(box_of(upper), box, cut.walls), tried);
    }
  }

  bool all_flat(const Cut& cut) const {
    return std::ranges::all_of(cut.walls, [this](const Near& near) { return world_.walls()[near.wall].flat; });
  }

  /// Whether flat walls leave boxes free.
  bool cut_out(const Parts& parts, const Cut& cut) {
    std::vector<std::size_t> walls;
    for (const Near& near : cut.walls) walls.push_back(near.wall);
    const Box box = box_of(parts);
    const auto boxes = free_boxes(world_, {box.middle - 0.5 * box.size, box.middle + 0.5 * box.size}, walls, reach_);
    if (!boxes) return false;
    for (const Region& free : *boxes) add(free);
    return true;
  }
  void add(const Region& free) {
    Parts met;
    for (int k = 0; k < 3; ++k)
      met.begin[index(k)] = cells_.along(k).strip(free.low[k]),
      met.end[index(k)] = cells_.along(k).strip(free.high[k]) + 1;
    for_each(met, [&](std::size_t part, const Box& own) {
      const Vec3 low = free.low.cwiseMax(own.middle - 0.5 * own.size),
                 high = free.high.cwiseMin(own.middle + 0.5 * own.size);
      free_[part] += (high - low).cwiseMax(0.0).prod();
    });
  }

  template <class Visit>
  void for_each(const Parts& parts, const Visit& visit) const {
    for (std::size_t i = parts.begin[0]; i < parts.end[0]; ++i)
      for (std::size_t j = parts.begin[1]; j < parts.end[1]; ++j)
        for (std::size_t k = parts.begin[2]; k < parts.end[2]; ++k)
          visit(cells_.part(i, j, k), box_of({{i, j, k}, {i + 1, j + 1, k + 1}}));
  }

  /// The share of a box that lies behind walls.
  double solid_fraction(const Box& box, const Cut& cut) const {
    if (cut.solid) return 1;
    if (cut.walls.empty()) return 0;
    if (each_along_an_axis(cut) && all_planes(box, cut)) return by_planes(box, cut);
    const auto halves = box.halves();
    boost::container::static_vector<Cut, 8> cuts;
    double by_halves = 0;
    for (const Box& half : halves) {
      cuts.push_back(cut_by(half, box, cut.walls));
      by_halves += by_planes(half, cuts.back());
    }
    const auto count = static_cast<double>(halves.size());
    by_halves /= count;
    const double side = box.size.maxCoeff();
    const double differ = std::abs(by_halves - by_planes(box, cut)) * side;
    const bool as_planes = differ <= error_ && side <= coarsest * error_,
               as_flat_walls = differ <= flattest * error_ && all_planes(box, cut);
    if (as_planes || as_flat_walls || side <= finest * error_) return by_halves;
    double sum = 0;
    for (std::size_t i = 0; i < halves.size(); ++i) sum += solid_fraction(halves[i], cuts[i]);
    return sum / count;
  }

  /// The same as the planes have it that touch the walls where these are closest to the middle. Of several walls each
  /// is taken to leave alike of what others leave, which is so where they meet at right angles along the box.
  double by_planes(const Box& box, const Cut& cut) const {
    if (cut.solid) return 1;
    double open = 1;
    for (const Near& near : cut.walls) {
      const auto& [distance, normal] = near.clearance;
      if (distance >= 0 && !solid_beyond(box, near)) continue;
      open *= share_below(box.size, normal, distance);
    }
    return 1 - open;
  }

  /// Whether shares behind planes are exact: one plane, or planes square to axes of their own.
  static bool each_along_an_axis(const Cut& cut) {
    if (cut.walls.size() == 1) return true;
    constexpr double square = 1e-12;
    std::array<bool, 3> taken{};
    return std::ranges::all_of(cut.walls, [&](const Near& near) {
      Eigen::Index axis = 0;
      return near.clearance.normal.cwiseAbs().maxCoeff(&axis) >= 1 - square &&
             !std::exchange(taken[static_cast<std::size_t>(axis)], true);
    });
  }

  /// Whether walls are planes all over the box: of a flat wall a face is convex, so that its corners tell.
  bool all_planes(const Box& box, const Cut& cut) const {
    return std::ranges::all_of(cut.walls, [&](const Near& near) {
      if (!world_.walls()[near.wall].flat) return false;
      const double rounding = 1e-9 * box.half_diagonal();
      for (const int corner : {0, 1, 2, 3, 4, 5, 6, 7}) {
        const Vec3 way =
            0.5 * box.size.cwiseProduct(Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
        const double distance = near.clearance.distance - near.clearance.normal.dot(way);
        const auto seen = world_.clearance(near.wall, box.middle + way, std::abs(distance) + 2 * rounding);
        if (!seen || std::abs(seen->distance - distance) > rounding) return false;
        if ((seen->normal - near.clearance.normal).norm() > 1e-9) return false;
      }
      return true;
    });
  }

  /// Whether there is solid on the far side of a surface, which there is not of a sheet that has two sides, or beyond
  /// its rim.
  bool solid_beyond(const Box& box, const Near& near) const {
    const auto& [distance, normal] = near.clearance;
    const double depth = 0.02 * box.half_diagonal();
    const auto beyond = world_.clearance(near.wall, box.middle + (distance + depth) * normal, 2 * depth);
    return beyond && beyond->distance < 0;
  }

  // Sides of boxes, over the error; of flat walls, which have no grooves to be missed, and how little halves may
  // differ.
  static constexpr double coarsest = 250, finest = 32, flattest = 1e-3;

  const World& world_;
  const AveragingCells& cells_;
  double error_;
  double reach_ = 0;  ///< that shows all walls of the region [m]
  std::vector<double> free_;
};

}  // namespace

// Scardovelli & Zaleski (2000), J. Comput. Phys. 164, 228, doi:10.1006/jcph.2000.6567.
double share_below(const Vec3& size, const Vec3& normal, double distance) {
  constexpr double flat = 1e-5;  // below it the closed form would cancel; leaving it out costs its square
  Vec3 m = normal.cwiseAbs().cwiseProduct(size);
  m = (m.array() < flat * m.sum()).select(0, m);
  const double from_corner = 0.5 + distance / m.sum();
  m /= m.sum();
  std::sort(m.begin(), m.end());
  if (from_corner <= 0) return 0;
  if (from_corner >= 1) return 1;
  const double a = std::min(from_corner, 1 - from_corner), low = m[0], middle = m[1], high = m[2], two = low + middle;
  const auto past = [a](double edge) { return edge * edge * (edge - 3 * a); };
  double share;
  if (a < low) share = a * a * a / (6 * low * middle * high);
  else if (a < middle) share = a * (a - low) / (2 * middle * high) + low * low / (6 * middle * high);
  else if (a >= two && two <= high) share = (a - 0.5 * two) / high;
  else if (a < high) share = (a * a * (3 * two - a) + past(low) + past(middle)) / (6 * low * middle * high);
  else share = (a * a * (3 - 2 * a) + past(low) + past(middle) + past(high)) / (6 * low * middle * high);
  return from_corner < 0.5 ? share : 1 - share;
}

std::vector<double> free_volumes(const World& world, const AveragingCells& cells, double error) {
  return Carver(world, cells, error).carve();
}

}  // namespace grit
