#include "ranks/ranks.hpp"

#include <gtest/gtest.h>

#include <mutex>

#include "support/thread_ranks.hpp"

namespace grit::test {
namespace {

TEST(Cuts, DivideByWeight) {
  const std::vector<double> weights{1, 1, 1, 1, 4, 4};
  const Cuts cuts(3, weights);
  EXPECT_EQ(cuts.first(0), 0u);
  EXPECT_EQ(cuts.first(1), 4u);
  EXPECT_EQ(cuts.first(2), 5u);
  EXPECT_EQ(cuts.last(2), 6u);
  EXPECT_EQ(cuts.owner(3), 0u);
  EXPECT_EQ(cuts.owner(5), 2u);
}

TEST(Cuts, WithoutWeightsAreEqual) {
  const Cuts cuts(2, std::vector<double>(4, 0.0));
  EXPECT_EQ(cuts.first(1), 2u);
}

TEST(Cuts, MoreRanksThanChunks) {
  const Cuts cuts(4, std::vector<double>(2, 1.0));
  std::size_t owned = 0;
  for (unsigned r = 0; r < 4; ++r) owned += cuts.last(r) - cuts.first(r);
  EXPECT_EQ(owned, 2u);
  for (std::size_t chunk = 0; chunk < 2; ++chunk) EXPECT_TRUE(cuts.owns(cuts.owner(chunk), chunk));
}

TEST(Ranks, CompleteByChunkAndByBody) {
  on_ranks(3, [](Communicator& all) {
    Ranks ranks(&all);
    const std::size_t bodies = 5 * chunk_bodies - 100;
    ranks.divide(std::vector<double>(5, 1.0));
    std::vector<int> by_chunk(5, -1), by_body(bodies + 1, -1);
    for (std::size_t c = ranks.first(); c < ranks.last(); ++c) by_chunk[c] = static_cast<int>(10 * c);
    for (std::size_t i = 0; i < bodies; ++i)
      if (ranks.owns_body(i)) by_body[i] = static_cast<int>(i);
    ranks.complete(by_chunk), ranks.complete_bodies(by_body, bodies);
    for (std::size_t c = 0; c < 5; ++c) EXPECT_EQ(by_chunk[c], static_cast<int>(10 * c));
    for (std::size_t i = 0; i < bodies; ++i) ASSERT_EQ(by_body[i], static_cast<int>(i));
    EXPECT_EQ(by_body[bodies], -1);  // the padding is everyone's own
  });
}

TEST(Ranks, JoinListsInTheirOrder) {
  on_ranks(3, [](Communicator& all) {
    Ranks ranks(&all);
    const std::vector<unsigned> own(ranks.rank(), ranks.rank());
    EXPECT_EQ(ranks.all(own), (std::vector<unsigned>{1, 2, 2}));
    EXPECT_EQ(ranks.each(ranks.rank()), (std::vector<unsigned>{0, 1, 2}));
    EXPECT_TRUE(ranks.any(ranks.rank() == 1));
    EXPECT_FALSE(ranks.any(false));
  });
}

TEST(Ranks, ExchangeLists) {
  on_ranks(3, [](Communicator& all) {
    Ranks ranks(&all);
    std::vector<std::vector<unsigned>> to(3);
    for (unsigned r = 0; r < 3; ++r) to[r].assign(ranks.rank() + r, 10 * ranks.rank() + r);
    const auto from = ranks.exchange(to);
    for (unsigned r = 0; r < 3; ++r) EXPECT_EQ(from[r], std::vector<unsigned>(ranks.rank() + r, 10 * r + ranks.rank()));
  });
}

TEST(Ranks, OneNeedsNoCommunicator) {
  Ranks ranks;
  ranks.divide(std::vector<double>(3, 1.0));
  EXPECT_EQ(ranks.last(), 3u);
  EXPECT_FALSE(ranks.several());
  EXPECT_EQ(ranks.all(std::vector{1, 2}), (std::vector{1, 2}));
  EXPECT_TRUE(ranks.any(true));
}

}  // namespace
}  // namespace grit::test
