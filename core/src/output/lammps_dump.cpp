#include "output/lammps_dump.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "output/body_columns.hpp"

namespace grit {
namespace {

/// Bounds and kinds of the six sides: p periodic, f fixed, s where the box encloses the bodies.
std::string box(const World& world) {
  const Cell& cell = world.cell();
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
    bounds += fmt::format("{} {}\n", low, high);
  }
  return "ITEM: BOX BOUNDS" + kinds + '\n' + bounds;
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
    const Row &x = world.positions()[i], &v = world.velocities()[i], &w = world.spins()[i];
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {} {} {} {} {}\n", world.ids()[i],
                   groups.of_bodies[i] + 1, cell.inside(x.x, 0), cell.inside(x.y, 1), cell.inside(x.z, 2), x.w, v.x,
                   v.y, v.z, w.x, w.y, w.z);
  }
  return text;
}

}  // namespace grit
