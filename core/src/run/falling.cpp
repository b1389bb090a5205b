#include "run/falling.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace grit {

Falling falling_grains(const World& world) {
  const auto velocities = world.velocities(), forces = world.forces();
  const auto clumps = world.clumps();
  const auto clump_of = world.clump_of();
  const auto held = world.held();
  // Entries of grains: clumps first, then bodies.
  const auto grain = [&](std::size_t body) {
    return clump_of.empty() || clump_of[body] == no_clump ? clumps.size() + body : clump_of[body];
  };
  std::vector<bool> touches(clumps.size() + velocities.size()), is_held(touches.size());
  for (const Contact& one : world.contacts()) {
    touches[grain(one.a)] = true;
    if (!one.with_wall) touches[grain(one.b)] = true;
  }
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i] != 0) is_held[grain(i)] = true;
  Falling falling;
  const auto add = [&](std::size_t index, const Vec3& velocity, const Vec3& force) {
    if (is_held[index]) return;
    ++falling.all;
    if (touches[index] || !(velocity.dot(force) > 0)) return;
    ++falling.grains;
    falling.speed = std::max(falling.speed, velocity.norm());
  };
  for (std::size_t c = 0; c < clumps.size(); ++c)
    if (std::isfinite(clumps[c].mass)) add(c, clumps[c].velocity, clumps[c].force);
  for (std::size_t i = 0; i < velocities.size(); ++i)
    if (velocities[i].w > 0 && grain(i) >= clumps.size()) add(grain(i), xyz(velocities[i]), xyz(forces[i]));
  return falling;
}

}  // namespace grit
