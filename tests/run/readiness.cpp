#include "contact/readiness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace grit::readiness_tests {
namespace {

using testing::ElementsAre;

class Evaluation : public testing::Test {
 protected:
  // 0 reads 1 and 2, 2 reads 3.
  Evaluation() {
    readiness_.build({{1, 2}, {}, {3}, {}});
    readiness_.restart();
  }
  /// Whether each may move at once.
  std::vector<bool> in_order(std::initializer_list<std::size_t> chunks) {
    std::vector<bool> may;
    for (const std::size_t chunk : chunks) may.push_back(readiness_.evaluated(chunk));
    return may;
  }
  Readiness readiness_;
};

TEST_F(Evaluation, InAscendingOrderLetsEachMoveAtOnce) {
  EXPECT_THAT(in_order({0, 1, 2, 3}), ElementsAre(true, true, true, true));
}

TEST_F(Evaluation, HoldsBackBodiesThatOthersStillRead) {
  EXPECT_THAT(in_order({3, 1, 0, 2}), ElementsAre(false, false, true, true));
}

TEST_F(Evaluation, StartsAgain) {
  in_order({0, 1, 2, 3});
  readiness_.restart();
  EXPECT_THAT(in_order({3, 2, 1, 0}), ElementsAre(false, false, false, true));
}

}  // namespace
}  // namespace grit::readiness_tests
