#include "output/lammps_dump.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "output/body_columns.hpp"

namespace grit {
namespace {

/// Bounds and kinds of the six sides: p periodic, f fixed, s where the box encloses the bodies. Of a skewed cell LAMMPS
/// gives the bounds of the box that encloses it, each with an offset of its images.
std::string box(const World& world) {
  const Cell& cell = world.cell();
  const Vec3& tilt = cell.tilt;
  std::string kinds, bounds;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double low = infinity, high = -infinity;
    for (const Row& body : world.positions())
      low = std::min(low, xyz(body)[axis] - body.w), high = std::max(high, xyz(body)[axis] + body.w);
    if (world.positions().empty()) low = 0, high = 1;  // a box without volume is not allowed
    const auto side = [&](double bound, double& extent) {
      if (std::isfinite(bound)) extent = bound;
      return cell.periodic[static_cast<std::size_t>(axis)] ? 'p' : std::isfinite(bound) ? 'f' : 's';
    };
    kinds += ' ';
    kinds += side(cell.low[axis], low);
    kinds += side(cell.high[axis], high);
    if (!cell.skewed()) {
      bounds += fmt::format("{} {}\n", low, high);
      continue;
    }
    const auto [least, most] = axis == 0   ? std::minmax({0.0, tilt[0], tilt[1], tilt[0] + tilt[1]})
                               : axis == 1 ? std::minmax({0.0, tilt[2]})
                                           : std::pair(0.0, 0.0);
    bounds += fmt::format("{} {} {}\n", low + least, high + most, tilt[axis]);
  }
  return std::string("ITEM: BOX BOUNDS") + (cell.skewed() ? " xy xz yz" : "") + kinds + '\n' + bounds;
}

/// A centre moved by whole periods into the cell of LAMMPS, whose edges from its lower corner are the periods.
Vec3 in_box(const Cell& cell, const Vec3& centre) {
  if (!cell.skewed()) return cell.inside(centre);
  Vec3 whole = Vec3::Zero(), rest = centre - cell.low;
  for (int axis = 2; axis >= 0; --axis) {
    if (!cell.periodic[static_cast<std::size_t>(axis)]) continue;
    const Vec3 period = cell.period(axis);
    const double periods = rest[axis] / period[axis];
    whole += std::floor(periods) * period, rest -= periods * period;
  }
  return centre - whole;
}

}  // namespace

std::string lammps_dump(const World& world, std::span<const WallShape>) {
  const GroupIndex groups = group_index(world);
  const Cell& cell = world.cell();
  const auto order = bodies_by_id(world);
  std::string text = fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n", world.step(), order.size());
  text += box(world);
  text += "ITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz\n";
  for (const std::uint32_t i : order) {
    const Row &v = world.velocities()[i], &w = world.spins()[i];
    const Vec3 x = in_box(cell, xyz(world.positions()[i]));
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {} {} {} {} {}\n", world.ids()[i],
                   groups.of_bodies[i] + 1, x.x(), x.y(), x.z(), world.positions()[i].w, v.x, v.y, v.z, w.x, w.y, w.z);
  }
  return text;
}

}  // namespace grit
