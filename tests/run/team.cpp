#include "contact/team.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

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
    for (const std::size_t chunks : {1, 2, 3, 6, 100}) {
      std::vector<std::atomic<int>> taken(chunks);
      for (int pass = 0; pass < 100; ++pass) team.each(chunks, [&](std::size_t chunk) { ++taken[chunk]; });
      for (const auto& times : taken) EXPECT_EQ(times, 100) << threads << " threads, " << chunks << " chunks";
    }
  }
}

}  // namespace
}  // namespace grit::team_tests
