// Rigid clumps: forces of their spheres to one force and moment, a step, and where the spheres are then.
#pragma once

#include "bodies/bodies.hpp"
#include "grit/contact/batch.hpp"
#include "motion/motion.hpp"

namespace grit {

/// What acts on a clump: force [N], and moment about its centre [N m].
struct ClumpLoad {
  Vec3 force, moment;
};
/// Of its spheres' contacts, in their order.
ClumpLoad load_of(const Clump& clump, const Bodies& bodies, const BodySum* sum);

/// Moves clumps first … last − 1 under `sum`, by body index, and puts their spheres where they are then: a
/// sphere's velocity is its way in the step over the step. Angular momentum is kept in
/// space; the free top turns by its parts about the principal axes one after the other and back, which is symplectic
/// and of second order: A. Dullweber, B. Leimkuhler, R. McLachlan, J. Chem. Phys. 107 (1997) 5840,
/// doi:10.1063/1.474310.
Motion move_clumps(std::size_t first, std::size_t last, Bodies& bodies, const BodySum* sum, const MotionStep& step);

}  // namespace grit
