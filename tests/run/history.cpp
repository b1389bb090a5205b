// Contact history is kept in searches and reorderings of the bodies.
#include <gtest/gtest.h>

#include "support/memories.hpp"
#include "support/packing.hpp"

namespace grit::test::history_tests {
namespace {

Description packing(double speed = 0.1) {
  Description d =
      description("linear-rolling", {{"contact_modulus", 1e6}, {"twisting_stiffness", 0.3}, {"twisting_limit", 0.1}},
                  jumble({7, 7, 7}, 1e-3, speed, 4));
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][std::string(up ? "low_" : "high_") + "xyz"[axis]] =
          side(axis, up ? 0 : 7e-3, Vec3::Zero(), Vec3::Constant(7e-3), up);
  d["time_step"]["value"] = 2e-6;
  d["guards"] = {{"overlap", 0.5}, {"travel", 0.2}, {"energy", 1}};
  return d;
}

double apart(const Memories& a, const Memories& b) {
  double difference = 0, size = 0;
  for (const auto& [pair, state] : a)
    for (std::size_t f = 0; f < state.size(); ++f) {
      // Shear forces [N] are some thousand times the moments [N m]; each field is compared to its own magnitude.
      const double other = b.contains(pair) ? b.at(pair)[f] : std::numeric_limits<double>::infinity();
      difference = std::max(difference, std::abs(state[f] - other) * (f < 3 ? 1 : 1e3));
      size = std::max(size, std::abs(state[f]));
    }
  return difference / size;
}

TEST(History, IsKeptInASearchAndAReordering) {
  Trial t(packing(3));
  t.step(30);
  std::size_t moved = 0;
  for (int search = 0; search < 17; ++search) {
    const Memories before = memories(t);
    const std::vector<std::uint32_t> order(t.world().ids().begin(), t.world().ids().end());
    const std::uint64_t rebuilds = t.kernel().state().lists.rebuilds();
    t.kernel().request_rebuild();
    t.kernel().find_forces();
    ASSERT_EQ(t.kernel().state().lists.rebuilds(), rebuilds + 1);
    const Memories after = memories(t);
    ASSERT_GT(before.size(), 400u);
    ASSERT_EQ(before.size(), after.size());
    EXPECT_LT(apart(before, after), 1e-13) << search;
    moved += !std::equal(order.begin(), order.end(), t.world().ids().begin());
    t.step(25);
  }
  EXPECT_GE(moved, 2u) << "bodies were reordered";
}

TEST(History, IsKeptWhenTwoBodiesSwapIndices) {
  // An inclined pair crosses the cells by which bodies are ordered, so that their order alternates. On a prescribed
  // path, the two are pressed together and roll.
  const double r = 1e-3, speed = 5, lie = 0.98 * std::sqrt(2) * r;
  std::vector<Grain> grains{{{-0.5 * lie, lie - 2 * r, 0}, r, {0, speed, 0}, {0, 0, 20}},
                            {{0.5 * lie, -2 * r, 0}, r, {0, speed, 0}, {0, 10, 20}},
                            {{9 * r, 9 * r, 9 * r}, r},
                            {{-9 * r, -9 * r, -9 * r}, r}};
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, grains);
  d["engines"]["hold"] = {{"type", "hold"}, {"rotation", "none"}, {"translation", "xyz"}};
  d["time_step"]["value"] = 1e-6;
  Trial steady(d), searching(d);
  std::size_t now_swapped = 0, ever_swapped = 0, never_swapped = 0;
  for (int i = 0; i < 1200; ++i) {
    steady.step();
    searching.kernel().request_rebuild();
    searching.step();
    now_swapped = 0;
    const Memories a = memories(steady), b = memories(searching, &now_swapped);
    (now_swapped > 0 ? ever_swapped : never_swapped) += 1;
    ASSERT_EQ(a.size(), 1u);
    ASSERT_EQ(b.size(), 1u);
    ASSERT_LT(apart(a, b), 1e-11) << i;
  }
  EXPECT_GT(ever_swapped, 50u);
  EXPECT_GT(never_swapped, 50u);
}

TEST(History, IsKeptInASearchAtWalls) {
  // A sphere is held, pressed against a floor that slides under it.
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, {{{0, 0, 0.99e-3}, 1e-3}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["floor"]["motion"]["velocity"] = {0.5, 0.1, 0};
  d["engines"]["hold"] = {{"type", "hold"}, {"rotation", "xyz"}, {"translation", "xyz"}};
  d["time_step"]["value"] = 2e-6;
  Trial at_walls(d), always(d);
  for (int i = 0; i < 1000; ++i) {
    at_walls.step();
    always.kernel().request_rebuild();
    always.step();
    const Memories a = memories(at_walls), b = memories(always);
    ASSERT_EQ(a.size(), 1u);
    ASSERT_EQ(b.size(), 1u);
    ASSERT_LT(apart(a, b), 1e-12) << i;
  }
  EXPECT_EQ(at_walls.kernel().state().lists.rebuilds(), 1u);
  EXPECT_GE(at_walls.kernel().state().lists.searches_at_walls(), 5u);
}

TEST(History, SearchingAtEveryStepOrRarelyGivesTheSamePath) {
  Trial rarely(packing()), always(packing());
  std::size_t swapped = 0;
  for (int i = 0; i < 150; ++i) {
    rarely.step();
    always.kernel().request_rebuild();
    always.step();
  }
  EXPECT_LT(rarely.kernel().state().lists.rebuilds(), 40u);
  EXPECT_GT(always.kernel().state().lists.rebuilds(), 150u);
  double worst = 0;
  for (std::uint32_t id = 0; id < 343; ++id)
    worst = std::max(worst, (rarely.position(id) - always.position(id)).norm() / 1e-3);
  // The order of sums causes round-off, which collisions amplify.
  EXPECT_LT(worst, 1e-11);
  EXPECT_LT(apart(memories(rarely), memories(always, &swapped)), 1e-7);
  EXPECT_GT(swapped, 100u);
}

}  // namespace
}  // namespace grit::test::history_tests
