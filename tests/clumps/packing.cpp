// Packings of clumps with walls: forces, averages, time step, threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "grit/error.hpp"
#include "support/clump.hpp"
#include "support/packing.hpp"
#include "support/verified.hpp"

namespace grit::test::packing_tests {
namespace {

const Description stuff{{"density", 2600}, {"contact_modulus", 1e8}, {"friction_angle", 0.5}};

/// Clumps compressed by six walls.
Description pressed(int side_count, double pressure) {
  const double spacing = 2e-3, length = side_count * spacing;
  std::vector<Grain> grains;
  for (int x = 0; x < side_count; ++x)
    for (int y = 0; y < side_count; ++y)
      for (int z = 0; z < side_count; ++z)
        grains.push_back({spacing * Vec3(x + 0.5, y + 0.5, z + 0.5),
                          0.48 * spacing,
                          {0.05 * (x % 2), 0, -0.03 * (z % 2)},
                          {20.0 * x, -30.0 * y, 10.0 * z}});
  Description d = description("linear-rolling", stuff, grains);
  make_clumps(d, boomerang());
  const Vec3 low = Vec3::Zero(), high = Vec3::Constant(length);
  const char* const names[3][2] = {{"left", "right"}, {"front", "back"}, {"bottom", "lid"}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false}) {
      Description& wall = d["walls"][names[axis][up ? 0 : 1]];
      wall = side(axis, up ? low[axis] : high[axis], low, high, up);
      if (!up)
        wall["motion"]["servo"] = {
            {"axis", std::string(1, "xyz"[axis])}, {"pressure", pressure}, {"max_velocity", 0.2}};
    }
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.4}};
  return d;
}

TEST(ClumpPacking, RestsWithItsWeightOnTheFloor) {
  Description d = description("linear-rolling", stuff, {{{0, 0, 1.5e-3}, 1e-3}, {{2.5e-3, 0, 1.5e-3}, 1.2e-3}});
  make_clumps(d, boomerang());
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}};
  Trial trial(d);
  trial.step(80000);
  double weight = 0;
  for (const ClumpView& clump : trial.world().clumps()) weight += 9.81 * clump.mass;
  verify("force on the floor below two clumps at rest over their weight",
         -trial.world().walls().front().force.z() / weight, 1, 1e-6);
  EXPECT_LT(equilibrium(trial.world()).unbalanced_force, 1e-6);
}

/// For a specimen at rest, the stress from contacts is that from the forces on its boundary.
TEST(ClumpPacking, HasTheStressThatItsWallsFeel) {
  Trial trial(pressed(5, 5e4));
  trial.step(80000);
  ASSERT_LT(equilibrium(trial.world()).unbalanced_force, 1e-3);
  const World& world = trial.world();
  Region all{Vec3::Constant(-1e-3), Vec3::Constant(11e-3)};
  Mat3 by_walls = Mat3::Zero();
  for (const Contact& contact : world.contacts())
    if (contact.with_wall) by_walls += contact.force * (xyz(world.positions()[contact.a]) + contact.branch).transpose();
  const Mat3 stress = mean_stress(world, all) * all.volume();
  EXPECT_LT((stress - by_walls).norm(), 1e-3 * by_walls.norm());
}

TEST(ClumpPacking, HasTheVoidRatioOfTheUnions) {
  Description d = description("linear-rolling", stuff, {{{0, 0, 0}, 1e-3}, {{5e-3, 0, 0}, 2e-3}});
  make_clumps(d, boomerang());
  const Trial trial(d);
  double solid = 0;
  for (const ClumpView& clump : trial.world().clumps()) solid += clump.mass / 2600;
  const Region box{Vec3::Constant(-3e-3), Vec3(8e-3, 3e-3, 3e-3)};
  EXPECT_NEAR(void_ratio(trial.world(), box), box.volume() / solid - 1, 1e-9 * box.volume() / solid);
  EXPECT_NEAR(trial.world().mean_diameter(), 3e-3, 1e-15);
  EXPECT_NEAR(trial.world().solid_density(), 2600, 1e-6);
}

TEST(ClumpPacking, IsTheSameBitsForAnyNumberOfThreads) {
  const Description d = pressed(8, 2e4);
  const std::array<unsigned, 3> threads{1, 2, 7};
  std::vector<std::unique_ptr<Trial>> trials;
  for (const unsigned count : threads) trials.push_back(std::make_unique<Trial>(d, count));
  ASSERT_GT(trials.front()->world().ids().size(), 5 * chunk_bodies);
  for (int round = 0; round < 6; ++round) {
    for (auto& trial : trials) trial->step(1000), trial->kernel().request_rebuild();
    for (std::size_t i = 1; i < trials.size(); ++i)
      ASSERT_TRUE(same_bits(trials[0]->kernel(), trials[i]->kernel())) << threads[i] << " threads, round " << round;
  }
  EXPECT_GT(trials.front()->kernel().state().pairs.touching_count(), 150u);
}

/// A rod between two plates, in contact at both ends: the fastest mode is known. The bound must be slightly below its
/// critical step. Above it, the motion grows.
TEST(ClumpPacking, IsStableUpToItsTimeStep) {
  const double r = 1e-3;
  Description d = description("linear-frictional", {{"density", 2600}, {"contact_modulus", 1e7}, {"friction_angle", 0}},
                              {{{0, 0, 0}, r}});
  make_clumps(d, {{"type", "rod"}, {"count", 2}, {"spacing", 0.5}});
  const double end = r * 2 / 3;  // radius of its spheres
  d["walls"]["floor"] = plane({0, 0, -0.999 * end}, Vec3::UnitZ());
  d["walls"]["lid"] = plane({0, 0, 0.999 * end}, -Vec3::UnitZ());
  d["bodies"]["grains"]["source"]["bodies"][0]["velocity"] = {0, 0, 1e-6};
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  const auto grows = [&](double step) {
    Description at = d;
    at["time_step"] = {{"value", step}, {"allow_unstable", true}};
    Trial trial(at);
    try {
      trial.step(4000);
    } catch (const Error&) {
      return true;
    }
    return trial.world().clumps().front().velocity.norm() > 1e-4;
  };
  const Trial trial([&] {
    Description at = d;
    at["time_step"]["safety"] = 0.5;
    return at;
  }());
  const ClumpView clump = trial.world().clumps().front();
  // Four springs k = E r: vertical motion 4 k / m, rotation about the intermediate axis 4 k a² / I, a the arm of an
  // end.
  const double k = 1e7 * end, arm = r / 3;
  const double fastest = std::max(4 * k / clump.mass, 4 * k * arm * arm / clump.inertia[2]);
  const double limit = 2 / std::sqrt(fastest), bound = trial.kernel().critical_time_step();
  EXPECT_LE(bound, limit);
  EXPECT_GE(bound, 0.5 * limit);
  EXPECT_FALSE(grows(0.99 * limit));
  EXPECT_TRUE(grows(1.01 * limit));
}

TEST(ClumpPacking, RefusesACellInWhichAClumpWouldMeetItself) {
  Description d = description("linear-rolling", stuff, {{Vec3(1e-3, 3e-3, 3e-3), 1e-3}});
  make_clumps(d, {{"type", "rod"}, {"count", 10}, {"spacing", 0.9}});
  d["domain"] = {{"low", {0, 0, 0}}, {"high", {2e-3, 6e-3, 6e-3}}, {"periodic", {true, true, true}}};
  try {
    Trial trial(d);
    FAIL() << "it ran";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("twice the reach of the largest body"));
  }
}

}  // namespace
}  // namespace grit::test::packing_tests
