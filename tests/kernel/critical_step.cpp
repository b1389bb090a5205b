// Which chunks are evaluated again where walls move.
#include "contact/critical_step.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "two_spheres.hpp"

namespace grit::test::critical_step_tests {
namespace {

constexpr double way = 0.05 * radius;
constexpr CriticalStep::Change change{way, std::numeric_limits<double>::infinity()};

/// A chunk of bodies just above a floor, and another one far above it.
std::vector<Vec3> near_and_far() {
  std::vector<Vec3> centres;
  for (const double height : {1.01 * radius, 100 * radius})
    for (std::size_t i = 0; i < chunk_bodies; ++i) centres.emplace_back(3 * radius * static_cast<double>(i), 0, height);
  return centres;
}

class CriticalStepAtWalls : public testing::Test {
 protected:
  CriticalStepAtWalls() {
    state_.surfaces.push_back(floor_surface());
    search(state_, passes_);
  }
  CriticalStep::Instant now() {
    return {.bodies = state_.bodies,
            .pairs = state_.pairs,
            .walls = state_.wall_contacts,
            .surfaces = state_.surfaces,
            .law = *state_.settings.law,
            .shifts = state_.cell.images(),
            .skins = state_.lists.skins(),
            .near = way,
            .ahead = 2 * way,
            .overlap = 0,
            .halo = state_.halo,
            .ranks = passes_.ranks()};
  }
  double find() { return critical_.find(now(), passes_.team()).spring; }
  /// The demand of a body above, with a contact with a body like itself.
  double alone() const { return demand_without_contacts(spheres({Vec3::Zero()}).bodies, *state_.settings.law).spring; }
  double renew() { return critical_.renew(now(), change, passes_.team()).spring; }
  bool due() { return critical_.due(state_.wall_contacts, state_.lists.skins(), change, passes_.ranks()); }
  /// The floor moves far away, and candidates are found there.
  void remove_floor() {
    state_.surfaces[0].pose.shift.z() = -1;
    state_.wall_contacts.rebuild(state_.bodies, state_.group, state_.surfaces, state_.lists.skins(),
                                 state_.settings.fields, {}, passes_.ranks(), passes_.team());
  }
  void lighten(std::size_t body) { state_.bodies.velocity[body].w *= 4; }

  State state_ = spheres(near_and_far());
  Passes passes_{1};
  CriticalStep critical_;
};

TEST_F(CriticalStepAtWalls, IsRenewedOnlyWhereBodiesAreNearThem) {
  const double before = find();
  EXPECT_FALSE(due());
  lighten(chunk_bodies);
  state_.lists.advance_walls(1.1 * way);
  EXPECT_TRUE(due());
  EXPECT_EQ(renew(), before) << "the chunk far from the floor is as it was";
  EXPECT_FALSE(due());
  lighten(0);
  state_.lists.advance_walls(1.1 * way);
  EXPECT_GT(renew(), 1.5 * before);
}

TEST_F(CriticalStepAtWalls, IsRenewedLaterWhereOtherChunksLimitTheStep) {
  const double own = find();
  lighten(chunk_bodies);
  const double shortest = find();
  // Of one body of a pair a new contact demands half of what a pair of such bodies does.
  const double fresh = 0.5 * alone(), ways = 1 + (shortest - own) / (own / 8 + fresh);
  EXPECT_GT(ways, 2);
  EXPECT_LT(ways, 7);
  state_.lists.advance_walls(0.99 * ways * way);
  EXPECT_FALSE(due());
  state_.lists.advance_walls(0.02 * ways * way);
  EXPECT_TRUE(due());
}

TEST_F(CriticalStepAtWalls, IsRenewedWhereOtherChunksLimitTheStepNoLonger) {
  const auto place = [&](double apart) {
    for (std::size_t i = 0; i < 7; ++i) state_.bodies.position[chunk_bodies + i].x = apart * static_cast<double>(i);
  };
  place(2 * radius);
  search(state_, passes_);
  const double before = find();
  state_.lists.advance_walls(1.1 * way);
  EXPECT_FALSE(due());
  place(2.5 * radius);
  passes_.chunks()[1].relative_speed = 10 * way;  // m/s, for a second
  state_.lists.advance(1, 0, passes_);
  EXPECT_TRUE(due());
  EXPECT_LT(renew(), 0.9 * before);
  EXPECT_TRUE(due()) << "the chunk at the floor, though nothing has moved since";
  renew();
  EXPECT_FALSE(due());
}

TEST_F(CriticalStepAtWalls, IsNotDueWhereNoBodyIsNearThem) {
  remove_floor();
  find();
  state_.lists.advance_walls(1.1 * way);
  EXPECT_FALSE(due());
}

TEST_F(CriticalStepAtWalls, IsRenewedOnceMoreWhereTheyHaveLeft) {
  find();
  remove_floor();
  state_.lists.advance_walls(1.1 * way);
  EXPECT_TRUE(due()) << "contacts with the floor may have opened";
  renew();
  state_.lists.advance_walls(1.1 * way);
  EXPECT_FALSE(due());
}

TEST_F(CriticalStepAtWalls, IsRenewedWhereASearchHasFoundBodies) {
  remove_floor();
  find();
  state_.surfaces[0].pose.shift.z() = 0;
  state_.lists.advance_walls(0.1 * way);
  EXPECT_FALSE(due());
  state_.lists.begin_search_at_walls(state_.cell, state_.statistics, state_.time.dt, 0);
  for (std::size_t chunk = 0; chunk < 2; ++chunk)
    state_.wall_contacts.find_candidates(chunk, state_.bodies, state_.group, state_.surfaces, state_.lists.skins());
  EXPECT_TRUE(due()) << "before the floor has moved as far";
  renew();
  EXPECT_FALSE(due());
}

}  // namespace
}  // namespace grit::test::critical_step_tests
