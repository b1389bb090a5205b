// Ranks save what one process would, and none collects the parts of the others.
#include "ranks/shared_archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "support/thread_ranks.hpp"

namespace grit::test {
namespace {

using Bytes = std::vector<std::byte>;

/// Values by body and lists by chunk, some of them longer than a piece; others know only their own ones.
struct Values {
  static constexpr std::size_t bodies = 9 * chunk_bodies - 100;
  std::vector<double> by_body;
  std::vector<std::vector<std::uint32_t>> by_chunk;
  double common = 0.25;

  static Values of(const Ranks& ranks) {
    Values all;
    all.by_body.assign(bodies, -1), all.by_chunk.resize(chunks_of(bodies));
    for (std::size_t i = 0; i < bodies; ++i)
      if (ranks.owns_body(i)) all.by_body[i] = 0.5 * static_cast<double>(i);
    for (std::size_t chunk = ranks.first(); chunk < ranks.last(); ++chunk) {
      all.by_chunk[chunk].resize(chunk % 3 == 1 ? 0 : 150'000 * chunk);
      std::iota(all.by_chunk[chunk].begin(), all.by_chunk[chunk].end(), static_cast<std::uint32_t>(chunk));
    }
    return all;
  }
  void serialize(SharedArchive& archive) {
    archive(common);
    archive.each_body(by_body.size(), by_body);
    archive.each_chunk(by_chunk.size(), [this](Archive& own, std::size_t chunk) { own(by_chunk[chunk]); });
    archive(common);
  }
};

Bytes saved(Ranks& ranks) {
  ranks.divide(std::vector<double>(chunks_of(Values::bodies), 1.0));
  Archive archive;
  SharedArchive shared(archive, ranks);
  Values::of(ranks).serialize(shared);
  return archive.bytes();
}

TEST(SharedArchive, HasTheBytesOfOneProcess) {
  Ranks one;
  one.resize(chunks_of(Values::bodies));
  const Bytes alone = saved(one);
  EXPECT_GT(alone.size(), 10 * Archive::piece);
  for (const unsigned count : {2u, 4u, 12u})
    on_ranks(count, [&](Communicator& all) {
      Ranks ranks(&all);
      const Bytes found = saved(ranks);
      if (ranks.rank() == 0) EXPECT_TRUE(found == alone) << count;
      else EXPECT_EQ(found.size(), 2 * sizeof(double)) << "what is alike";
    });
}

TEST(SharedArchive, IsSentInPieces) {
  Board board(3);
  const auto work = [&](unsigned rank) {
    ThreadRank own(board, rank);
    Ranks ranks(&own);
    static_cast<void>(saved(ranks));
  };
  {
    std::vector<std::jthread> threads;
    for (unsigned rank = 0; rank < 3; ++rank) threads.emplace_back(work, rank);
  }
  EXPECT_EQ(board.longest_message(), Archive::piece);
}

TEST(SharedArchive, IsRestoredInWholeOnEachRank) {
  Ranks one;
  one.resize(chunks_of(Values::bodies));
  const Bytes alone = saved(one);
  const Values expected = Values::of(one);
  on_ranks(2, [&](Communicator& all) {
    Ranks ranks(&all);
    Archive archive(alone);
    SharedArchive shared(archive, ranks);
    Values found;
    found.by_body.resize(Values::bodies), found.by_chunk.resize(chunks_of(Values::bodies));
    found.serialize(shared);
    EXPECT_TRUE(archive.at_end());
    EXPECT_TRUE(found.by_body == expected.by_body && found.by_chunk == expected.by_chunk);
  });
}

TEST(Archive, PassesItsBytesOnInPieces) {
  std::vector<std::uint32_t> numbers(Archive::piece);  // four pieces, and the number of them
  std::iota(numbers.begin(), numbers.end(), 7u);
  std::vector<std::size_t> lengths;
  Bytes passed;
  Archive pieces([&](std::span<const std::byte> piece) {
    lengths.push_back(piece.size());
    passed.insert(passed.end(), piece.begin(), piece.end());
  });
  Archive whole;
  pieces(numbers), whole(numbers);
  pieces.flush();
  EXPECT_THAT(lengths, testing::ElementsAre(Archive::piece, Archive::piece, Archive::piece, Archive::piece, 8u));
  EXPECT_TRUE(passed == whole.bytes());
}

TEST(Ranks, CollectListsOnTheFirst) {
  on_ranks(3, [](Communicator& all) {
    Ranks ranks(&all);
    const std::vector<double> own(ranks.rank() * 200'000, ranks.rank());
    const std::vector<double> found = ranks.collected(own);
    if (ranks.rank() > 0) {
      EXPECT_TRUE(found.empty());
      return;
    }
    ASSERT_EQ(found.size(), 600'000u);
    EXPECT_EQ(std::ranges::count(found, 1.0), 200'000);
    EXPECT_TRUE(std::ranges::is_sorted(found));
  });
}

}  // namespace
}  // namespace grit::test
