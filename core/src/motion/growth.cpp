#include "motion/growth.hpp"

#include <algorithm>

#include "threads/chunks.hpp"

namespace grit {

void grow_bodies(std::size_t chunk, Bodies& bodies, double factor) {
  const double square = factor * factor, per_mass = 1 / (square * factor), per_inertia = per_mass / square;
  const std::size_t first = chunk * chunk_bodies, last = std::min(bodies.count(), first + chunk_bodies);
  for (std::size_t i = first; i < last; ++i) {
    Row& x = bodies.position[i];
    x.w *= factor, bodies.velocity[i].w *= per_mass, bodies.spin[i].w *= per_inertia;
    const std::uint32_t c = bodies.clumps.clump_of(i);
    if (c == no_clump) continue;
    Vec3& place = bodies.clumps.of_body[i].place;
    const Vec3 further = (factor - 1) * (bodies.clumps.clump[c].axes * place);
    x += Row{further.x(), further.y(), further.z(), 0};
    place *= factor;
  }
}

void grow_clumps(Bodies& bodies, double factor) {
  const double square = factor * factor, cube = square * factor, fifth = cube * square;
  for (Clump& clump : bodies.clumps.clump) {
    clump.radius *= factor, clump.furthest *= factor, clump.volume *= cube;
    clump.inverse_mass /= cube, clump.inertia *= fifth, clump.momentum *= fifth;
  }
}

}  // namespace grit
