// Bodies that several ranks sort are in the order of one rank.
#include "contact/migration.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "contact/search.hpp"
#include "contact/surroundings.hpp"
#include "support/thread_ranks.hpp"

namespace grit::test {
namespace {

constexpr std::size_t body_count = 7 * chunk_bodies + 40;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

Bodies scattered() {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(0, 1);
  Bodies bodies;
  for (std::size_t i = 0; i < body_count; ++i)
    bodies.add({place(random), place(random), place(random)}, 0.01 + 0.01 * place(random), 1 + place(random), 1,
               static_cast<std::uint8_t>(i % 3));
  bodies.finish(BodyState::displacement);
  return bodies;
}

bool same(const Row& a, const Row& b) { return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w; }

/// Bodies as a rank has them, which knows its own ones only.
Bodies known(Bodies bodies, const Ranks& ranks) {
  for (std::size_t i = 0; i < bodies.count(); ++i) {
    if (ranks.owns_body(i)) continue;
    bodies.position[i] = bodies.velocity[i] = bodies.spin[i] = {unknown, unknown, unknown, unknown};
    bodies.id[i] = 0, bodies.material[i] = 99, bodies.origin[i] = Vec3::Constant(unknown);
  }
  return bodies;
}

class Sorted : public testing::TestWithParam<unsigned> {};

TEST_P(Sorted, LikeByOneRank) {
  const Bodies before = scattered();
  const Cell cell{Vec3::Zero(), Vec3::Ones(), {true, false, true}};
  std::vector<bool> leaves(body_count, false);
  for (std::size_t i = 3; i < body_count; i += 50) leaves[i] = true;
  Team team(1);
  std::vector<std::uint32_t> order = spatial_order(before, cell, team);
  std::erase_if(order, [&](std::uint32_t i) { return leaves[i]; });
  Bodies after = before;
  after.reorder(order, team);
  const Renumbering present(order, body_count);

  on_ranks(GetParam(), [&](Communicator& all) {
    Team own_team(1);
    Ranks ranks(&all);
    ranks.divide(std::vector<double>(chunks_of(body_count), 1.0));
    const std::size_t first = ChunkRange(ranks.first(), body_count).first,
                      last = ChunkRange(ranks.last(), body_count).first;
    Bodies bodies = known(before, ranks);
    std::vector<bool> own_leave(body_count, false);
    for (std::size_t i = first; i < last; ++i) own_leave[i] = leaves[i];
    Migration migration(bodies, own_leave, cell, ranks, own_team);
    ASSERT_EQ(migration.count(), order.size());
    std::vector<double> uneven(chunks_of(order.size()));
    for (std::size_t chunk = 0; chunk < uneven.size(); ++chunk) uneven[chunk] = 1.0 + static_cast<double>(chunk);
    ranks.divide(uneven);
    const Renumbering now = migration.move(bodies, ranks);
    for (std::size_t i = first; i < last; ++i)
      ASSERT_EQ(now(static_cast<std::uint32_t>(i)), present(static_cast<std::uint32_t>(i))) << i;
    ASSERT_EQ(bodies.count(), after.count());
    for (std::size_t i = 0; i < after.count(); ++i) {
      if (!ranks.owns_body(i)) continue;
      ASSERT_EQ(bodies.id[i], after.id[i]) << i;
      EXPECT_TRUE(same(bodies.position[i], after.position[i])) << i;
      EXPECT_TRUE(same(bodies.velocity[i], after.velocity[i])) << i;
      EXPECT_EQ(bodies.material[i], after.material[i]);
      EXPECT_EQ(bodies.origin[i], after.origin[i]);
    }
    EXPECT_TRUE(same(bodies.position[after.count()], after.position[after.count()])) << "the padding";
  });
}

INSTANTIATE_TEST_SUITE_P(Ranks, Sorted, testing::Values(2u, 3u, 7u, 12u));

TEST(Surroundings, HaveWhatIsNear) {
  Bodies all_bodies = scattered();
  Team team(1);
  const Cell cell{Vec3::Zero(), Vec3::Ones(), {true, false, true}};
  all_bodies.reorder(spatial_order(all_bodies, cell, team), team);
  Skins skins;
  skins.reset(std::vector(chunks_of(body_count), 0.005), 0, 0);
  NeighbourSearch all_search;
  all_search.build(all_bodies, cell, skins, team);
  on_ranks(4, [&](Communicator& all) {
    Team own_team(1);
    Ranks ranks(&all);
    ranks.divide(std::vector<double>(chunks_of(body_count), 1.0));
    Bodies bodies = known(all_bodies, ranks);
    Surroundings surroundings;
    surroundings.find(bodies, cell, skins, ranks, own_team);
    NeighbourSearch search;
    search.build(bodies, surroundings.chunks(), cell, skins, own_team);
    for (std::uint32_t i = 0; i < body_count; ++i) {
      if (!ranks.owns_body(i)) continue;
      std::vector<Candidate> found, expected;
      search.neighbours(bodies, i, found);
      all_search.neighbours(all_bodies, i, expected);
      ASSERT_EQ(found.size(), expected.size()) << i;
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].b, expected[k].b);
        EXPECT_EQ(found[k].image, expected[k].image);
        EXPECT_EQ(found[k].gap, expected[k].gap);
      }
    }
  });
}

}  // namespace
}  // namespace grit::test
