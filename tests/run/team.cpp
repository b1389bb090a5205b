#include "contact/team.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace grit {
namespace {

TEST(Team, HandsOnWhatWorkThrowsAndWorksOn) {
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

}  // namespace
}  // namespace grit
