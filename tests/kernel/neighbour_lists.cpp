#include "kernel/neighbour_lists.hpp"

#include <gtest/gtest.h>

#include "two_spheres.hpp"

namespace grit::test::neighbour_lists_tests {
namespace {

constexpr double least_skin = 0.03 * 2 * radius;

class Lists : public testing::Test {
 protected:
  Lists() {
    state_.time.dt = 1e-6;
    search(state_, passes_);
  }
  bool due() {
    return state_.lists.requested() ||
           (state_.lists.may_be_due(passes_.ranks()) && state_.lists.due(state_.bodies, state_.cell, passes_.ranks()));
  }

  State state_ = two_spheres(0.004);
  Passes passes_{1};
};

TEST_F(Lists, AreDueAtFirst) { EXPECT_TRUE(NeighbourLists().requested()); }

TEST_F(Lists, BodiesAtRestGetTheLeastSkin) {
  EXPECT_DOUBLE_EQ(state_.lists.skins().of_chunk(0), least_skin);
  EXPECT_EQ(state_.lists.rebuilds(), 1u);
  EXPECT_FALSE(due());
}

TEST_F(Lists, FastBodiesGetWiderSkins) {
  set_velocity(state_, 0, {2, 0, 0});
  search(state_, passes_);
  EXPECT_NEAR(state_.lists.skins().of_chunk(0), 100 * 1e-6 * 2, 1e-15) << "for 100 steps";
}

TEST_F(Lists, AreDueOnceABodyHasUsedUpItsSkin) {
  set_speed(passes_, 0.9 * least_skin);
  state_.bodies.position[0].y += 0.9 * least_skin;
  state_.lists.advance(1, 0, passes_);
  EXPECT_FALSE(due());
  state_.bodies.position[0].y += 0.2 * least_skin;
  state_.lists.advance(1, 0, passes_);
  EXPECT_TRUE(due());
}

TEST_F(Lists, AreNotDueWhereABodyHasComeBack) {
  set_speed(passes_, 0.9 * least_skin);
  for (int i = 0; i < 5; ++i) state_.lists.advance(1, 0, passes_);
  EXPECT_FALSE(due()) << "its true distance is 0";
}

TEST_F(Lists, AreDueAtWallsAloneOnceAWallHasUsedUpItsSkin) {
  EXPECT_FALSE(state_.lists.due_at_walls());
  state_.lists.advance_walls(1.1 * least_skin);
  EXPECT_FALSE(due());
  EXPECT_TRUE(state_.lists.due_at_walls());
  state_.lists.begin_search_at_walls(state_.cell, state_.statistics, state_.time.dt, 2);
  EXPECT_FALSE(state_.lists.due_at_walls());
  EXPECT_NEAR(state_.lists.skins().of_walls(), 100 * 1e-6 * 2, 1e-15) << "for 100 steps";
  EXPECT_DOUBLE_EQ(state_.lists.skins().walls_walked(), 1.1 * least_skin) << "since the rebuild";
  EXPECT_EQ(state_.lists.searches_at_walls(), 1u);
  EXPECT_EQ(state_.lists.rebuilds(), 1u);
}

TEST_F(Lists, SkinsAtWallsIncludeTheWayBack) {
  set_speed(passes_, 0.4 * least_skin);
  state_.bodies.position[0].y += 0.4 * least_skin;
  state_.lists.advance(1, 0, passes_);
  EXPECT_DOUBLE_EQ(state_.lists.skins().at_walls(0), least_skin);
  state_.lists.begin_search_at_walls(state_.cell, state_.statistics, state_.time.dt, 0);
  EXPECT_DOUBLE_EQ(state_.lists.skins().at_walls(0), 1.4 * least_skin);
  EXPECT_DOUBLE_EQ(state_.lists.skins().of_chunk(0), least_skin) << "for neighbours it stays";
  EXPECT_DOUBLE_EQ(state_.lists.furthest(passes_), 0.4 * least_skin);
}

TEST_F(Lists, AreDueOnRequest) {
  state_.lists.request_rebuild();
  EXPECT_TRUE(due());
}

TEST_F(Lists, AreDueOnceStrainHasUsedUpTheSkins) {
  set_speed(passes_, 0);
  state_.lists.advance(1, 1.9 * least_skin, passes_);
  EXPECT_FALSE(due()) << "two bodies share it";
  state_.lists.advance(1, 0.2 * least_skin, passes_);
  EXPECT_TRUE(due());
}

TEST_F(Lists, AShortestPeriodIsTwiceTheReach) {
  EXPECT_DOUBLE_EQ(NeighbourLists::shortest_period(state_.bodies, state_.statistics, {}), 4 * (radius + least_skin));
}

}  // namespace
}  // namespace grit::test::neighbour_lists_tests
