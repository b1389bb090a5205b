#include "kernel/passed_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace grit {

bool passes_bodies(const State& state, std::size_t wall, const WallMotion& motion, double dt, double distance,
                   Passes& passes) {
  // At places along the way that are a radius apart, so that none is passed in between.
  constexpr double most_places = 1000;
  const double places = std::ceil(distance / state.statistics.smallest_radius);
  if (!(places <= most_places)) return true;
  const WallSurface& surface = state.surfaces[wall];
  const auto passed = passes.of_chunks([&](std::size_t chunk) {
    char some = 0;
    const ChunkRange range(chunk, state.bodies.count());
    std::vector<Sphere> spheres;
    for (std::size_t i = range.first; i < range.last; ++i) {
      if (!surface.acts_on(state.group, i)) continue;
      const Row& x = state.bodies.position[i];
      spheres.push_back({surface.within(xyz(x)), x.w, static_cast<std::uint32_t>(i)});
    }
    std::map<std::uint32_t, double> before;  // overlaps by body [m]
    std::vector<SurfaceContact> found;
    for (double place = 0; place <= places && some == 0; ++place) {
      found.clear();
      const Pose pose = moved(state.walls.pose(wall), motion, place / places * dt);
      if (!spheres.empty()) surface.geometry->find_contacts(pose, spheres, found);
      for (const SurfaceContact& contact : found) {
        const double allowed = state.settings.guards.travel * state.bodies.position[contact.body].w;
        if (place == 0) before[contact.body] = std::max(before[contact.body], contact.overlap);
        else if (contact.overlap > before[contact.body] + allowed) some = 1;
      }
    }
    return some;
  });
  return std::ranges::find(passed, 1) != passed.end();
}

}  // namespace grit
