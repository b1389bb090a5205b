// The neighbour search misses no pair: against brute force over all pairs, and at each step of a run with fast grains.
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <tuple>

#include "support/packing.hpp"

namespace grit::test::neighbours_tests {
namespace {

using Pair = std::tuple<std::uint32_t, std::uint32_t, int>;  // a < b by index, image of b

/// All pairs closer than their skins, by brute force.
std::set<Pair> brute_force(std::span<const Row> x, const Cell& cell, const Skins& skins) {
  std::set<Pair> pairs;
  for (int image = 0; image < (cell.skewed() ? all_images : straight_images); ++image) {
    const auto shift = image_shift(static_cast<std::uint8_t>(image));
    Vec3 by = Vec3::Zero();
    bool there = true;
    for (int k = 0; k < 3; ++k)
      if (shift[k] != 0) by += shift[k] * cell.period(k), there = there && cell.periodic[k];
    if (!there) continue;
    for (std::uint32_t a = 0; a < x.size(); ++a)
      for (std::uint32_t b = a + 1; b < x.size(); ++b)
        if ((xyz(x[b]) + by - xyz(x[a])).norm() < x[a].w + x[b].w + skins.of_body(a) + skins.of_body(b))
          pairs.emplace(a, b, image);
  }
  return pairs;
}

/// Radii over a decade, about as many of each size in volume; every fourth body is on a side, an edge or a corner.
Bodies scattered(std::size_t count, const Vec3& low, const Vec3& high, double smallest, Random& random) {
  Bodies bodies;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 x;
    for (int k = 0; k < 3; ++k) {
      x[k] = low[k] + random.uniform() * (high[k] - low[k]);
      if (i % 4 == 0 && random.uniform() < 0.6)
        x[k] = random.uniform() < 0.5 ? low[k] : std::nextafter(high[k], low[k]);
    }
    bodies.add(x, smallest * std::pow(10, random.uniform()), 1, 1, 0);
  }
  bodies.finish({});
  return bodies;
}

TEST(NeighbourSearch, FindsWhatBruteForceFinds) {
  Random random(11);
  for (int axes = 0; axes < 8; ++axes)
    for (const std::vector<double>& skin : {std::vector{0.0, 0.0, 0.0}, std::vector{0.02, 0.0, 0.07}}) {
      const Vec3 low(-1, 2, 0.5), high = low + Vec3(4.3, 5.1, 6.7);
      Cell cell{low, high};
      for (int k = 0; k < 3; ++k) cell.periodic[k] = (axes >> k & 1) != 0;
      const Bodies bodies = scattered(700, low, high, 0.1, random);
      NeighbourSearch search;
      Skins skins;
      skins.reset(skin, 0, 0);
      search.build(bodies, cell, skins);
      std::vector<Candidate> found;
      for (std::uint32_t i = 0; i < bodies.count(); ++i) search.neighbours(bodies, i, found);
      std::set<Pair> pairs;
      for (const Candidate& c : found) {
        EXPECT_TRUE(pairs.emplace(c.a, c.b, c.image).second) << "found twice";
        const Vec3 branch = xyz(bodies.position[c.b]) - xyz(bodies.position[c.a]);
        if (c.image == 0) {
          const double gap = branch.norm() - bodies.position[c.a].w - bodies.position[c.b].w;
          EXPECT_EQ(c.touching(), gap < 0);
          if (!c.touching()) {
            EXPECT_LE(c.gap, gap);
            EXPECT_GE(c.gap, gap * (1 - 1e-6));
          }
        }
      }
      const auto all = brute_force({bodies.position.data(), bodies.count()}, cell, skins);
      EXPECT_EQ(pairs, all) << "periodic axes " << axes << ", skins up to " << skins.largest();
      EXPECT_GT(all.size(), 700u);
    }
}

TEST(NeighbourSearch, FindsWhatBruteForceFindsInASkewedCell) {
  Random random(12);
  std::set<int> images;
  const Vec3 sides(4.3, 5.1, 6.7);
  for (const Vec3& share : {Vec3(0.5, 0.5, 0.5), Vec3(-0.5, -0.5, 0.5), Vec3(0.3, -0.4, 0), Vec3(0, 0.5, -0.2)})
    for (const std::vector<double>& skin : {std::vector{0.0, 0.0, 0.0}, std::vector{0.02, 0.0, 0.07}})
      for (const double smallest : {0.1, 0.02}) {
        const Vec3 low(-1, 2, 0.5), high = low + sides;
        Cell cell{low, high, {true, true, true}};
        cell.tilt = share.cwiseProduct(Vec3(sides.x(), sides.x(), sides.y()));
        const Bodies bodies = scattered(700, low, high, smallest, random);
        NeighbourSearch search;
        Skins skins;
        skins.reset(skin, 0, 0);
        search.build(bodies, cell, skins);
        std::vector<Candidate> found;
        for (std::uint32_t i = 0; i < bodies.count(); ++i) search.neighbours(bodies, i, found);
        std::set<Pair> pairs;
        for (const Candidate& c : found) {
          EXPECT_TRUE(pairs.emplace(c.a, c.b, c.image).second) << "found twice";
          images.insert(c.image);
        }
        EXPECT_EQ(pairs, brute_force({bodies.position.data(), bodies.count()}, cell, skins)) << share.transpose();
      }
  EXPECT_GT(*images.rbegin(), straight_images) << "two periods along x, too";
}

TEST(NeighbourSearch, NumbersImagesByTheirShift) {
  std::set<std::array<int, 3>> shifts;
  for (std::uint8_t image = 0; image < all_images; ++image) {
    const auto shift = image_shift(image);
    EXPECT_EQ(image_with(shift), image);
    EXPECT_LE(std::abs(shift[0]), 2);
    shifts.insert(shift);
  }
  EXPECT_EQ(shifts.size(), 45u);
}

/// At every step, the contacts are those of brute force, and searches are not overdue.
void expect_no_missed_pair(const Description& d, std::size_t steps) {
  Trial t(d);
  Skins none;
  none.reset(std::vector(chunks_of(t.world().positions().size()), 0.0), 0, 0);
  for (std::size_t i = 0; i < steps; ++i, t.step()) {
    std::set<Pair> touching;
    const World& world = t.world();
    const ContactTable& pairs = t.kernel().state().pairs;
    for (std::size_t c = 0; c < pairs.candidates(); ++c)
      if (pairs.contacts(c)) touching.emplace(pairs.a(c), pairs.b(c), pairs.image(c));
    // Bodies may lie beyond a periodic side until the next search; images then refer to their actual position.
    ASSERT_EQ(touching, brute_force(world.positions(), world.cell(), none)) << "step " << world.step();
    std::set<std::tuple<std::uint32_t, std::uint32_t>> on_walls, on_walls_too;
    for (const Contact& c : world.contacts())
      if (c.with_wall) on_walls.emplace(c.a, c.b);
    for (std::uint32_t w = 0; w < world.walls().size(); ++w) {
      const auto& state = t.kernel().state().walls;
      for (std::uint32_t a = 0; a < world.positions().size(); ++a) {
        std::vector<SurfaceContact> contact;
        const Sphere sphere{xyz(world.positions()[a]), world.positions()[a].w, a};
        state.geometry(w).find_contacts(state.pose(w), {&sphere, 1}, contact);
        if (!contact.empty()) on_walls_too.emplace(a, w);
      }
    }
    ASSERT_EQ(on_walls, on_walls_too) << "step " << world.step();
  }
  EXPECT_GE(t.kernel().state().lists.rebuilds(), 10u);
  EXPECT_LT(t.kernel().state().lists.rebuilds(), steps / 2) << "the skin is used";
}

const Vec3 block(3e-3, 3e-3, 3e-3);  // position of a rotating solid box

/// Some large, most small, so that they have room to fly.
std::vector<Grain> loose(const std::array<int, 3>& count, double speed) {
  auto grains = jumble(count, 1e-3, speed, 3);
  for (std::size_t i = 0; i < grains.size(); ++i) grains[i].radius *= i % 5 == 0 ? 0.9 : 0.35;
  return grains;
}
Description description_of(const std::vector<Grain>& grains) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e8}}, grains);
  d["guards"] = {{"overlap", 1}, {"travel", 0.5}, {"energy", 10}};
  return d;
}
Description fast() {
  auto grains = loose({6, 6, 6}, 1);
  std::erase_if(grains, [](const Grain& g) { return (g.position - block).norm() < 1.6e-3; });
  return description_of(grains);
}
void close(Description& d, const Vec3& low, const Vec3& high) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][std::string(up ? "low_" : "high_") + "xyz"[axis]] =
          plane(up ? low : high, up ? Vec3(Vec3::Unit(axis)) : Vec3(-Vec3::Unit(axis)));
}

TEST(NeighbourSearch, MissesNoPairOfFastGrainsBetweenMovingWalls) {
  Description d = fast();
  close(d, Vec3::Zero(), Vec3::Constant(6e-3));
  d["walls"]["high_z"]["motion"]["velocity"] = {0, 0, -1};
  d["walls"]["block"] = {{"type", "box"},
                         {"low", vector(block - Vec3(5e-4, 1e-3, 2e-4))},
                         {"high", vector(block + Vec3(5e-4, 1e-3, 2e-4))},
                         {"inside", false},
                         {"material", "grain"},
                         {"motion", {{"spin", {0, 1000, 0}}}}};
  expect_no_missed_pair(d, 900);
}

TEST(NeighbourSearch, MissesNoPairWhereAWallStartsToRotate) {
  // Nothing else moves before it is hit: only the wall makes a search due.
  auto grains = loose({6, 6, 6}, 0);
  const Vec3 clear(2.1e-3, 8e-4, 8e-4);
  std::erase_if(grains,
                [&](const Grain& g) { return ((g.position - block).cwiseAbs().array() < clear.array()).all(); });
  Description d = description_of(grains);
  d["walls"]["blade"] = {{"type", "box"},
                         {"low", vector(block - Vec3(1.5e-3, 2e-4, 2e-4))},
                         {"high", vector(block + Vec3(1.5e-3, 2e-4, 2e-4))},
                         {"inside", false},
                         {"material", "grain"},
                         {"motion", {{"spin", {0, 3000, 0}}}}};
  expect_no_missed_pair(d, 600);
}

TEST(NeighbourSearch, MissesNoPairWhereFastGrainsMeetSlowOnes) {
  auto grains = loose({9, 9, 9}, 1e-3);
  for (Grain& g : grains)
    if (g.position.z() > 6e-3) g.velocity = 5000 * g.velocity + Vec3(0, 0, -5);
  Description d = description_of(grains);
  close(d, Vec3::Zero(), Vec3::Constant(9e-3));
  expect_no_missed_pair(d, 600);
}

TEST(NeighbourSearch, MissesNoPairOfAMixtureOfOneToAHundred) {
  // Dust around a boulder that falls on it while it flies away.
  constexpr double large = 25e-3, small = 0.25e-3;
  constexpr int dust = 600;
  std::vector<Grain> grains{{Vec3::Zero(), large, {3, 0, 0}}};
  for (int i = 0; i < dust; ++i) {
    const double z = 1 - (2 * i + 1.0) / dust, around = 2.399963229728653 * i, gap = (i % 7) * 0.05e-3 + 1e-6;
    const Vec3 out(std::sqrt(1 - z * z) * std::cos(around), std::sqrt(1 - z * z) * std::sin(around), z);
    grains.push_back({(large + small + gap) * out, small, -0.2 * out + Vec3(i % 3 - 1, i % 5 - 2, 0)});
  }
  expect_no_missed_pair(description_of(grains), 1200);
}

TEST(NeighbourSearch, MissesNoPairInACellThatDeforms) {
  for (const double rate : {-200.0, 200.0}) {
    Description d = fast();
    d["domain"] = {{"low", {0, 0, 0}},
                   {"high", {6e-3, 6e-3, 6e-3}},
                   {"periodic", {true, true, true}},
                   {"strain_rate", {rate, -0.5 * rate, 0}}};
    expect_no_missed_pair(d, 900);
  }
}

TEST(NeighbourSearch, MissesNoPairInACellThatShears) {
  for (const double rate : {-2000.0, 2000.0}) {
    Description d = fast();
    d["domain"] = {{"low", {0, 0, 0}},
                   {"high", {6e-3, 6e-3, 6e-3}},
                   {"periodic", {true, true, true}},
                   {"strain_rate", {0.05 * rate, -0.05 * rate, 0}},
                   {"shear_rate", {{"xy", 0.5 * rate}, {"xz", rate}, {"yz", -0.7 * rate}}}};
    expect_no_missed_pair(d, 900);
  }
}

}  // namespace
}  // namespace grit::test::neighbours_tests
