// How evenly ranks share the work, and what they exchange.
#include "kernel/sharing.hpp"

#include <gtest/gtest.h>

#include "contact/halo.hpp"
#include "contact/search.hpp"
#include "kernel/passes.hpp"
#include "support/thread_ranks.hpp"

namespace grit::test {
namespace {

TEST(Sharing, DividesChunksByTheirRecentTime) {
  on_ranks(2, [](Communicator& all) {
    Passes passes(1, &all);
    passes.resize(4 * chunk_bodies);
    passes.divide();
    EXPECT_EQ(passes.imbalance(), 0);
    const auto spend = [&](std::array<double, 4> seconds) {
      for (std::size_t chunk = passes.ranks().first(); chunk < passes.ranks().last(); ++chunk)
        passes.chunks()[chunk].time_of(StepPhase::contacts) += seconds[chunk];
      passes.divide();
      return passes.ranks().cuts().last(0);
    };
    // 6 s on one rank, 2 s on the other.
    EXPECT_EQ(spend({3, 3, 1, 1}), 1u);
    EXPECT_DOUBLE_EQ(passes.imbalance(), 6.0 / 4 - 1);
    // 1 s and 3 s. With half of the former times: 2.5, 2.5, 1.5, 1.5.
    EXPECT_EQ(spend({1, 1, 1, 1}), 2u);
    EXPECT_DOUBLE_EQ(passes.imbalance(), (6.0 + 3) / (4 + 2) - 1);
    EXPECT_EQ(spend({0, 0, 9, 9}), 3u);
  });
}

// A chain of spheres along x, half of it on each rank.
TEST(Sharing, CountsWhatTwoRanksHaveTwice) {
  const std::size_t count = 4 * chunk_bodies;
  Bodies bodies;
  for (std::size_t i = 0; i < count; ++i) bodies.add({static_cast<double>(i), 0, 0}, 0.51, 1, 1, 0);
  bodies.finish({});
  Skins skins;
  skins.reset(std::vector(chunks_of(count), 0.01), 0, 0);
  const Cell open{Vec3::Constant(-1), Vec3::Constant(static_cast<double>(count)), {false, false, false}, Vec3::Zero()};
  on_ranks(2, [&](Communicator& all) {
    Team team(1);
    NeighbourSearch search;
    search.build(bodies, open, skins, team);
    Ranks ranks(&all);
    ranks.divide(std::vector<double>(chunks_of(count), 1.0));
    const ChunkBoxes boxes(bodies, open, skins, ranks, team);
    ContactTable pairs;
    pairs.rebuild(bodies, search, false, {}, {}, boxes, ranks, team);
    Halo halo;
    halo.build(pairs, ranks);
    EXPECT_EQ(halo.bodies(), 1u);
    EXPECT_EQ(halo.pairs(), count / 2);
    EXPECT_EQ(halo.shared_pairs(), 1u);
    EXPECT_EQ(halo.independent_pairs(), count / 2 - 1);

    SharingRecord record;
    record.steps_end(ranks, 0);
    record.search_ends(ranks, halo, count);
    for (int step = 0; step < 10; ++step) {
      Bodies moved = bodies;
      std::vector<double> of_chunk(chunks_of(count), ranks.rank());
      const auto number = [&](std::size_t chunk) -> double& { return of_chunk[chunk]; };
      halo.begin(moved, number, ranks);
      halo.finish(moved, number, ranks);
      EXPECT_EQ(of_chunk[ranks.rank() == 0 ? 2 : 1], 1.0 - ranks.rank()) << "the chunk beyond";
      EXPECT_FALSE(ranks.any(false));
    }
    record.steps_end(ranks, 10);
    EXPECT_TRUE(ranks.any(ranks.rank() == 1));
    record.search_ends(ranks, halo, count);
    const Sharing found = record.sharing(0.25);
    EXPECT_EQ(found.imbalance, 0.25);
    EXPECT_DOUBLE_EQ(found.neighbours, 2.0 / static_cast<double>(count));
    EXPECT_DOUBLE_EQ(found.shared_pairs, 1.0 / static_cast<double>(count - 1));
    EXPECT_DOUBLE_EQ(found.independent_pairs, 1 - 2.0 / static_cast<double>(count));
    EXPECT_EQ(found.step.messages, 1);
    EXPECT_EQ(found.step.bytes, 10 * sizeof(double));
    EXPECT_EQ(found.step.gathers, 1);
    EXPECT_EQ(found.step.gathered, sizeof(std::uint64_t));
    EXPECT_EQ(found.search.messages, 0);
    EXPECT_EQ(found.search.gathers, 0.5);  // none in the first
  });
}

}  // namespace
}  // namespace grit::test
