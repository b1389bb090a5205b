// The neighbour search misses no pair: against brute force over all pairs, and at each step of a run with fast grains.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <tuple>

#include "contact/search.hpp"
#include "contact/spatial_order.hpp"
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
      if (const int turns = shift[as_index(k)]; turns != 0)
        by += turns * cell.period(k), there = there && cell.periodic[as_index(k)];
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
      for (int k = 0; k < 3; ++k) cell.periodic[as_index(k)] = (axes >> k & 1) != 0;
      const Bodies bodies = scattered(700, low, high, 0.1, random);
      NeighbourSearch search;
      Team team(2);
      Skins skins;
      skins.reset(skin, 0, 0);
      search.build(bodies, cell, skins, team);
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
        Team team(2);
        Skins skins;
        skins.reset(skin, 0, 0);
        search.build(bodies, cell, skins, team);
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

TEST(SpatialOrder, FollowsTheCurveForAnyNumberOfThreads) {
  Random random(13);
  for (const Vec3& sides : {Vec3(4, 5, 6), Vec3(40, 0.5, 0.5), Vec3(1e-3, 1e-3, 1e-3)}) {
    const Vec3 low(-1, 2, 0.5);
    const Bodies bodies = scattered(3 * chunk_bodies + 9, low, low + sides, 0.1, random);
    const double infinite = std::numeric_limits<double>::infinity();
    const Cell open{Vec3::Constant(-infinite), Vec3::Constant(infinite)};
    Team alone(1), three(3);
    const std::vector<std::uint32_t> order = spatial_order(bodies, open, alone);
    EXPECT_EQ(order, spatial_order(bodies, open, three)) << sides.transpose();
    std::vector<std::uint32_t> all = order;
    std::ranges::sort(all);
    for (std::uint32_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], i);
    // Neighbours on the curve are near each other: on average within some cells, far less than across the box.
    if (sides.maxCoeff() < 0.1) continue;  // all in one cell
    double steps = 0;
    for (std::size_t i = 1; i < order.size(); ++i)
      steps += (xyz(bodies.position[order[i]]) - xyz(bodies.position[order[i - 1]])).norm();
    EXPECT_LT(steps / static_cast<double>(order.size()), 0.25 * sides.norm());
  }
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
  const std::uint64_t searches = t.kernel().state().lists.rebuilds() + t.kernel().state().lists.searches_at_walls();
  EXPECT_GE(searches, 10u);
  EXPECT_LT(searches, steps / 2) << "the skin is used";
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

/// A blade rotates between grains at rest, and moves at this velocity along x [m/s]. Nothing else moves before it is
/// hit: only the wall makes a search due.
Description blade(double velocity) {
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
                         {"motion", {{"spin", {0, 3000, 0}}, {"velocity", {velocity, 0, 0}}}}};
  return d;
}

TEST(NeighbourSearch, MissesNoPairWhereAWallStartsToRotate) { expect_no_missed_pair(blade(0), 1000); }

TEST(NeighbourSearch, MissesNoPairWhereAWallThatRotatesMovesOn) { expect_no_missed_pair(blade(2), 1000); }

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

/// Grains of a swarm all have the same velocity, that of the lower swarm and its opposite.
Description swarms(const Vec3& velocity) {
  auto grains = loose({9, 9, 9}, 0);
  for (Grain& g : grains) g.velocity = g.position.z() < 4.5e-3 ? velocity : Vec3(-velocity);
  return description_of(grains);
}

TEST(NeighbourSearch, MissesNoPairOfSwarmsThatMeet) { expect_no_missed_pair(swarms({0.3, 0, 1}), 1000); }

TEST(NeighbourSearch, LeavesOutPairsThatMoveTogether) {
  Trial t(swarms({0.3, 0, -1}));
  for (int i = 0; i < 50; ++i) t.step();
  const Skins& skins = t.kernel().state().lists.skins();
  ASSERT_GT(skins.chunks(), 2u);
  double walked = 0, within = 0;
  for (const std::size_t chunk : {std::size_t{0}, skins.chunks() - 1})
    walked = std::max(walked, skins.walked(chunk)), within = std::max(within, skins.within(chunk));
  EXPECT_GT(walked, 0);
  EXPECT_LT(within, 1e-9 * walked);
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

/// Forces of bodies on walls, by id and wall.
std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> on_walls(const Trial& t) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3> forces;
  for (const Contact& c : t.world().contacts())
    if (c.with_wall) forces[{t.world().ids()[c.a], c.b}] = c.force;
  return forces;
}

/// Both have the same forces on walls at each step.
void expect_same_on_walls(Trial& t, Trial& other, std::size_t steps, bool rebuild_other) {
  for (std::size_t i = 0; i < steps; ++i) {
    t.step();
    if (rebuild_other) other.kernel().request_rebuild();
    other.step();
    const auto forces = on_walls(t), expected = on_walls(other);
    ASSERT_EQ(forces.size(), expected.size()) << "step " << t.world().step();
    for (const auto& [pair, force] : expected) {
      ASSERT_TRUE(forces.contains(pair)) << "step " << t.world().step();
      ASSERT_LE((forces.at(pair) - force).norm(), 1e-9 * force.norm()) << "step " << t.world().step();
    }
  }
}

constexpr double held_spacing = 2.5e-3, held_radius = 1e-3;
constexpr double held_height = 2.001e-3;  // a floor reaches them between two steps, not at one

/// Grains that are held apart from each other, in layers of 36 from this height on, and this floor.
Description held(int layers, const Description& floor, const Vec3& velocity) {
  std::vector<Grain> grains;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 6; ++y)
      for (int z = 0; z < layers; ++z)
        grains.push_back({held_spacing * Vec3(x + 0.5, y + 0.5, z) + Vec3(0, 0, held_height), held_radius});
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, grains);
  d["engines"]["hold"] = {{"type", "hold"}, {"rotation", "xyz"}, {"translation", "xyz"}};
  d["walls"]["floor"] = floor;
  d["walls"]["floor"]["motion"]["velocity"] = vector(velocity);
  d["time_step"]["value"] = 2e-6;
  d["guards"] = {{"overlap", 1e9}};
  return d;
}

TEST(NeighbourSearch, AtWallsAloneGivesTheForcesOfOneAtEveryStep) {
  const Description d = held(4, plane(Vec3::Zero(), Vec3::UnitZ()), {0.3, 0, 2});
  Trial t(d), other(d);
  EXPECT_FALSE(t.kernel().state().wall_contacts.has_candidates(0));
  expect_same_on_walls(t, other, 1600, true);
  EXPECT_EQ(on_walls(t).size(), 3u * 36) << "after 6.4 mm";
  EXPECT_EQ(t.kernel().state().lists.rebuilds(), 1u);
  EXPECT_GE(t.kernel().state().lists.searches_at_walls(), 10u);
}

TEST(NeighbourSearch, AtWallsAloneKnowsThatAWallOfOnePeriodHasNoEnds) {
  const double period = 6 * held_spacing;
  const Vec3 velocity(3, -2, 1);  // along itself it moves by more than a quarter of a period
  const auto in_cell = [&](const Description& floor) {
    Description d = held(1, floor, velocity);
    d["domain"] = {{"low", {0, 0, -1}}, {"high", {period, period, 1}}, {"periodic", {true, true, false}}};
    return d;
  };
  Trial t(in_cell({{"type", "rectangle"},
                   {"corner", {0, 0, 0}},
                   {"edge_a", {period, 0, 0}},
                   {"edge_b", {0, period, 0}},
                   {"material", "grain"}})),
      endless(in_cell(plane(Vec3::Zero(), Vec3::UnitZ())));
  expect_same_on_walls(t, endless, 700, false);
  EXPECT_EQ(on_walls(t).size(), 36u) << "after 1.4 mm";
  EXPECT_EQ(t.kernel().state().lists.rebuilds(), 1u);
  EXPECT_GE(t.kernel().state().lists.searches_at_walls(), 3u);
}

TEST(NeighbourSearch, AtWallsAloneKnowsWallsThatAStageMoves) {
  Description d = held(2, plane(Vec3::Zero(), Vec3::UnitZ()), {1, 0, 0});
  d["walls"]["lid"] = plane({0, 0, 1}, -Vec3::UnitZ());
  Description next = d["stages"][0];
  next["name"] = "closed";
  next["change"]["walls"]["lid"]["point"] = {0, 0, held_height + held_spacing + 0.99 * held_radius};
  d["stages"].push_back(next);
  Trial t(d);
  t.step(400);
  EXPECT_GT(t.kernel().state().lists.searches_at_walls(), 0u);
  EXPECT_TRUE(on_walls(t).empty());
  t.begin_stage(1, "closed");
  t.step();
  EXPECT_EQ(t.kernel().state().lists.rebuilds(), 2u);
  EXPECT_EQ(on_walls(t).size(), 36u);
  const std::uint64_t searches = t.kernel().state().lists.searches_at_walls();
  t.step(400);
  EXPECT_GT(t.kernel().state().lists.searches_at_walls(), searches);
  EXPECT_EQ(on_walls(t).size(), 36u);
}

}  // namespace
}  // namespace grit::test::neighbours_tests
