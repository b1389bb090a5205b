// Clipping of line segments.
#pragma once

#include <optional>

#include "output/picture.hpp"

namespace grit {

/// The part of a segment inside a box; none if it misses the box or is not drawable(). Renderers cannot handle
/// coordinates far outside.
std::optional<Segment> clipped(const Segment& segment, double low_x, double high_x, double low_y, double high_y);

}  // namespace grit
