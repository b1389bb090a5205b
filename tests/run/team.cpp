#include "threads/team.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "grit/error.hpp"

namespace grit::team_tests {
namespace {

TEST(Team, ForwardsExceptionsAndContinues) {
  for (const unsigned threads : {1u, 3u}) {
    Team team(threads);
    auto faulty = [](std::size_t chunk) {
      if (chunk == 50) throw std::runtime_error("chunk 50");
    };
    EXPECT_THROW(team.each(100, faulty), std::runtime_error) << threads;
    std::atomic<int> done = 0;
    team.each(100, [&](std::size_t) { ++done; });
    EXPECT_EQ(done, 100) << threads;
  }
}

TEST(Team, TakesEachChunkOnce) {
  for (const unsigned threads : {1u, 2u, 7u}) {
    Team team(threads);
    for (const std::size_t chunks : {1u, 2u, 3u, 6u, 100u}) {
      std::vector<std::atomic<int>> taken(chunks);
      for (int pass = 0; pass < 100; ++pass) team.each(chunks, [&](std::size_t chunk) { ++taken[chunk]; });
      for (const auto& times : taken) EXPECT_EQ(times, 100) << threads << " threads, " << chunks << " chunks";
    }
  }
}

TEST(Team, RefusesMoreChunksThanItsTicketsHold) {
  constexpr std::size_t most = (std::size_t{1} << 20) - 1;
  Team team(2);
  std::atomic<std::size_t> done = 0;
  auto count = [&](std::size_t) { done.fetch_add(1, std::memory_order_relaxed); };
  team.each(most, count);
  EXPECT_EQ(done, most);
  EXPECT_THAT(
      [&] { team.each(most + 1, count); },
      testing::ThrowsMessage<Error>(testing::HasSubstr(
          "found 1048576 chunks of bodies; allowed with several threads are up to 1048575 of 256 bodies each")));
  EXPECT_EQ(done, most);
}

}  // namespace
}  // namespace grit::team_tests
