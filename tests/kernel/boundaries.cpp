#include "domain/boundaries.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bodies/random.hpp"
#include "two_spheres.hpp"

namespace grit::test::boundaries_tests {
namespace {

double energy_gained(const Wrapped& wrapped) {
  return std::accumulate(wrapped.gained.begin(), wrapped.gained.end(), 0.0);
}

TEST(Boundaries, BodiesReEnterAtTheOtherSideWithTheFlowThere) {
  Team team(1);
  State state = two_spheres(0.004, box({true, false, false}));
  state.bodies.position[1].x = 0.012;
  set_velocity(state, 1, {1, 0, 0});
  const Wrapped wrapped = wrap(state.bodies, 0, 1, state.cell.cell(), Vec3(0.5, 0, 0).asDiagonal(), {}, team);
  EXPECT_DOUBLE_EQ(state.bodies.position[1].x, -0.008);
  EXPECT_DOUBLE_EQ(state.bodies.velocity[1].x, 0.5) << "the opposite side of the cell moves faster by 0.5 m/s";
  EXPECT_FALSE(wrapped.escaped);
  EXPECT_NEAR(energy_gained(wrapped), 0.5 * sphere_mass() * (0.25 - 1), 1e-12 * sphere_mass());
  EXPECT_EQ(state.bodies.position[0].x, -0.002) << "a body inside stays";
  EXPECT_THAT(wrapped.leaves, testing::Each(false));
}

TEST(Boundaries, BodiesReEnterASkewedCellAtTheirImage) {
  Team team(1);
  State state = two_spheres(0.004, box({true, true, true}));
  state.cell.set_rates(Vec3::Zero(), {0, 50, 0}, 0);
  state.cell.advance(1e-3);  // the image across z moves by 50 1/s · 20 mm · 1 ms = 1 mm along x
  EXPECT_NEAR(state.cell.cell().tilt[1], 1e-3, 1e-18);
  state.bodies.position[1].x = -0.0095, state.bodies.position[1].z = 0.0105;
  set_velocity(state, 1, {2, 0, 3});
  const Wrapped wrapped = wrap(state.bodies, 0, 1, state.cell.cell(), state.cell.image_velocities(1e-3), {}, team);
  EXPECT_NEAR(state.bodies.position[1].z, -0.0095, 1e-15);
  EXPECT_NEAR(state.bodies.position[1].x, 0.0095, 1e-15) << "1 mm back, and then across x";
  EXPECT_NEAR(state.bodies.velocity[1].x, 2 - 50 * 0.02, 1e-12) << "shear rate times height";
  EXPECT_EQ(state.bodies.velocity[1].z, 3);
  EXPECT_FALSE(wrapped.escaped);
  EXPECT_NEAR(energy_gained(wrapped), 0.5 * sphere_mass() * (1 - 4), 1e-12 * sphere_mass());
}

TEST(Boundaries, BodiesLeaveThroughOpenSidesAlone) {
  Team team(1);
  State state = two_spheres(0.004);
  state.bodies.position[0].z = -0.011;
  const Wrapped open = wrap(state.bodies, 0, 1, state.cell.cell(), Mat3::Zero(), {"-z"}, team);
  EXPECT_EQ(open.leaves, (std::vector{true, false}));
  EXPECT_FALSE(open.escaped);
  const Wrapped closed = wrap(state.bodies, 0, 1, state.cell.cell(), Mat3::Zero(), {"+z", "-x"}, team);
  ASSERT_TRUE(closed.escaped);
  EXPECT_EQ(closed.escaped->body, 0u);
  EXPECT_EQ(closed.escaped->axis, 2);
  EXPECT_FALSE(closed.escaped->high);
}

/// Many bodies in one chunk or several, some of which have left the cell by up to a period along x, and their energy.
struct Scattered {
  Bodies bodies;
  Wrapped wrapped;
};
Scattered wrapped_by(unsigned threads, double below_the_floor) {
  Scattered all;
  Random random(4);
  for (std::size_t i = 0; i < 3 * chunk_bodies + 5; ++i) {
    const Vec3 x(0.06 * (random.uniform() - 0.5), 0.02 * (random.uniform() - 0.5), 0.02 * (random.uniform() - 0.5));
    all.bodies.add(x, 1e-4, 1e-6 + 1e-8 * static_cast<double>(i), 1e-14, 0, Vec3(2 * (random.uniform() - 0.5), 0, 0),
                   Vec3::Zero());
  }
  for (const std::size_t i : {2 * chunk_bodies + 1, chunk_bodies - 1}) all.bodies.position[i].z -= below_the_floor;
  all.bodies.finish({});
  Team team(threads);
  const Cell cell{Vec3::Constant(-0.01), Vec3::Constant(0.01), {true, false, false}};
  all.wrapped = wrap(all.bodies, 0, 4, cell, Vec3(0.1, 0, 0).asDiagonal(), {}, team);
  return all;
}

TEST(Boundaries, BodiesReEnterAlikeByAnyNumberOfThreads) {
  const Scattered one = wrapped_by(1, 0), three = wrapped_by(3, 0);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < one.bodies.count(); ++i) {
    EXPECT_EQ(one.bodies.position[i].x, three.bodies.position[i].x) << i;
    EXPECT_EQ(one.bodies.velocity[i].x, three.bodies.velocity[i].x) << i;
    outside += std::abs(three.bodies.position[i].x) > 0.01 ? 1 : 0;
  }
  EXPECT_EQ(outside, 0u);
  EXPECT_FALSE(one.wrapped.gained.empty());
  EXPECT_EQ(one.wrapped.gained, three.wrapped.gained);
  EXPECT_FALSE(three.wrapped.escaped);
}

// Ranks move those of their own chunks.
TEST(Boundaries, BodiesOfOtherChunksStay) {
  Scattered all = wrapped_by(1, 0);
  for (std::size_t i = 0; i < all.bodies.count(); ++i) all.bodies.position[i].x += 0.02;
  const Bodies before = all.bodies;
  Team team(1);
  const Cell cell{Vec3::Constant(-0.01), Vec3::Constant(0.01), {true, false, false}};
  wrap(all.bodies, 1, 2, cell, Mat3::Zero(), {}, team);
  for (std::size_t i = 0; i < before.count(); ++i)
    if (i / chunk_bodies == 1) EXPECT_LT(all.bodies.position[i].x, 0.0101);
    else EXPECT_EQ(all.bodies.position[i].x, before.position[i].x);
}

TEST(Boundaries, TheFirstBodyThatEscapesIsReportedFirst) {
  for (const unsigned threads : {1u, 3u}) {
    const Scattered all = wrapped_by(threads, 0.03);
    ASSERT_TRUE(all.wrapped.escaped);
    EXPECT_EQ(all.wrapped.escaped->body, chunk_bodies - 1) << threads;
  }
}

TEST(Boundaries, LeavingBodiesTakeTheirEnergyAlong) {
  State state = two_spheres(0.004);
  set_velocity(state, 1, {0, 3, 4});
  const MotionSettings motion{.gravity = Vec3(0, 0, -10)};
  const auto left =
      leaving(state.bodies, {false, true}, 0.25, [&](std::size_t) -> const MotionSettings& { return motion; });
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].departure.id, 1u);
  EXPECT_EQ(left[0].departure.time, 0.25);
  EXPECT_NEAR(left[0].departure.mass, sphere_mass(), 1e-15 * sphere_mass());
  EXPECT_NEAR(left[0].kinetic, 12.5 * sphere_mass(), 1e-12 * sphere_mass());
  EXPECT_EQ(left[0].potential, 0) << "at height 0";
}

}  // namespace
}  // namespace grit::test::boundaries_tests
