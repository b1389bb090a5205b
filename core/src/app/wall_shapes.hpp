// What walls look like in frames and pictures.
#pragma once

#include <vector>

#include "bodies/bodies.hpp"
#include "input/scene.hpp"
#include "output/frames.hpp"
#include "simulation/live_components.hpp"

namespace grit {

/// The triangles of a scene's walls as they begin, with these geometries, and as stages change them. A plane across an
/// axis that has no extent is drawn as far as the other walls reach: along an axis along which they reach nowhere, as
/// far as the domain, and where that is open as far as the `bodies` that are there at the start and as much again on
/// both sides.
std::vector<WallShape> wall_shapes(const Scene& scene, LiveGeometries geometries, const Bodies& bodies);

}  // namespace grit
