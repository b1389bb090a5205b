// Rigid clumps: resultant of the forces on their spheres, a step of integration, and the new positions of the spheres.
#pragma once

#include "bodies/bodies.hpp"
#include "grit/contact/batch.hpp"
#include "motion/motion.hpp"

namespace grit {

/// Resultant on a clump: force [N], and moment about its centre of mass [N m].
struct ClumpLoad {
  Vec3 force, moment;
};
/// Sum over the contacts of its spheres, in their order.
ClumpLoad load_of(const Clump& clump, const Bodies& bodies, const BodySum* sum);

/// Moves clumps first … last − 1 under the forces `sum`, by body index, and their spheres with them: the velocity of a
/// sphere is its displacement in the step over the step. Angular momentum is stored in the global frame. The free
/// rotation is split into rotations about the principal axes, one after the other and back; this is symplectic and of
/// second order: A. Dullweber, B. Leimkuhler, R. McLachlan, J. Chem. Phys. 107 (1997) 5840, doi:10.1063/1.474310.
Motion move_clumps(std::size_t first, std::size_t last, Bodies& bodies, const BodySum* sum, const MotionStep& step);

}  // namespace grit
