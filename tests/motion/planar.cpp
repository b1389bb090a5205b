// Planar motion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/error.hpp"
#include "support/clump.hpp"

namespace grit::test {
namespace {

const Description stuff{{"density", 2600}, {"contact_modulus", 1e7}};

TEST(Planar, KeepsBodiesInTheirPlane) {
  Description d =
      description("linear-rolling", stuff,
                  {{{0, 0, 1e-3}, 1e-3, {0.3, 0.2, 0}, {10, 20, 30}}, {{2.2e-3, 1e-4, 1.3e-3}, 1e-3, {-0.3, 0, -0.1}}});
  d["walls"]["floor"] = plane({0, 0, 0}, Vec3(0, 0.1, 1).normalized());
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 3, -9.81}}};
  d["engines"]["planar"] = {{"type", "planar"}, {"normal", "y"}};
  Trial trial(d);
  trial.step(3000);
  EXPECT_EQ(trial.position(0).y(), 0);
  EXPECT_EQ(trial.position(1).y(), 1e-4);
  for (const std::uint32_t id : {0u, 1u}) {
    const Row spin = trial.world().spins()[index_of(trial.world(), id)];
    EXPECT_EQ(spin.x, 0);
    EXPECT_EQ(spin.z, 0);
  }
  EXPECT_NE(trial.spin(0).y(), 0);
  EXPECT_GT((trial.position(0) - Vec3(0, 0, 1e-3)).norm(), 1e-4);
}

/// If all forces lie in the plane already, results are identical.
TEST(Planar, ChangesNothingWhereAllIsInThePlaneAlready) {
  Description d = description("linear-rolling", stuff,
                              {{{0, 0, 0.999e-3}, 1e-3, {0.3, 0, 0}}, {{2.1e-3, 0, 0.999e-3}, 1e-3, {-0.3, 0, 0}}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  Trial free(d);
  d["engines"]["planar"] = {{"type", "planar"}};
  Trial planar(d);
  free.step(3000), planar.step(3000);
  for (const std::uint32_t id : {0u, 1u}) EXPECT_EQ((free.position(id) - planar.position(id)).norm(), 0);
}

TEST(Planar, RefusesClumps) {
  Description d = description("linear-rolling", stuff, {{{0, 0, 0}, 1e-3}});
  make_clumps(d, boomerang());
  d["engines"]["planar"] = {{"type", "planar"}};
  try {
    Trial trial(d);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("clumps rotate about all axes"));
  }
}

TEST(Planar, CloudLiesInTheMiddle) {
  Description d = description("linear-rolling", stuff, {{{0, 0, 0}, 1e-3}});
  d["bodies"]["grains"]["source"] = {{"type", "cloud"},
                                     {"low", {0, 0, 0}},
                                     {"high", {0.02, 0.002, 0.02}},
                                     {"count", 50},
                                     {"plane_normal", "y"},
                                     {"sizes", {{"type", "uniform"}, {"smallest", 1e-3}, {"largest", 2e-3}}}};
  d["engines"]["planar"] = {{"type", "planar"}};
  const Trial trial(d);
  ASSERT_EQ(trial.world().ids().size(), 50u);
  for (const Row& body : trial.world().positions()) EXPECT_EQ(body.y, 0.001);
}

}  // namespace
}  // namespace grit::test
