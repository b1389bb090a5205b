// Averages over overlapping cells. The edges of all cells divide a region into parts. Each body and each contact is
// distributed once over the few parts that it intersects; a cell is the sum of its parts.
#pragma once

#include <algorithm>
#include <array>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/probe.hpp"
#include "grit/toolkit/specimen.hpp"

namespace grit {

/// Overlapping cells along one axis, and the strips between neighbouring cell edges.
class CellAxis {
 public:
  /// As many cells of `size` at a spacing of `step` as fit between `low` and `high`, centred; one cell from `low` to
  /// `high` if that is shorter than `size`. All in m.
  CellAxis(double low, double high, double size, double step) {
    constexpr double slack = 1e-9;  // of a step: edges this close count as one
    const double length = high - low;
    size = std::min(size, length), step = std::min(step, length);
    const auto more = static_cast<std::size_t>(std::floor((length - size) / step + slack));
    const double start = low + 0.5 * (length - size - static_cast<double>(more) * step);
    for (std::size_t i = 0; i <= more; ++i) {
      const double from = start + static_cast<double>(i) * step;
      cells_.push_back({from, from + size, 0, 0});
      edges_.push_back(from), edges_.push_back(from + size);
    }
    std::sort(edges_.begin(), edges_.end());
    const auto same = [&](double a, double b) { return b - a < slack * step; };
    edges_.erase(std::unique(edges_.begin(), edges_.end(), same), edges_.end());
    const auto edge = [&](double x) {
      return static_cast<std::size_t>(std::lower_bound(edges_.begin(), edges_.end(), x - slack * step) -
                                      edges_.begin());
    };
    for (auto& cell : cells_) cell.begin = edge(cell.low), cell.end = edge(cell.high);
    own_ = more == 0 ? size : std::min(size, step);
  }

  /// An averaging cell along this axis.
  struct Cell {
    double low, high;        ///< m
    std::size_t begin, end;  ///< its strips, end excluded
  };
  const std::vector<Cell>& cells() const { return cells_; }
  std::size_t strips() const { return edges_.size() - 1; }
  /// Edges of the strips [m], ascending; strip i lies between edge i and edge i + 1.
  const std::vector<double>& edges() const { return edges_; }
  /// Length of a cell that does not overlap the next one; all of it if there is only one cell [m].
  double own() const { return own_; }
  /// The strip that contains x, low edge included; the nearest strip for x outside.
  std::size_t strip(double x) const {
    const auto above = std::upper_bound(edges_.begin(), edges_.end(), x) - edges_.begin();
    return static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(strips()) - 1));
  }
  /// The same, searched upwards from strip `from`.
  std::size_t strip(double x, std::size_t from) const {
    while (from + 1 < strips() && edges_[from + 1] <= x) ++from;
    return from;
  }

 private:
  std::vector<Cell> cells_;
  std::vector<double> edges_;
  double own_ = 0;
};

/// Cells of a region along all three axes, and the parts into which their edges divide it. Both are numbered with z
/// running fastest.
class AveragingCells {
 public:
  static constexpr double most_parts = 8e6;

  /// Cells of `size` at a spacing of `step` along x, y, z [m]; an infinite size is that of the region. No cells if the
  /// region has no volume, if a size is not above 0 (without bodies the mean diameter is 0), or if there would be more
  /// than `most_parts` parts. Periodic images are those of `domain`.
  AveragingCells(const Cell& domain, const Region& region, const Vec3& size, const Vec3& step) : domain_(domain) {
    if (!(region.volume() > 0) || !std::isfinite(region.volume())) return;
    if (!(size.minCoeff() > 0 && step.minCoeff() > 0)) return;
    if (!(most_parts_of(region, size, step) <= most_parts)) return;
    axes_.reserve(3);
    for (int k = 0; k < 3; ++k) {
      axes_.emplace_back(region.low[k], region.high[k], size[k], step[k]);
      inner_.low[k] = axes_[axis(k)].edges().front(), inner_.high[k] = axes_[axis(k)].edges().back();
    }
  }

  /// Upper bound of the number of parts: each cell has two edges along an axis.
  static double most_parts_of(const Region& region, const Vec3& size, const Vec3& step) {
    double parts = 1;
    for (int k = 0; k < 3; ++k) {
      const double length = region.high[k] - region.low[k];
      parts *= 1 + 2 * std::max(0.0, (length - std::min(size[k], length)) / step[k]);
    }
    return parts;
  }

  std::size_t parts() const { return axes_.empty() ? 0 : strips(0) * strips(1) * strips(2); }
  std::size_t cells() const {
    return axes_.empty() ? 0 : axes_[0].cells().size() * axes_[1].cells().size() * axes_[2].cells().size();
  }
  const CellAxis& along(int k) const { return axes_[axis(k)]; }
  std::size_t part(std::size_t i, std::size_t j, std::size_t k) const { return (i * strips(1) + j) * strips(2) + k; }
  /// The box of cell n.
  Region cell(std::size_t n) const {
    Region box;
    for (int k = 2; k >= 0; --k) {
      const auto& cells = axes_[axis(k)].cells();
      box.low[k] = cells[n % cells.size()].low, box.high[k] = cells[n % cells.size()].high;
      n /= cells.size();
    }
    return box;
  }
  /// Size of a cell that does not overlap the next ones [m]: the size to draw on a map.
  Vec3 own() const { return {axes_[0].own(), axes_[1].own(), axes_[2].own()}; }

  /// Calls visit(part, volume) for each part that a sphere may intersect, with the volume [m³] of the intersection;
  /// error below 1e-12 of the sphere's volume.
  template <class Visit>
  void share_out_sphere(const Vec3& centre, double radius, const Visit& visit) const {
    const Vec3 reach = Vec3::Constant(radius);
    each_image(centre, -reach, reach, [&](const Vec3& place) {
      std::array<std::size_t, 3> first, count;
      for (int k = 0; k < 3; ++k)
        first[axis(k)] = along(k).strip(place[k] - radius),
        count[axis(k)] = along(k).strip(place[k] + radius, first[axis(k)]) - first[axis(k)] + 1;
      const auto [x, y, z] = first;
      // Cumulative volumes over all parts up to one: fewer planes cut them than the parts.
      Volumes volumes;
      for (std::size_t i = 1; i <= count[0]; ++i)
        for (std::size_t j = 1; j <= count[1]; ++j)
          for (std::size_t k = 1; k <= count[2]; ++k)
            volumes.push_back(sphere_box_volume(place, radius, corner(x, y, z), corner(x + i, y + j, z + k)));
      // Differences along one axis after the other, from the end, give the volume of each part.
      std::size_t apart = 1;
      for (int axis_of = 2; axis_of >= 0; --axis_of) {
        const std::size_t line = apart * count[axis(axis_of)];
        for (std::size_t start = 0; start < volumes.size(); start += line)
          for (std::size_t n = start + line; n-- > start + apart;) volumes[n] -= volumes[n - apart];
        apart = line;
      }
      const double rounding = 1e-14 * radius * radius * radius;  // volumes below this are 0
      std::size_t n = 0;
      for (std::size_t i = 0; i < count[0]; ++i)
        for (std::size_t j = 0; j < count[1]; ++j)
          for (std::size_t k = 0; k < count[2]; ++k, ++n)
            visit(part(x + i, y + j, z + k), volumes[n] > rounding ? volumes[n] : 0);
    });
  }

  /// Calls visit(part, from, to) for the piece of a branch in each part; from and to are 0 at its start, 1 at its end.
  template <class Visit>
  void share_out_branch(const Branch& branch, const Visit& visit) const {
    const Vec3 zero = Vec3::Zero();
    Cuts cuts;
    each_image(branch.start, branch.vector.cwiseMin(zero), branch.vector.cwiseMax(zero), [&](const Vec3& start) {
      double from = 0, to = 1;
      for (int k = 0; k < 3; ++k) {
        if (branch.vector[k] == 0) {
          if (!(start[k] >= inner_.low[k] && start[k] < inner_.high[k])) return;
          continue;
        }
        const double low = (inner_.low[k] - start[k]) / branch.vector[k],
                     high = (inner_.high[k] - start[k]) / branch.vector[k];
        from = std::max(from, std::min(low, high)), to = std::min(to, std::max(low, high));
      }
      if (!(to > from)) return;
      cuts.assign({from, to});
      for (int k = 0; k < 3; ++k) cut(along(k), start[k], branch.vector[k], from, to, cuts);
      std::sort(cuts.begin(), cuts.end());
      for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
        visit(part_at(start + 0.5 * (cuts[i] + cuts[i + 1]) * branch.vector), cuts[i], cuts[i + 1]);
    });
  }

  /// Calls visit(part) for the part that contains a point, if there is one.
  template <class Visit>
  void place(const Vec3& point, const Visit& visit) const {
    const Vec3 zero = Vec3::Zero();
    each_image(point, zero, zero, [&](const Vec3& image) {
      if ((image.array() >= inner_.low.array()).all() && (image.array() < inner_.high.array()).all())
        visit(part_at(image));
    });
  }

  /// The sum of the parts of each cell. `Sums` is zero on construction and has +=.
  template <class Sums>
  std::vector<Sums> sum_up(const std::vector<Sums>& of_parts) const {
    // One axis after the other: the cost per cell is the sum of the numbers of strips, not their product.
    std::vector<Sums> sums = of_parts;
    std::size_t slower = 1, faster = of_parts.size();
    for (const CellAxis& axis : axes_) {
      faster /= axis.strips();
      std::vector<Sums> next(slower * axis.cells().size() * faster);
      for (std::size_t s = 0; s < slower; ++s)
        for (std::size_t c = 0; c < axis.cells().size(); ++c)
          for (std::size_t i = axis.cells()[c].begin; i < axis.cells()[c].end; ++i)
            for (std::size_t f = 0; f < faster; ++f)
              next[(s * axis.cells().size() + c) * faster + f] += sums[(s * axis.strips() + i) * faster + f];
      sums = std::move(next);
      slower *= axis.cells().size();
    }
    return sums;
  }

 private:
  static std::size_t axis(int k) { return static_cast<std::size_t>(k); }
  std::size_t strips(int k) const { return along(k).strips(); }
  Vec3 corner(std::size_t i, std::size_t j, std::size_t k) const {
    return {axes_[0].edges()[i], axes_[1].edges()[j], axes_[2].edges()[k]};
  }
  std::size_t part_at(const Vec3& point) const {
    return part(along(0).strip(point[0]), along(1).strip(point[1]), along(2).strip(point[2]));
  }

  /// Calls visit(image) for each periodic image of `place` for which image + low … image + high may intersect the
  /// cells. None for positions that are not finite, as in a failed run.
  template <class Visit>
  void each_image(const Vec3& place, const Vec3& low, const Vec3& high, const Visit& visit) const {
    if (axes_.empty() || !(place + low).allFinite() || !(place + high).allFinite()) return;
    if (domain_.skewed())
      return domain_.each_image(place + low, place + high, inner_.low, inner_.high,
                                [&](const Vec3& shift) { visit(Vec3(place + shift)); });
    std::array<int, 3> least, most;
    Vec3 period = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const double before = inner_.low[k] - place[k] - high[k], after = inner_.high[k] - place[k] - low[k];
      if (domain_.periodic[axis(k)]) {
        period[k] = domain_.high[k] - domain_.low[k];
        least[axis(k)] = static_cast<int>(std::ceil(before / period[k])),
        most[axis(k)] = static_cast<int>(std::floor(after / period[k]));
      } else {
        least[axis(k)] = 0, most[axis(k)] = before <= 0 && after >= 0 ? 0 : -1;
      }
    }
    for (int i = least[0]; i <= most[0]; ++i)
      for (int j = least[1]; j <= most[1]; ++j)
        for (int k = least[2]; k <= most[2]; ++k) visit(place + Vec3(i * period[0], j * period[1], k * period[2]));
  }

  using Volumes = boost::container::small_vector<double, 27>;
  using Cuts = boost::container::small_vector<double, 16>;
  /// Appends the points between `from` and `to` where a branch crosses edges of strips.
  static void cut(const CellAxis& axis, double start, double way, double from, double to, Cuts& cuts) {
    if (way == 0) return;
    const double one = start + from * way, other = start + to * way, high = std::max(one, other);
    for (std::size_t edge = axis.strip(std::min(one, other)) + 1; edge < axis.strips() && axis.edges()[edge] < high;
         ++edge)
      cuts.push_back(std::clamp((axis.edges()[edge] - start) / way, from, to));
  }

  Cell domain_;
  Region inner_{Vec3::Zero(), Vec3::Zero()};  // box of all cells; may be smaller than the region
  std::vector<CellAxis> axes_;                // three, or none
};

/// Parameters of a probe that averages over cells and over the slices of a profile.
class Averaging {
 public:
  std::optional<Vec3> region_low, region_high;  ///< m
  double cell_size = 5, cell_step = 1;          ///< mean diameters
  std::string depth_axis;
  std::string along = "z";
  std::int64_t slices = 20;

  /// `sides`: default of the region's sides, for the documentation.
  void declare(Parameters& p, const std::string& sides) {
    p.add("region_low", region_low).unit("m").doc("lower corner of the averaged region; default: " + sides);
    p.add("region_high", region_high).unit("m").doc("upper corner of the averaged region; default: " + sides);
    p.add("cell_size", cell_size).at_least(0.1).doc("side of an averaging cell over the mean diameter");
    p.add("cell_step", cell_step).at_least(0.1).doc("spacing of averaging cells over the mean diameter");
    p.add("depth_axis", depth_axis)
        .one_of({"", "x", "y", "z"})
        .doc("axis along which a cell extends through the whole region; empty: cells are cubes");
    p.add("along", along).one_of({"x", "y", "z"}).doc("axis of the profile");
    p.add("slices", slices)
        .at_least(1)
        .at_most(10000)
        .doc("number of slices of equal thickness of the profile across the region");
    p.check(
        [this](const Complain& complain) {
          if (!region_low || !region_high) return;
          for (int k = 0; k < 3; ++k)
            if (!((*region_low)[k] < (*region_high)[k]))
              complain("region_high", std::string() + "xyz"[k] + " = " + std::to_string((*region_high)[k]) + " m",
                       "above that of region_low, " + std::to_string((*region_low)[k]) + " m");
        },
        {"region_low", "region_high"});
  }

  /// The region; `box` for a corner that is not given.
  Region region(Region box) const {
    box.low = region_low.value_or(box.low), box.high = region_high.value_or(box.high);
    return box;
  }
  /// No cells if there would be too many; see check_cells().
  AveragingCells cells(const World& world, const Region& box) const {
    return {world.cell(), box, size_of_cells(world), Vec3::Constant(cell_step * world.mean_diameter())};
  }
  /// Throws ParameterError, of the parameter at `key`, if there would be more parts than AveragingCells::most_parts.
  void check_cells(const World& world, const Region& box, const std::string& key = "cell_step") const {
    constexpr double most = AveragingCells::most_parts;
    const double diameter = world.mean_diameter();
    if (!(diameter > 0) || !(box.volume() > 0) || !(box.high - box.low).allFinite()) return;
    const auto parts = [&](double step) {
      return AveragingCells::most_parts_of(box, size_of_cells(world), Vec3::Constant(step * diameter));
    };
    const double found = parts(cell_step);
    if (found <= most) return;
    double step = cell_step;
    while (parts(step) > most) step *= 1.1;
    std::ostringstream text, allowed;
    const Vec3 lengths = box.high - box.low;
    text << "averaging cells every " << cell_step << " mean diameters of " << diameter << " m in a region of "
         << lengths[0] << " x " << lengths[1] << " x " << lengths[2] << " m, whose edges divide it into up to "
         << 1e-6 * found << " million parts";
    allowed << "up to " << 1e-6 * most << " million: a cell_step of at least " << std::ceil(10 * step) / 10
            << (depth_axis.empty() ? ", a depth_axis" : "") << ", or a smaller region";
    throw ParameterError({{key, text.str(), allowed.str()}});
  }
  AveragingCells profile(const World& world, const Region& box) const {
    Vec3 size = Vec3::Constant(std::numeric_limits<double>::infinity());
    size[profile_axis()] = (box.high - box.low)[profile_axis()] / static_cast<double>(slices);
    return {world.cell(), box, size, size};
  }
  /// Writes the middles of slices [m] to position_channel().
  void fill_places(const Region& box, ChannelValues& values) const {
    const double low = box.low[profile_axis()], height = box.high[profile_axis()] - low;
    const auto places = values.list(place_name);
    for (std::size_t s = 0; s < places.size(); ++s)
      places[s] = low + (static_cast<double>(s) + 0.5) / static_cast<double>(slices) * height;
  }
  Channel position_channel() const {
    return {place_name, "m", "middle of each slice of the profile along " + along, {static_cast<std::size_t>(slices)}};
  }

 private:
  static constexpr const char* place_name = "position";
  int profile_axis() const { return along[0] - 'x'; }
  Vec3 size_of_cells(const World& world) const {
    const double diameter = world.mean_diameter();
    Vec3 size = Vec3::Constant(cell_size * diameter);
    // Without bodies there are no cells, not even along the depth.
    if (!depth_axis.empty() && diameter > 0) size[depth_axis[0] - 'x'] = std::numeric_limits<double>::infinity();
    return size;
  }
};

/// Centre and size of cells, to draw a map: the first two fields of a probe's frames.
inline std::vector<Field> map_of(const AveragingCells& cells) {
  std::vector<Field> fields{
      {"centre", "m", "centre of each averaging cell", 3, {}},
      {"size", "m", "size of a cell that does not overlap the next one: the size to draw on a map", 3, {}}};
  for (std::size_t n = 0; n < cells.cells(); ++n) {
    const Region box = cells.cell(n);
    const Vec3 centre = 0.5 * (box.low + box.high), own = cells.own();
    fields[0].values.insert(fields[0].values.end(), centre.begin(), centre.end());
    fields[1].values.insert(fields[1].values.end(), own.begin(), own.end());
  }
  return fields;
}

}  // namespace grit
