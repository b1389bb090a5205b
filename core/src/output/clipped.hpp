// Lines that reach out of sight.
#pragma once

#include <optional>

#include "output/picture.hpp"

namespace grit {

/// The part of a segment that lies in a box; none where it passes by, or is not drawable(). What is far outside would
/// be too long for those who draw it.
std::optional<Segment> clipped(const Segment& segment, double low_x, double high_x, double low_y, double high_y);

}  // namespace grit
