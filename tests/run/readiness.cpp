#include "contact/readiness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grit {
namespace {

using testing::ElementsAre;

class Evaluation : public testing::Test {
 protected:
  // 0 looks at 1 and 2, 2 looks at 3.
  Evaluation() {
    readiness_.build({{1, 2}, {}, {3}, {}});
    readiness_.restart();
  }
  std::vector<std::size_t> moved_after(std::size_t chunk) {
    std::vector<std::size_t> moved;
    readiness_.evaluated(chunk, [&](std::size_t c) { moved.push_back(c); });
    return moved;
  }
  Readiness readiness_;
};

TEST_F(Evaluation, InRisingOrderLetsEachMoveAtOnce) {
  for (std::size_t chunk = 0; chunk < 4; ++chunk) {
    EXPECT_TRUE(readiness_.waits_for_itself(chunk));
    EXPECT_THAT(moved_after(chunk), ElementsAre(chunk));
  }
}

TEST_F(Evaluation, InFallingOrderHasThemWaitForWhoLooksAtThem) {
  EXPECT_FALSE(readiness_.waits_for_itself(3));
  EXPECT_THAT(moved_after(3), ElementsAre());
  EXPECT_THAT(moved_after(2), ElementsAre(3));
  EXPECT_THAT(moved_after(1), ElementsAre());
  EXPECT_THAT(moved_after(0), ElementsAre(0, 1, 2));
}

TEST_F(Evaluation, BeginsAnew) {
  moved_after(3), moved_after(0);
  readiness_.restart();
  EXPECT_THAT(moved_after(3), ElementsAre());
  EXPECT_THAT(moved_after(0), ElementsAre(0));
}

}  // namespace
}  // namespace grit
