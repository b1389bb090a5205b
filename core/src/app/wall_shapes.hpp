// Shapes of walls for frames and pictures.
#pragma once

#include <vector>

#include "bodies/bodies.hpp"
#include "input/scene.hpp"
#include "output/frames.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// The triangles of a scene's walls at the start, with these geometries, and as stages change them. An unbounded plane
/// normal to an axis is drawn over the extent of the other walls. Along an axis where these have no extent it is drawn
/// over the domain. If the domain is open there, it is drawn over the extent of the initial `bodies`, with a margin of
/// their largest extent on both sides.
std::vector<WallShape> wall_shapes(const Scene& scene, LiveGeometries geometries, const Bodies& bodies);

}  // namespace grit
