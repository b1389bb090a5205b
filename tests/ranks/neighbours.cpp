// What a rank finds of pairs with lower bodies of others is what those find of them.
#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "contact/chunk_boxes.hpp"
#include "contact/search.hpp"
#include "contact/spatial_order.hpp"

namespace grit::test {
namespace {

constexpr double side = 1, skin = 0.01;

Bodies scattered(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, side), size(0.01, 0.05);
  Bodies bodies;
  for (std::size_t i = 0; i < count; ++i)
    bodies.add({place(random), place(random), place(random)}, size(random), 1, 1, 0);
  bodies.finish({});
  return bodies;
}

Skins even_skins(const Bodies& bodies) {
  Skins skins;
  skins.reset(std::vector(chunks_of(bodies.count()), skin), 0, 0);
  return skins;
}

using Found = std::tuple<std::uint32_t, std::uint32_t, float, std::uint8_t>;
std::vector<Found> sorted(const std::vector<Candidate>& candidates) {
  std::vector<Found> all;
  for (const Candidate& c : candidates) all.emplace_back(c.a, c.b, c.gap, c.image);
  std::ranges::sort(all);
  return all;
}

class Neighbours : public testing::TestWithParam<Vec3> {};

TEST_P(Neighbours, BelowAreThoseThatOthersFind) {
  Bodies bodies = scattered(1500);
  const Cell cell{.low = Vec3::Zero(),
                  .high = Vec3::Constant(side),
                  .periodic = {true, true, true},
                  .strain_rate = Vec3::Zero(),
                  .tilt = GetParam()};
  Team team(1);
  bodies.reorder(spatial_order(bodies, cell, team), team);
  const Skins skins = even_skins(bodies);
  NeighbourSearch search;
  search.build(bodies, cell, skins, team);
  const auto below = static_cast<std::uint32_t>(3 * chunk_bodies), count = static_cast<std::uint32_t>(bodies.count());
  std::vector<Candidate> theirs, own;
  for (std::uint32_t i = 0; i < below; ++i) search.neighbours(bodies, i, theirs);
  std::erase_if(theirs, [&](const Candidate& c) { return c.b < below; });
  for (std::uint32_t i = below; i < count; ++i) search.neighbours_below(bodies, i, below, own);
  ASSERT_GT(own.size(), 100u);
  EXPECT_EQ(sorted(own), sorted(theirs));

  Ranks alone;
  alone.resize(chunks_of(count));
  const ChunkBoxes boxes(bodies, cell, skins, alone, team);
  const auto near = boxes.near_below(3, chunks_of(count));
  for (const Candidate& c : own) {
    EXPECT_TRUE(boxes.near(c.a / chunk_bodies, c.b / chunk_bodies));
    EXPECT_TRUE(std::ranges::find(near, c.a / chunk_bodies) != near.end());
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, Neighbours, testing::Values(Vec3(0, 0, 0), Vec3(0.3, 0.1, -0.2)),
                         [](const auto& one) { return one.index == 0 ? "Straight" : "Skewed"; });

ChunkBoxes boxes_of(const Bodies& bodies, const Cell& cell) {
  Team team(1);
  Ranks alone;
  alone.resize(chunks_of(bodies.count()));
  return {bodies, cell, even_skins(bodies), alone, team};
}

TEST(ChunkBoxes, TellFarChunksFromNearOnes) {
  Bodies bodies;
  for (const double at : {0.0, 5.0, 9.9})
    for (std::size_t i = 0; i < chunk_bodies; ++i) bodies.add({at, 0, 0}, 0.1, 1, 1, 0);
  bodies.finish({});
  const Cell open{Vec3::Constant(-100), Vec3::Constant(100), {false, false, false}, Vec3::Zero()};
  const Cell along_x{Vec3(0, -100, -100), Vec3(10, 100, 100), {true, false, false}, Vec3::Zero()};
  EXPECT_FALSE(boxes_of(bodies, open).near(0, 2));
  EXPECT_TRUE(boxes_of(bodies, along_x).near(0, 2)) << "across the periodic side";
  EXPECT_FALSE(boxes_of(bodies, along_x).near(0, 1));
  EXPECT_EQ(boxes_of(bodies, along_x).near_below(2, 3), std::vector<std::size_t>{0});
}

TEST(ChunkBoxes, FollowTheImagesOfASkewedCell) {
  Bodies bodies;
  for (const Vec3& at : {Vec3(5, 5, 0.05), Vec3(8, 5, 9.95), Vec3(5, 5, 9.95)})
    for (std::size_t i = 0; i < chunk_bodies; ++i) bodies.add(at, 0.1, 1, 1, 0);
  bodies.finish({});
  const Cell skewed{Vec3::Zero(), Vec3::Constant(10), {true, true, true}, Vec3::Zero(), Vec3::Zero(), Vec3(0, 3, 0)};
  EXPECT_TRUE(boxes_of(bodies, skewed).near(0, 1)) << "the image across z is 3 along x";
  EXPECT_FALSE(boxes_of(bodies, skewed).near(0, 2));
}

}  // namespace
}  // namespace grit::test
