// The columns of bodies in frames.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "grit/channels.hpp"
#include "grit/world.hpp"
#include "output/group_index.hpp"

namespace grit {

/// Indices of the bodies in the order of their ids.
inline std::vector<std::uint32_t> bodies_by_id(const World& world) {
  std::vector<std::uint32_t> order(world.ids().size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [ids = world.ids()](std::uint32_t body) { return ids[body]; });
  return order;
}

/// Calls `put(channel, width, values)` for each column, with its rows in the order of ids and `width` values in a row;
/// values are a vector of double, int64 or int32. State that is not kept has no column, a single group neither.
template <class Put>
void put_body_columns(const World& world, const GroupIndex& groups, const Put& put) {
  const std::vector<std::uint32_t> order = bodies_by_id(world);
  const auto scalar = [&]<class T>(T, const Channel& what, auto read) {
    std::vector<T> values;
    values.reserve(order.size());
    for (const std::uint32_t body : order) values.push_back(static_cast<T>(read(body)));
    put(what, std::size_t{1}, values);
  };
  const auto vector = [&](const Channel& what, auto read) {
    std::vector<double> values;
    values.reserve(3 * order.size());
    for (const std::uint32_t body : order) {
      const Vec3 v = read(body);
      values.insert(values.end(), v.data(), v.data() + 3);
    }
    put(what, std::size_t{3}, values);
  };
  constexpr std::int64_t wide = 0;
  constexpr std::int32_t narrow = 0;
  scalar(wide, {"id", "1", "number that the body keeps for the whole run", {}},
         [ids = world.ids()](auto i) { return ids[i]; });
  vector({"position", "m", "centre", {}}, [rows = world.positions()](auto i) { return xyz(rows[i]); });
  scalar(0.0, {"radius", "m", "radius", {}}, [rows = world.positions()](auto i) { return rows[i].w; });
  vector({"velocity", "m/s", "velocity of the centre, half a step before the frame's time", {}},
         [rows = world.velocities()](auto i) { return xyz(rows[i]); });
  vector({"spin", "rad/s", "angular velocity, right-handed, half a step before the frame's time", {}},
         [rows = world.spins()](auto i) { return xyz(rows[i]); });
  scalar(narrow, {"material", "1", "number of the material, from 0: its index in /model/materials of run.json", {}},
         [materials = world.materials()](auto i) { return materials[i]; });
  if (const auto clump_of = world.clump_of(); !clump_of.empty())
    scalar(wide, {"clump", "1", "id of the clump that the body is part of; -1 for a single body", {}},
           [&, clumps = world.clumps()](auto i) -> std::int64_t {
             return clump_of[i] == no_clump ? -1 : std::int64_t{clumps[clump_of[i]].id};
           });
  if (groups.names.size() > 1)
    scalar(narrow, {"group", "1", "index of the body's group among the attribute \"names\"", {}},
           [&](auto i) { return groups.of_bodies[i]; });
  if (const auto rotations = world.rotations(); !rotations.empty())
    vector({"rotation", "rad", "cumulative rotation since the start of the stage, right-handed", {}},
           [&](auto i) { return rotations[i]; });
  if (const auto displacements = world.displacements(); !displacements.empty())
    vector({"displacement", "m", "displacement since the start of the stage", {}},
           [&](auto i) { return displacements[i]; });
}

}  // namespace grit
