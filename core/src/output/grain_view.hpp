// The grains of a world as a picture shows them.
#pragma once

#include <span>
#include <string>

#include "output/frames.hpp"
#include "output/picture.hpp"

namespace grit {

/// Which way to look, and what the colours say.
///
/// `view`: "xz" (from the front, y into the page), "xy" (from above), "yz" (from the side); first axis to the right,
/// second upwards. `color`: "rotation" about the line of sight, positive clockwise as seen; "displacement" along the
/// first axis; "speed". Where the world does not keep the state, grains are grey.
///
/// Grains whose centres lie in the middle third of the depth are shown, back to front; all of them where the depth is
/// less than three mean diameters. Walls are cut at mid-depth. Throws Error for another view or colour.
GrainView grain_view(const World& world, std::span<const WallShape> walls, const std::string& view,
                     const std::string& color);

}  // namespace grit
