// Candidates at walls that are found again without a search of pairs.
#include "contact/wall_contacts.hpp"

#include <gtest/gtest.h>

#include "two_spheres.hpp"

namespace grit::test::wall_contacts_tests {
namespace {

constexpr double skin = 0.03 * 2 * radius;  // of bodies, and of walls

/// A sphere above a floor, both of which move up and down.
class MovingFloor : public testing::Test {
 protected:
  explicit MovingFloor(double gap = 2.8 * skin) : state_(spheres({{0, 0, radius + gap}})) {
    state_.surfaces.push_back(floor_surface());
    search(state_, passes_);
  }
  /// Both move up by so much [m] in a step; candidates are found again where that is due.
  void move(double sphere, double floor) {
    state_.bodies.position[0].z += sphere;
    state_.surfaces[0].pose.shift.z() += floor;
    set_speed(passes_, std::abs(sphere));
    state_.lists.advance(1, 0, passes_), state_.lists.advance_walls(std::abs(floor));
    ASSERT_FALSE(state_.lists.may_be_due(passes_.ranks()) &&
                 state_.lists.due(state_.bodies, state_.cell, passes_.ranks()));
    if (!state_.lists.due_at_walls()) return;
    state_.lists.begin_search_at_walls(state_.cell, state_.statistics, state_.time.dt, 0);
    state_.wall_contacts.find_candidates(0, state_.bodies, state_.group, state_.surfaces, state_.lists.skins());
  }
  std::size_t contacts() {
    state_.wall_contacts.evaluate(0, *state_.settings.law, state_.bodies, true, state_.surfaces, 0, false,
                                  state_.sum.data(), nullptr);
    return state_.wall_contacts.touching_count();
  }
  State state_;
  Passes passes_{1};
};

TEST_F(MovingFloor, ReachesABodyThatWasNoCandidateAtTheRebuild) {
  EXPECT_FALSE(state_.wall_contacts.has_candidates(0));
  move(0, 1.01 * skin);
  EXPECT_EQ(contacts(), 0u);
  move(0, 0.99 * skin), move(0, 0.99 * skin);
  EXPECT_EQ(contacts(), 1u);
  EXPECT_EQ(state_.lists.rebuilds(), 1u);
}

TEST_F(MovingFloor, ReachesABodyThatComesBackByMoreThanItsSkin) {
  // At the search the gap is 2.6 skins. Then the floor moves up by nearly one, and the body moves down by nearly two:
  // from 0.9 above its place at the rebuild to 0.9 below it.
  EXPECT_FALSE(state_.wall_contacts.has_candidates(0));
  move(0.9 * skin, 1.1 * skin);
  EXPECT_EQ(state_.lists.searches_at_walls(), 1u);
  EXPECT_EQ(contacts(), 0u);
  move(-1.8 * skin, 0.95 * skin);
  EXPECT_EQ(state_.lists.searches_at_walls(), 1u);
  EXPECT_EQ(contacts(), 1u);
}

TEST_F(MovingFloor, LosesCandidatesThatItLeaves) {
  move(0, 2 * skin);
  EXPECT_TRUE(state_.wall_contacts.has_candidates(0));
  move(0, -2 * skin);
  EXPECT_FALSE(state_.wall_contacts.has_candidates(0));
}

}  // namespace
}  // namespace grit::test::wall_contacts_tests
