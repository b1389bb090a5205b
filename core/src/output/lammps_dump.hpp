// Frames as dumps of LAMMPS, for OVITO and as packings.
#pragma once

#include <span>
#include <string>

#include "output/wall_shape.hpp"

namespace grit {

/// A snapshot with the bodies in the order of ids, `id type x y z radius vx vy vz omegax omegay omegaz` in SI. The type
/// is 1 + index of the group by name. Along open sides without a bound the box encloses the bodies. A cell that shears
/// or has sheared is triclinic.
std::string lammps_dump(const World& world, std::span<const WallShape> shapes);

}  // namespace grit
