// Detection of outliers.
#include "output/strays.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace grit::strays_tests {
namespace {

/// Bodies at 0, 1, … 100 along x, at the same height.
std::vector<double> row() {
  std::vector<double> positions;
  for (int i = 0; i <= 100; ++i) positions.insert(positions.end(), {static_cast<double>(i), 0, 7});
  return positions;
}

std::size_t held(const std::vector<double>& positions, const Far& far) {
  const Fences fences(positions, 1, far);
  std::size_t count = 0;
  for (std::size_t i = 0; i < positions.size() / 3; ++i) count += fences.hold(positions, i);
  return count;
}

TEST(Strays, AreBeyondTheFences) {
  // Without the body at 50 the middle half is from 24 to 75, or from 25 to 76. Fences at three times its width and 5
  // diameters are at -134 and 234.
  for (const auto& [x, strays] : {std::pair(233.0, 0), {235.0, 1}, {-133.0, 0}, {-135.0, 1}}) {
    std::vector<double> positions = row();
    positions[3 * 50] = x;
    EXPECT_EQ(held(positions, far_to_see), 101u - static_cast<std::size_t>(strays)) << x;
    EXPECT_EQ(held(positions, far_to_keep), 101u) << x;
  }
}

TEST(Strays, AreDetectedAlongEachAxis) {
  std::vector<double> positions = row();
  positions[3 * 10 + 2] = 11.9;
  EXPECT_EQ(held(positions, far_to_see), 101u) << "5 diameters above a layer of zero height";
  positions[3 * 10 + 2] = 12.1;
  EXPECT_EQ(held(positions, far_to_see), 100u);
}

TEST(Strays, IncludePositionsThatAreNotFinite) {
  std::vector<double> positions = row();
  positions[0] = std::numeric_limits<double>::quiet_NaN();
  positions[4] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(held(positions, far_to_keep), 99u);
}

TEST(Strays, AreNoneAmongFew) {
  EXPECT_EQ(held({}, far_to_see), 0u);
  EXPECT_EQ(held({1, 2, 3}, far_to_see), 1u);
  EXPECT_EQ(held({0, 0, 0, 1000, 0, 0}, far_to_see), 2u) << "of two, none is an outlier";
}

}  // namespace
}  // namespace grit::strays_tests
