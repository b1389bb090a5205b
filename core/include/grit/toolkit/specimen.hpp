// The boxes over which properties of the specimen are averaged.
#pragma once

#include <cmath>

#include "grit/world.hpp"

namespace grit {

/// The box with its open (infinite) sides moved to the outermost bodies.
inline Region closed_box(Region region, const World& world) {
  if (region.low.allFinite() && region.high.allFinite()) return region;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  bool first = true;
  for (const Row& body : world.positions()) {
    const Vec3 least = xyz(body).array() - body.w, most = xyz(body).array() + body.w;
    low = first ? least : low.cwiseMin(least);
    high = first ? most : high.cwiseMax(most);
    first = false;
  }
  for (int k = 0; k < 3; ++k) {
    if (!std::isfinite(region.low[k])) region.low[k] = low[k];
    if (!std::isfinite(region.high[k])) region.high[k] = high[k];
  }
  return region;
}

/// The whole specimen.
inline Region specimen_box(const World& world) { return closed_box(world.specimen(), world); }

/// The specimen without one mean diameter along each wall.
inline Region interior_box(const World& world) { return closed_box(world.interior(world.mean_diameter()), world); }

}  // namespace grit
