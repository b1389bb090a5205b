#include "domain/boundaries.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace grit {
namespace {

bool may_leave(const std::vector<std::string>& open_sides, int axis, bool high) {
  const std::string side = std::string(high ? "+" : "-") + "xyz"[axis];
  return std::ranges::find(open_sides, side) != open_sides.end();
}

}  // namespace

Wrapped wrap(Bodies& bodies, std::size_t first, std::size_t last, const Cell& cell, const Mat3& velocities,
             const std::vector<std::string>& open_sides, Team& team) {
  const Vec3 period = cell.high - cell.low;
  Wrapped result{std::vector<bool>(bodies.count(), false), {}, {}};
  const auto outside = [&](const Vec3& x, int k) { return x[k] < cell.low[k] || x[k] > cell.high[k]; };
  const auto periods_off = [&](const Vec3& x, int k) { return std::floor((x[k] - cell.low[k]) / period[k]); };
  // The image across z may be off along x and y, that across y along x.
  const bool skewed = cell.skewed();
  const auto axis = [skewed](int n) { return skewed ? 2 - n : n; };
  const auto shift = [&](Vec3& x, double periods, int k) {
    const Vec3 to_next = cell.period(k);
    for (int j = skewed ? 0 : k; j <= k; ++j) x[j] -= periods * to_next[j];
  };
  // A body that re-enters takes the mean flow there.
  const auto jump = [&](Vec3& v, double periods, int k, double inverse_mass) {
    double gained = 0;
    for (int j = skewed ? 0 : k; j <= k; ++j) {
      const double before = v[j];
      const double by = periods * velocities(j, k);
      v[j] -= by;
      gained += 0.5 / inverse_mass * (v[j] * v[j] - before * before);
    }
    return gained;
  };
  // A clump leaves as a whole, by its centre.
  for (Clump& clump : bodies.clumps.clump)
    for (int n = 0; n < 3; ++n) {
      const int k = axis(n);
      if (!cell.periodic[as_index(k)]) {
        if (!outside(clump.centre, k) || !may_leave(open_sides, k, clump.centre[k] > cell.high[k])) continue;
        for (std::uint32_t s = clump.first; s < clump.last; ++s) result.leaves[bodies.clumps.spheres[s]] = true;
        continue;
      }
      const double periods = periods_off(clump.centre, k);
      if (periods == 0) continue;
      shift(clump.centre, periods, k);
      result.gained.push_back(jump(clump.velocity, periods, k, clump.inverse_mass));
      for (std::uint32_t s = clump.first; s < clump.last; ++s)
        bodies.clumps.of_body[bodies.clumps.spheres[s]].periods[static_cast<std::size_t>(k)] -=
            static_cast<std::int8_t>(periods);
    }
  struct Part {
    std::vector<double> gained;  // energies, in the order of the bodies
    std::optional<Escape> escape;
  };
  std::vector<Part> parts(last - first);
  // Bits of different chunks are in different words of result.leaves.
  static_assert(chunk_bodies % 64 == 0);
  team.each(parts.size(), [&](std::size_t own) {
    Part& part = parts[own];
    const ChunkRange range(first + own, bodies.count());
    for (std::size_t i = range.first; i < range.last && !part.escape; ++i) {
      Vec3 x = xyz(bodies.position[i]), v = xyz(bodies.velocity[i]);
      const bool in_clump = bodies.clumps.clump_of(i) != no_clump;
      bool moved = false;
      for (int n = 0; n < 3; ++n) {
        const int k = axis(n);
        if (!cell.periodic[as_index(k)]) {
          const bool high = x[k] > cell.high[k];
          if (!outside(x, k)) continue;
          if (!may_leave(open_sides, k, high)) part.escape = part.escape.value_or(Escape{i, k, high});
          if (!in_clump) result.leaves[i] = true;
          continue;
        }
        const double periods = periods_off(x, k);
        if (periods == 0) continue;
        shift(x, periods, k);
        if (!bodies.origin.empty()) shift(bodies.origin[i], periods, k);
        const double energy = jump(v, periods, k, bodies.velocity[i].w);
        if (!in_clump) part.gained.push_back(energy);
        if (in_clump)
          bodies.clumps.of_body[i].periods[static_cast<std::size_t>(k)] += static_cast<std::int8_t>(periods);
        else if (x[k] >= cell.high[k]) x[k] = cell.low[k];
        moved = true;
      }
      if (!moved) continue;
      bodies.position[i] = {x.x(), x.y(), x.z(), bodies.position[i].w};
      bodies.velocity[i] = {v.x(), v.y(), v.z(), bodies.velocity[i].w};
    }
  });
  for (const Part& part : parts) {
    if (!result.escaped) result.escaped = part.escape;
    result.gained.insert(result.gained.end(), part.gained.begin(), part.gained.end());
  }
  return result;
}

void change_periods(Bodies& bodies, const Eigen::Matrix3i& of_old) {
  for (ClumpSphere& sphere : bodies.clumps.of_body) {
    const Eigen::Vector3i old(sphere.periods[0], sphere.periods[1], sphere.periods[2]), now = of_old * old;
    for (int k = 0; k < 3; ++k) sphere.periods[static_cast<std::size_t>(k)] = static_cast<std::int8_t>(now[k]);
  }
}

std::vector<Leaving> leaving(const Bodies& bodies, const std::vector<bool>& leaves, double time,
                             const std::function<const MotionSettings&(std::size_t body)>& motion_of) {
  std::vector<Leaving> all;
  const auto add = [&](std::size_t i, double radius, const Vec3& x, const Vec3& v, double inverse_mass,
                       double turning) {
    const MotionSettings& motion = motion_of(i);
    all.push_back({{.id = bodies.id[i],
                    .material = bodies.material[i],
                    .time = time,
                    .mass = motion.unscaled_share(radius) / inverse_mass,
                    .position = x},
                   0.5 / inverse_mass * v.squaredNorm() + turning,
                   -motion.gravity_on(radius).dot(x) / inverse_mass});
  };
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < bodies.count(); ++i)
    if (leaves[i]) indices.push_back(i);
  std::ranges::sort(indices, {}, [&](std::size_t i) { return bodies.id[i]; });
  for (const std::size_t i : indices) {
    const std::uint32_t c = bodies.clumps.clump_of(i);
    if (c == no_clump) {
      add(i, bodies.position[i].w, xyz(bodies.position[i]), xyz(bodies.velocity[i]), bodies.velocity[i].w,
          0.5 / bodies.spin[i].w * xyz(bodies.spin[i]).squaredNorm());
    } else if (const Clump& clump = bodies.clumps.clump[c]; bodies.clumps.spheres[clump.first] == i) {
      add(i, clump.radius, clump.centre, clump.velocity, clump.inverse_mass, 0.5 * clump.momentum.dot(clump.spin));
    }
  }
  return all;
}

}  // namespace grit
