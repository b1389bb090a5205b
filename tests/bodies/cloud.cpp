#include "bodies/cloud.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies/sizes.hpp"
#include "grit/error.hpp"

namespace grit::cloud_tests {
namespace {

const Cell open_cell{Vec3::Constant(-1), Vec3::Constant(1)};

/// The maximum overlap over the sum of radii, over all pairs and images.
double deepest_overlap(const std::vector<Row>& grains, const Cell& cell) {
  double worst = 0;
  for (std::size_t i = 0; i < grains.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      for (int image = 0; image < 27; ++image) {
        if (i == j && image == 13) continue;
        const int turns[] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
        Vec3 between = xyz(grains[i]) - xyz(grains[j]);
        bool there = true;
        for (int k = 0; k < 3; ++k) {
          if (turns[k] == 0) continue;
          there = there && cell.periodic[as_index(k)];
          between[k] += turns[k] * (cell.high[k] - cell.low[k]);
        }
        const double reach = grains[i].w + grains[j].w;
        if (there) worst = std::max(worst, 1 - between.norm() / reach);
      }
  return worst;
}

double solid_fraction(const std::vector<Row>& grains, const Region& box) {
  double solid = 0;
  for (const auto& grain : grains) solid += 4.0 / 3 * std::numbers::pi * grain.w * grain.w * grain.w;
  return solid / box.volume();
}

/// One to ten, for a solid fraction of about 0.3 in the unit cube.
std::vector<double> wide_range(std::size_t count, double largest, Random& random) {
  return draw_diameters(SieveSizes{{0.1 * largest, largest}, {0, 1}}, count, random);
}

TEST(Cloud, GrainsLieInsideAndDoNotOverlap) {
  Random random(1);
  const Region box{Vec3(-1, 0, 0.5), Vec3(0, 1, 1.5)};
  const auto diameters = wide_range(1500, 0.325, random);
  const auto grains = place_at_random(box, open_cell, diameters, random);
  ASSERT_EQ(grains.size(), diameters.size());
  EXPECT_GT(solid_fraction(grains, box), 0.25);
  EXPECT_EQ(deepest_overlap(grains, open_cell), 0);
  for (const auto& grain : grains)
    for (int k = 0; k < 3; ++k) {
      ASSERT_GE(xyz(grain)[k] - grain.w, box.low[k]);
      ASSERT_LE(xyz(grain)[k] + grain.w, box.high[k]);
    }
  std::vector<double> wanted = diameters, placed;
  for (const auto& grain : grains) placed.push_back(2 * grain.w);
  std::sort(wanted.begin(), wanted.end()), std::sort(placed.begin(), placed.end());
  EXPECT_EQ(placed, wanted);
}

TEST(Cloud, GrainsCrossPeriodicSidesAndAvoidImages) {
  Random random(2);
  const Cell cell{Vec3(0, -1, 2), Vec3(1, 0, 3), {true, true, false}};
  const auto grains = place_at_random({cell.low, cell.high}, cell, wide_range(1500, 0.325, random), random);
  EXPECT_LT(deepest_overlap(grains, cell), 1e-14);  // round-off of the shift
  int sticking[3] = {};
  for (const auto& grain : grains)
    for (int k = 0; k < 3; ++k) {
      const double x = xyz(grain)[k];
      ASSERT_TRUE(x >= cell.low[k] && x <= cell.high[k]);
      sticking[k] += x - grain.w < cell.low[k] || x + grain.w > cell.high[k];
    }
  EXPECT_GT(sticking[0], 10);
  EXPECT_GT(sticking[1], 10);
  EXPECT_EQ(sticking[2], 0);
}

TEST(Cloud, WorksInACellOfFewGrains) {
  const Cell cell{Vec3::Zero(), Vec3::Ones(), {true, true, true}};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    const auto grains = place_at_random({cell.low, cell.high}, cell, {0.6, 0.4, 0.3, 0.2, 0.1, 0.05}, random);
    ASSERT_EQ(grains.size(), 6u);
    ASSERT_LT(deepest_overlap(grains, cell), 1e-14) << seed;
  }
  Random random(1);
  EXPECT_EQ(place_at_random({cell.low, cell.high}, cell, {1.0}, random).size(), 1u);  // touches its own image
  EXPECT_TRUE(place_at_random({cell.low, cell.high}, cell, {}, random).empty());
}

TEST(Cloud, KeepsWithinAPartOfAPeriodicCell) {
  Random random(3);
  const Cell cell{Vec3::Zero(), Vec3::Ones(), {true, true, true}};
  const Region part{Vec3(0, 0, 0), Vec3(0.5, 1, 1)};
  for (const auto& grain : place_at_random(part, cell, std::vector<double>(100, 0.1), random)) {
    ASSERT_GE(grain.x - grain.w, 0);
    ASSERT_LE(grain.x + grain.w, 0.5);
  }
}

TEST(Cloud, AvoidsOtherBodies) {
  const Cell cell{Vec3::Zero(), Vec3::Ones(), {true, false, false}};
  const std::vector<Row> others{{0.02, 0.5, 0.5, 0.3}, {0.5, -0.02, 0.5, 0.05}, {0.6, 0.6, 0.6, 0.01}};
  Random random(4);
  auto grains = place_at_random({cell.low, cell.high}, cell, std::vector<double>(300, 0.08), random, others);
  EXPECT_EQ(grains.size(), 300u);
  grains.insert(grains.end(), others.begin(), others.end());
  EXPECT_LT(deepest_overlap(grains, cell), 1e-14);
}

TEST(Cloud, OrderDoesNotRevealTheSize) {
  Random random(5);
  std::vector<double> diameters(1000, 0.02);
  std::fill(diameters.begin(), diameters.begin() + 500, 0.04);
  const auto grains = place_at_random({Vec3::Zero(), Vec3::Ones()}, open_cell, diameters, random);
  const auto large = std::count_if(grains.begin(), grains.begin() + 500, [](const Row& g) { return g.w > 0.015; });
  EXPECT_NEAR(static_cast<double>(large), 250, 4 * std::sqrt(500 * 0.25));
}

TEST(Cloud, PositionsAreUniformOverThePeriodicCell) {
  Random random(6);
  const Cell cell{Vec3::Zero(), Vec3::Ones(), {true, true, true}};
  const auto grains = place_at_random({cell.low, cell.high}, cell, std::vector<double>(20'000, 0.01), random);
  for (int k = 0; k < 3; ++k) {
    double sum = 0;
    for (const auto& grain : grains) sum += xyz(grain)[k] / 20'000;
    EXPECT_NEAR(sum, 0.5, 4 * std::sqrt(1.0 / 12 / 20'000));
  }
}

TEST(Cloud, IsTheSameForTheSameSeedOnly) {
  const auto make = [](std::uint64_t seed) {
    Random random(seed);
    std::vector<double> numbers;
    for (const auto& g : place_at_random({Vec3::Zero(), Vec3::Ones()}, open_cell, wide_range(500, 0.3, random), random))
      numbers.insert(numbers.end(), {g.x, g.y, g.z, g.w});
    return numbers;
  };
  EXPECT_EQ(make(1), make(1));
  EXPECT_NE(make(1), make(2));
}

TEST(Cloud, ReportsTheSolidFractionReachedIfFull) {
  Random random(7);
  const Region box{Vec3::Zero(), Vec3::Ones()};
  try {
    place_at_random(box, open_cell, std::vector<double>(1000, 0.1), random);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::ContainsRegex("only [0-9]+ of 1000 grains fit into the box \\(0 0 0\\)"));
    EXPECT_THAT(error.what(), testing::ContainsRegex("solid fraction 0\\.[23][0-9]+"));
    EXPECT_THAT(error.what(), testing::HasSubstr("use a larger box, or fewer or smaller grains"));
  }
}

TEST(Cloud, RefusesBoxesThatCannotWork) {
  Random random(8);
  const auto message = [&](const Region& box, const Cell& cell) -> std::string {
    try {
      place_at_random(box, cell, {0.5}, random);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const Cell periodic{Vec3::Zero(), Vec3::Ones(), {true, true, true}};
  EXPECT_THAT(message({Vec3::Zero(), Vec3(1, 1, 0.4)}, open_cell),
              testing::HasSubstr("a grain of diameter 0.5 m does not fit into the box (0 0 0) … (  1   1 0.4) m"));
  EXPECT_THAT(message({Vec3::Zero(), Vec3(1, 0, 1)}, open_cell), testing::HasSubstr("is empty or infinite"));
  EXPECT_THAT(message({Vec3(-1, 0, 0), Vec3::Ones()}, periodic), testing::HasSubstr("leaves the periodic cell"));
  EXPECT_EQ(message({Vec3::Zero(), Vec3::Ones()}, periodic), "");
}

}  // namespace
}  // namespace grit::cloud_tests
