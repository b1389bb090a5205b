#include "coarse_fields.hpp"

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>

#include "lucy.hpp"

namespace grit {

namespace {

/// Calls visit(field, point − place) for each point of the grid within `reach` of the box from place + low to
/// place + high, and of its periodic images.
class Spread {
 public:
  Spread(const World& world, const PointGrid& grid, double reach) : cell_(world.cell()), grid_(grid), reach_(reach) {}

  template <class Visit>
  void operator()(std::vector<CoarseFields>& fields, const Vec3& place, const Vec3& low, const Vec3& high,
                  Visit visit) const {
    if (!cell_.skewed()) return from(fields, place, low, high, visit);
    if (!(place + low).allFinite() || !(place + high).allFinite()) return;  // a run that has failed
    const Vec3 reach = Vec3::Constant(reach_);
    Vec3 last = grid_.first;
    for (int axis = 0; axis < 3; ++axis)
      last[axis] += (static_cast<double>(grid_.count[static_cast<std::size_t>(axis)]) - 1) * grid_.step[axis];
    cell_.each_image(place + low - reach, place + high + reach, grid_.first, last,
                     [&](const Vec3& shift) { from(fields, place + shift, low, high, visit); });
  }

 private:
  template <class Visit>
  void from(std::vector<CoarseFields>& fields, const Vec3& place, const Vec3& low, const Vec3& high,
            Visit& visit) const {
    std::array<Places, 3> rows;
    for (int axis = 0; axis < 3; ++axis) rows[static_cast<std::size_t>(axis)] = on(axis, place, low, high);
    for (const Place& x : rows[0])
      for (const Place& y : rows[1]) {
        CoarseFields* const line = fields.data() + (x.index * grid_.count[1] + y.index) * grid_.count[2];
        for (const Place& z : rows[2]) visit(line[z.index], Vec3(x.off, y.off, z.off));
      }
  }

  /// A place of the grid along an axis that is reached, and how far it is off an image's place [m].
  struct Place {
    std::size_t index;
    double off;
  };
  using Places = boost::container::small_vector<Place, 16>;
  Places on(int axis, const Vec3& place, const Vec3& low, const Vec3& high) const {
    const double first = grid_.first[axis], step = grid_.step[axis],
                 last = static_cast<double>(grid_.count[static_cast<std::size_t>(axis)]) - 1;
    const double least = place[axis] + low[axis] - reach_, most = place[axis] + high[axis] + reach_;
    Places rows;
    if (!std::isfinite(least + most)) return rows;  // a run that has failed
    const bool periodic = cell_.periodic[static_cast<std::size_t>(axis)] && !cell_.skewed();
    const double period = periodic ? cell_.high[axis] - cell_.low[axis] : 0;
    double image = periodic ? std::ceil((first - most) / period) : 0;
    for (; least + image * period <= first + last * step; ++image) {
      const double shift = image * period;
      const double from = std::max(0.0, std::ceil((least + shift - first) / step)),
                   to = std::min(last, std::floor((most + shift - first) / step));
      for (double k = from; k <= to; ++k)
        rows.push_back({static_cast<std::size_t>(k), first + k * step - place[axis] - shift});
      if (!periodic) break;
    }
    return rows;
  }

  const Cell& cell_;
  const PointGrid& grid_;
  double reach_;
};

}  // namespace

std::vector<CoarseFields> coarse_fields(const World& world, const PointGrid& grid, double cutoff) {
  std::vector<CoarseFields> fields(grid.size());
  const Lucy kernel(cutoff);
  const Spread spread(world, grid, cutoff);

  const auto add_grain = [&](const Vec3& centre, const Vec3& velocity, double mass) {
    const Vec3 zero = Vec3::Zero();
    const Mat3 flux = velocity * velocity.transpose();
    spread(fields, centre, zero, zero, [&](CoarseFields& field, const Vec3& off) {
      const double weight = mass * kernel(off.norm());
      if (weight == 0) return;
      field.density += weight, field.momentum += weight * velocity;
      field.kinetic += weight * flux;
    });
  };
  const auto clump_of = world.clump_of();
  for (std::size_t i = 0; i < world.positions().size(); ++i)
    if (clump_of.empty() || clump_of[i] == no_clump)
      add_grain(xyz(world.positions()[i]), xyz(world.velocities()[i]), 1 / world.velocities()[i].w);
  for (const ClumpView& clump : world.clumps()) add_grain(clump.centre, clump.velocity, clump.mass);

  for (const Contact& contact : world.contacts()) {
    const Branch branch = branch_of(world, contact);
    const Vec3& way = branch.vector;
    const Mat3 load = contact.force * way.transpose();
    const Lucy::Line line(way);
    spread(fields, branch.start, way.cwiseMin(0.0), way.cwiseMax(0.0), [&](CoarseFields& field, const Vec3& off) {
      if (const double share = kernel.along(off, line); share != 0) field.contact += share * load;
      if (contact.with_wall) field.wall_force -= kernel((off - way).norm()) * contact.force;
    });
  }
  for (CoarseFields& field : fields) field.kinetic -= field.momentum * field.velocity().transpose();
  return fields;
}

}  // namespace grit
