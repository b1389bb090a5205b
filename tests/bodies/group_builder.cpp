// Bodies of one description that get the masses of another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bodies/group_builder.hpp"
#include "support/clump.hpp"

namespace grit::test::group_builder_tests {
namespace {

/// Two spinning grains of different sizes.
Description two_grains(double density, bool clumps) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e7}, {"density", density}},
                              {{{0, 0, 0}, 1e-3, {0, 1, 0}, {3, -5, 7}}, {{9e-3, 0, 0}, 2e-3, {0, 0, 2}, {-1, 4, 2}}});
  if (clumps) make_clumps(d, boomerang());
  return d;
}

struct Made {
  explicit Made(const Description& plain) : scene(scene_of(plain)), live(scene) {}
  Bodies bodies() const { return make_bodies(live.now(), live.components(), {}); }
  GroupBuilder builder() const {
    return {live.now(), live.now().bodies.at("grains"), live.components().body_kinds.at("grains")};
  }
  Scene scene;
  LiveScene live;
};

void expect_masses_of(double now, double before, bool clumps) {
  const Made made(two_grains(now, clumps));
  const Bodies expected = made.bodies();
  Bodies bodies = Made(two_grains(before, clumps)).bodies();
  for (std::uint8_t& material : bodies.material) material = 17;
  for (std::size_t i = 0; i < bodies.count(); ++i) made.builder().take_over(bodies, i);
  ASSERT_EQ(bodies.count(), expected.count());
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    EXPECT_EQ(bodies.velocity[i].w, expected.velocity[i].w);
    EXPECT_EQ(bodies.spin[i].w, expected.spin[i].w);
    EXPECT_EQ(bodies.material[i], expected.material[i]);
    EXPECT_EQ(xyz(bodies.velocity[i]), xyz(expected.velocity[i]));
    EXPECT_EQ(xyz(bodies.spin[i]), xyz(expected.spin[i]));
  }
  ASSERT_EQ(bodies.clumps.clump.size(), expected.clumps.clump.size());
  ASSERT_EQ(bodies.clumps.clump.size(), clumps ? 2u : 0u);
  for (std::size_t c = 0; c < bodies.clumps.clump.size(); ++c) {
    const Clump &clump = bodies.clumps.clump[c], &wanted = expected.clumps.clump[c];
    EXPECT_EQ(clump.inverse_mass, wanted.inverse_mass);
    EXPECT_EQ(clump.inertia, wanted.inertia);
    EXPECT_LT((clump.momentum - wanted.momentum).norm(), 1e-13 * wanted.momentum.norm());
    EXPECT_EQ(clump.spin, wanted.spin);
  }
}

TEST(GroupBuilder, TakesOverBodiesOfAnotherDensity) {
  for (const bool clumps : {false, true}) {
    SCOPED_TRACE(clumps ? "clumps" : "spheres");
    expect_masses_of(5200, 2600, clumps);
  }
}

/// The index of a material in a body has 8 bits.
TEST(GroupBuilder, RefusesAMaterialWhoseIndexABodyCannotHold) {
  const Made made(two_grains(2600, false));
  SceneDescription scene = made.live.now();
  const auto build = [&](std::size_t groups) {
    scene.bodies.clear(), scene.materials.clear();
    for (std::size_t i = 0; i < groups; ++i) {
      const std::string name = "m" + std::to_string(1000 + i);
      scene.materials[name].density = 2600;
      scene.bodies.try_emplace(name, installed()).first->second.material = name;
    }
    const auto& [last, group] = *scene.bodies.rbegin();
    Bodies bodies;
    GroupBuilder(scene, group, made.live.components().body_kinds.at("grains"))
        .add(bodies, Vec3::Zero(), 1e-3, Eigen::Quaterniond::Identity(), Vec3::Zero(), Vec3::Zero());
    return bodies.material.front();
  };
  EXPECT_EQ(build(256), 255);
  EXPECT_THAT([&] { build(257); }, testing::ThrowsMessage<Error>(testing::HasSubstr(
                                       "found materials of bodies with the index 256; allowed are up to 256 of them")));
}

/// A sample that continues unchanged keeps its last bits.
TEST(GroupBuilder, KeepsTheBitsOfBodiesOfTheSameGroup) {
  for (const bool clumps : {false, true}) {
    const Made made(two_grains(2600, clumps));
    const Bodies before = made.bodies();
    Bodies bodies = made.bodies();
    for (std::size_t i = 0; i < bodies.count(); ++i) made.builder().take_over(bodies, i);
    for (std::size_t i = 0; i < bodies.count(); ++i) EXPECT_EQ(bodies.spin[i].w, before.spin[i].w);
    for (std::size_t c = 0; c < bodies.clumps.clump.size(); ++c)
      EXPECT_EQ(bodies.clumps.clump[c].momentum, before.clumps.clump[c].momentum);
  }
}

}  // namespace
}  // namespace grit::test::group_builder_tests
