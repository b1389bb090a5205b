// Random orientations.
#pragma once

#include <Eigen/Geometry>

#include "bodies/random.hpp"

namespace grit {

/// Random orientation, uniformly distributed (K. Shoemake, Graphics Gems III (1992) 124,
/// doi:10.1016/B978-0-08-050755-2.50036-1).
Eigen::Quaterniond any_orientation(Random& random);

}  // namespace grit
