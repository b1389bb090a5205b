#include "linear-normal.hpp"

#include <gtest/gtest.h>

using mine::LinearNormal;

TEST(LinearNormal, SetsTwoSpringsInSeries) {
  LinearNormal::Material soft{.stiffness = 1000}, hard{.stiffness = 3000};
  EXPECT_DOUBLE_EQ(LinearNormal::mix({}, soft, hard, {}, false).stiffness, 750);
}
