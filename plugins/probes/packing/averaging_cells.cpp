#include "averaging_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grit {

namespace {

/// What a column, or a cell, holds.
struct Sums {
  double solid = 0;                 ///< m³
  double grains = 0, touching = 0;  ///< grains with their centre in it, and the grains that touch those
  Mat3 load = Mat3::Zero();         ///< sum of force and branch, as far as it lies inside [N m]

  Sums& operator+=(const Sums& other) {
    solid += other.solid, grains += other.grains, touching += other.touching, load += other.load;
    return *this;
  }
};

/// The columns between `box`'s faces along `depth`, and what falls into them.
class Columns {
 public:
  Columns(const World& world, const Region& box, int depth, const CellAxis& first, const CellAxis& second)
      : cell_(world.cell()),
        box_(box),
        depth_(depth),
        first_axis_(depth == 0 ? 1 : 0),
        second_axis_(depth == 2 ? 1 : 2),
        first_(first),
        second_(second),
        sums_(first.strips() * second.strips()) {
    // Only what lies in cells counts; the cells may leave a rim of the box free.
    box_.low[first_axis_] = first.edges().front(), box_.high[first_axis_] = first.edges().back();
    box_.low[second_axis_] = second.edges().front(), box_.high[second_axis_] = second.edges().back();
  }

  /// `share` of its volume counts.
  void add_body(const Row& body, double share) {
    const Vec3 reach = Vec3::Constant(body.w);
    for_images(xyz(body), -reach, reach, [&](const Vec3& centre) { add_image(centre, body.w, share); });
  }

  void add_grain(const Vec3& place, double touching) {
    const Vec3 zero = Vec3::Zero();
    for_images(place, zero, zero, [&](const Vec3& centre) {
      if (!holds(centre)) return;
      Sums& sums = column(first_.strip(centre[first_axis_]), second_.strip(centre[second_axis_]));
      ++sums.grains, sums.touching += touching;
    });
  }

  void add_contact(const Vec3& force, const Branch& contact) {
    const auto& [start, branch] = contact;
    const Mat3 load = force * branch.transpose();
    const Vec3 zero = Vec3::Zero();
    for_images(start, branch.cwiseMin(zero), branch.cwiseMax(zero),
               [&](const Vec3& from) { add_branch(from, branch, load); });
  }

  const Sums& at(std::size_t i, std::size_t j) const { return sums_[i * second_.strips() + j]; }

 private:
  /// Calls visit(place) for each periodic image of `place` for which place + low … place + high may reach into the box.
  template <class Visit>
  void for_images(const Vec3& place, const Vec3& low, const Vec3& high, const Visit& visit) const {
    int least[3], most[3];
    Vec3 period = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const double before = box_.low[k] - place[k] - high[k], after = box_.high[k] - place[k] - low[k];
      if (cell_.periodic[k]) {
        period[k] = cell_.high[k] - cell_.low[k];
        least[k] = static_cast<int>(std::ceil(before / period[k])),
        most[k] = static_cast<int>(std::floor(after / period[k]));
      } else {
        least[k] = 0, most[k] = before <= 0 && after >= 0 ? 0 : -1;
      }
    }
    for (int i = least[0]; i <= most[0]; ++i)
      for (int j = least[1]; j <= most[1]; ++j)
        for (int k = least[2]; k <= most[2]; ++k) visit(place + Vec3(i * period[0], j * period[1], k * period[2]));
  }

  Sums& column(std::size_t i, std::size_t j) { return sums_[i * second_.strips() + j]; }

  bool holds(const Vec3& point) const {
    return (point.array() >= box_.low.array()).all() && (point.array() < box_.high.array()).all();
  }

  void add_image(const Vec3& centre, double radius, double share) {
    const double first = centre[first_axis_], second = centre[second_axis_];
    const std::size_t first_end = first_.strip(first + radius), second_end = second_.strip(second + radius);
    Vec3 low = box_.low, high = box_.high;
    for (std::size_t i = first_.strip(first - radius); i <= first_end; ++i) {
      low[first_axis_] = first_.edges()[i], high[first_axis_] = first_.edges()[i + 1];
      for (std::size_t j = second_.strip(second - radius); j <= second_end; ++j) {
        low[second_axis_] = second_.edges()[j], high[second_axis_] = second_.edges()[j + 1];
        column(i, j).solid += share * sphere_box_volume(centre, radius, low, high);
      }
    }
  }

  void add_branch(const Vec3& start, const Vec3& branch, const Mat3& load) {
    double from = 0, to = 1;
    for (int k = 0; k < 3; ++k) {
      if (branch[k] == 0) {
        if (!(start[k] >= box_.low[k] && start[k] < box_.high[k])) return;
        continue;
      }
      const double low = (box_.low[k] - start[k]) / branch[k], high = (box_.high[k] - start[k]) / branch[k];
      from = std::max(from, std::min(low, high)), to = std::min(to, std::max(low, high));
    }
    if (!(to > from)) return;
    cuts_ = {from, to};
    cut(first_, start[first_axis_], branch[first_axis_], from, to);
    cut(second_, start[second_axis_], branch[second_axis_], from, to);
    std::sort(cuts_.begin(), cuts_.end());
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
      const Vec3 middle = start + 0.5 * (cuts_[i] + cuts_[i + 1]) * branch;
      column(first_.strip(middle[first_axis_]), second_.strip(middle[second_axis_])).load +=
          (cuts_[i + 1] - cuts_[i]) * load;
    }
  }

  /// Notes where between `from` and `to` a branch crosses edges of strips.
  void cut(const CellAxis& axis, double start, double branch, double from, double to) {
    if (branch == 0) return;
    const double one = start + from * branch, other = start + to * branch, high = std::max(one, other);
    for (std::size_t edge = axis.strip(std::min(one, other)) + 1; edge < axis.strips() && axis.edges()[edge] < high;
         ++edge)
      cuts_.push_back(std::clamp((axis.edges()[edge] - start) / branch, from, to));
  }

  const Cell& cell_;
  Region box_;
  int depth_, first_axis_, second_axis_;
  const CellAxis &first_, &second_;
  std::vector<Sums> sums_;
  std::vector<double> cuts_;
};

}  // namespace

CellAxis::CellAxis(double low, double high, double size, double step) {
  constexpr double slack = 1e-9;  // of a step: what counts as the same edge
  const double length = high - low;
  size = std::min(size, length);
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
    return static_cast<std::size_t>(std::lower_bound(edges_.begin(), edges_.end(), x - slack * step) - edges_.begin());
  };
  for (auto& cell : cells_) cell.begin = edge(cell.low), cell.end = edge(cell.high);
}

std::size_t CellAxis::strip(double x) const {
  const auto above = std::upper_bound(edges_.begin(), edges_.end(), x) - edges_.begin();
  return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(strips()) - 1));
}

std::vector<CellAverage> averaging_cells(const World& world, const Region& box, int depth, double size, double step) {
  // Without bodies there is no mean diameter, and so no size.
  if (!(box.volume() > 0 && size > 0 && step > 0)) return {};
  const int a = depth == 0 ? 1 : 0, b = depth == 2 ? 1 : 2;
  const CellAxis first(box.low[a], box.high[a], size, step), second(box.low[b], box.high[b], size, step);
  Columns columns(world, box, depth, first, second);

  const auto positions = world.positions();
  const auto shares = world.volume_shares();
  const Grains grains = grains_of(world);
  std::vector<double> touching(grains.centre.size());
  for (const auto& contact : world.contacts()) {
    columns.add_contact(contact.force, branch_of(world, contact));
    if (!contact.with_wall) ++touching[grains.of_body[contact.a]], ++touching[grains.of_body[contact.b]];
  }
  for (std::size_t i = 0; i < positions.size(); ++i) columns.add_body(positions[i], shares.empty() ? 1 : shares[i]);
  for (std::size_t g = 0; g < touching.size(); ++g) columns.add_grain(grains.centre[g], touching[g]);

  std::vector<CellAverage> averages;
  averages.reserve(first.cells().size() * second.cells().size());
  std::vector<Sums> slab(second.strips());
  for (const auto& across : first.cells()) {
    // Summing up one axis, then the other, costs a cell the sum of both numbers of strips, not their product.
    std::fill(slab.begin(), slab.end(), Sums());
    for (std::size_t i = across.begin; i < across.end; ++i)
      for (std::size_t j = 0; j < slab.size(); ++j) slab[j] += columns.at(i, j);
    for (const auto& up : second.cells()) {
      Sums sums;
      for (std::size_t j = up.begin; j < up.end; ++j) sums += slab[j];
      Region region = box;
      region.low[a] = across.low, region.high[a] = across.high;
      region.low[b] = up.low, region.high[b] = up.high;
      const double volume = region.volume();
      averages.push_back({region, sums.solid > 0 ? volume / sums.solid - 1 : std::numeric_limits<double>::infinity(),
                          sums.grains > 0 ? sums.touching / sums.grains : 0, sums.load / volume});
    }
  }
  return averages;
}

}  // namespace grit
