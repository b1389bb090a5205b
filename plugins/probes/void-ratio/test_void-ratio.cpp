#include "void-ratio.hpp"

#include <gmock/gmock.h>

#include <numbers>
#include <random>

#include "free_boxes.hpp"
#include "free_volume.hpp"
#include "grit/testing/probe.hpp"

namespace grit {
namespace {

constexpr double sixth = std::numbers::pi / 6;

std::vector<double> field_values(VoidRatio& probe, const World& world, const std::string& name) {
  for (const Field& field : probe.fields(world))
    if (field.name == name) return field.values;
  throw Error("there is no field " + name);
}

/// n³ grains of diameter 1 that just touch, in a box of n³.
FakeWorld cubic(int n) {
  FakeWorld world;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) world.add(Vec3(i, j, k).array() + 0.5, 0.5);
  world.whole = {Vec3::Zero(), Vec3::Constant(n)};
  return world;
}

void add_wall(FakeWorld& world, std::function<std::optional<Clearance>(const Vec3&)> surface) {
  world.wall.push_back(still_wall("wall_" + std::to_string(world.wall.size())));
  world.surface.push_back(std::move(surface));
}
/// Solid behind a plane, whose normal looks at the bodies.
void add_plane(FakeWorld& world, const Vec3& point, const Vec3& normal) {
  add_wall(world, flat_surface(point, normal.normalized()));
}

/// What a segment a … b in the xz plane is away.
struct Segment {
  double distance;
  Vec3 way;  // to the closest point
};
Segment to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 from(x.x(), 0, x.z()), along = b - a;
  const Vec3 way = a + std::clamp((from - a).dot(along) / along.squaredNorm(), 0.0, 1.0) * along - from;
  return {way.norm(), way};
}
/// Teeth of this spacing whose tips lie at z = 0 and whose valleys lie at z = −depth, tips at whole multiples of it.
void add_teeth(FakeWorld& world, double spacing, double depth) {
  add_wall(world, [=](const Vec3& x) {
    const double tip = spacing * std::round(x.x() / spacing);
    Segment best{1e300, Vec3::Zero()};
    for (const double way : {-2.0, -1.0, 0.0, 1.0, 2.0}) {
      const Vec3 top(tip + way * spacing, 0, 0), left(top.x() - spacing / 2, 0, -depth),
          right(top.x() + spacing / 2, 0, -depth);
      for (const Segment& one : {to_segment(x, left, top), to_segment(x, top, right)})
        if (one.distance < best.distance) best = one;
    }
    const double surface = -2 * depth / spacing * std::abs(x.x() - tip);
    const bool behind = x.z() < surface;
    const Vec3 into = best.distance > 0 ? Vec3(best.way / best.distance) : Vec3(0, 0, -1);
    return Clearance{behind ? -best.distance : best.distance, behind ? Vec3(-into) : into};
  });
}
/// Solid outside of an upright cylinder about (x, y).
void add_pipe(FakeWorld& world, double x, double y, double radius) {
  add_wall(world, [=](const Vec3& point) {
    const Vec3 out(point.x() - x, point.y() - y, 0);
    const double off_axis = out.norm();
    return Clearance{radius - off_axis, off_axis > 0 ? Vec3(out / off_axis) : Vec3(1, 0, 0)};
  });
}

/// Summed up over cells, so many along each axis.
double free_volume(const FakeWorld& world, const Region& box, const Vec3& cells, double error) {
  double sum = 0;
  const Vec3 size = (box.high - box.low).cwiseQuotient(cells);
  for (const double part : free_volumes(world, AveragingCells(world.box, box, size, size), error)) sum += part;
  return sum;
}

TEST(ShareBelow, IsInclusionAndExclusionOfCorners) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> sign(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 normal = Vec3(sign(random), sign(random), sign(random)),
               size = Vec3(sign(random), sign(random), sign(random)).cwiseAbs() + Vec3::Constant(0.1);
    const Vec3 m = normal.cwiseAbs().cwiseProduct(size);
    if (m.minCoeff() < 0.02) continue;
    const double distance = 0.6 * m.sum() * sign(random), from_corner = 0.5 * m.sum() + distance;
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 one(corner & 1 ? 1 : 0, corner & 2 ? 1 : 0, corner & 4 ? 1 : 0);
      const double over = std::max(0.0, from_corner - m.dot(one));
      sum += (static_cast<int>(one.sum()) % 2 == 0 ? 1 : -1) * over * over * over;
    }
    EXPECT_NEAR(share_below(size, normal, distance), sum / (6 * m.prod()), 1e-9);
  }
}

TEST(ShareBelow, IsExactAlongTheAxes) {
  EXPECT_DOUBLE_EQ(share_below({2, 3, 4}, {0, 0, 1}, 1), 0.75);
  EXPECT_DOUBLE_EQ(share_below({2, 3, 4}, {0, 0, -2}, 1), 0.625);
  EXPECT_DOUBLE_EQ(share_below({2, 2, 4}, {1, 1, 0}, 0), 0.5);
  EXPECT_DOUBLE_EQ(share_below({2, 2, 4}, {1, 1, 0}, -1), 0.125);
  EXPECT_EQ(share_below({1, 1, 1}, {1, 2, 3}, 3), 1);
  EXPECT_EQ(share_below({1, 1, 1}, {1, 2, 3}, -3), 0);
  EXPECT_NEAR(share_below({1, 1, 1}, {1e-7, 3e-6, 1}, 0.2), 0.7, 1e-9);
}

TEST(FreeVolume, TakeFlatWallsAtOnce) {
  const Region box{Vec3::Zero(), {4, 3, 2}};
  int asked = 0;
  const auto volume = [&](bool flat) {
    FakeWorld world = cubic(2);
    for (const auto& [point, normal] : {std::pair<Vec3, Vec3>({0, 0, 0.3}, {0, 0, 1}), {{3.5, 0, 0}, {-1, 0, 0}}})
      add_wall(world, [&asked, surface = flat_surface(point, normal)](const Vec3& x) { return ++asked, surface(x); });
    for (WallView& wall : world.wall) wall.flat = flat;
    asked = 0;
    return free_volume(world, box, {4, 3, 2}, 1e-3);
  };
  EXPECT_NEAR(volume(false), 3.5 * 3 * 1.7, 1e-12);
  const int before = asked;
  EXPECT_NEAR(volume(true), 3.5 * 3 * 1.7, 1e-12);
  EXPECT_LT(10 * asked, before);
}

TEST(FreeVolume, FindEdgesOfFlatWalls) {
  // Solid below z = 0.4 where x is below 0.3.
  FakeWorld world = cubic(2);
  add_wall(world, [](const Vec3& x) {
    const Vec3 out(std::max(0.0, x.x() - 0.3), 0, std::max(0.0, x.z() - 0.4));
    if (out.norm() > 0) return Clearance{out.norm(), -out.normalized()};
    return x.x() - 0.3 > x.z() - 0.4 ? Clearance{x.x() - 0.3, -Vec3::UnitX()} : Clearance{x.z() - 0.4, -Vec3::UnitZ()};
  });
  world.wall.back().flat = true;
  for (const double cells : {1.0, 2.0, 3.0})
    EXPECT_NEAR(free_volume(world, {Vec3::Zero(), Vec3::Ones()}, {cells, 1, cells}, 1e-3), 1 - 0.3 * 0.4, 1e-11);
}

/// The block that is solid between two corners, as the plugin of boxes has it.
std::optional<Clearance> seen_block(const Region& block, const Vec3& x) {
  const Vec3 out = x - x.cwiseMax(block.low).cwiseMin(block.high);
  if (out.norm() > 0) return Clearance{out.norm(), -out.normalized()};
  Clearance nearest{-1e300, Vec3::Zero()};
  for (int k = 0; k < 3; ++k) {
    if (block.low[k] - x[k] > nearest.distance) nearest = {block.low[k] - x[k], Vec3::Unit(k)};
    if (x[k] - block.high[k] > nearest.distance) nearest = {x[k] - block.high[k], -Vec3::Unit(k)};
  }
  return nearest;
}

// Blocks that overlap, meet and stick out: what they leave is a sum over the boxes between all of their faces.
TEST(FreeVolume, IsExactBetweenBlocks) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-1, 5);
  for (int round = 0; round < 60; ++round) {
    std::vector<Region> blocks(1 + static_cast<std::size_t>(round % 4));
    for (Region& block : blocks) {
      for (int k = 0; k < 3; ++k) {
        // Now and then along a side of a cell, or of the region.
        const double a = round % 3 == 0 ? std::round(place(random)) : place(random), b = place(random);
        block.low[k] = std::min(a, b), block.high[k] = std::max(a, b);
      }
    }
    FakeWorld world = cubic(4);
    for (const Region& block : blocks) {
      add_wall(world, [block](const Vec3& x) { return seen_block(block, x); });
      world.wall.back().flat = true;
    }
    const Vec3 size(2, 1, 4.0 / 3);
    const AveragingCells cells(world.box, world.whole, size, size);
    const auto found = free_volumes(world, cells, 1e-3);
    for (std::size_t n = 0; n < cells.cells(); ++n) {
      const Region cell = cells.cell(n);
      std::array<std::vector<double>, 3> edges;
      for (int k = 0; k < 3; ++k) {
        auto& along = edges[static_cast<std::size_t>(k)] = {cell.low[k], cell.high[k]};
        for (const Region& block : blocks)
          for (const double x : {block.low[k], block.high[k]})
            if (x > cell.low[k] && x < cell.high[k]) along.push_back(x);
        std::ranges::sort(along);
      }
      double free = 0;
      for (std::size_t i = 0; i + 1 < edges[0].size(); ++i)
        for (std::size_t j = 0; j + 1 < edges[1].size(); ++j)
          for (std::size_t k = 0; k + 1 < edges[2].size(); ++k) {
            const Vec3 low(edges[0][i], edges[1][j], edges[2][k]),
                high(edges[0][i + 1], edges[1][j + 1], edges[2][k + 1]), middle = 0.5 * (low + high);
            const bool behind = std::ranges::any_of(blocks, [&](const Region& block) {
              return (middle.array() > block.low.array()).all() && (middle.array() < block.high.array()).all();
            });
            if (!behind) free += (high - low).prod();
          }
      EXPECT_NEAR(found[n], free, 1e-10) << round << ", cell " << n;
    }
  }
}

TEST(FreeVolume, IsExactBehindTheRimOfASheetAndInsideOfAContainer) {
  FakeWorld world = cubic(4);
  // Solid behind z = 1.7 as far as the sheet goes; and outside of a box.
  add_wall(world, [](const Vec3& x) {
    const Vec3 rim(x.x() - std::clamp(x.x(), 0.3, 2.9), x.y() - std::clamp(x.y(), -1.0, 1.6), x.z() - 1.7);
    if (rim.x() == 0 && rim.y() == 0) return Clearance{rim.z(), -Vec3::UnitZ()};
    return Clearance{rim.norm(), -rim.normalized()};
  });
  add_wall(world, [](const Vec3& x) {
    Clearance nearest{1e300, Vec3::Zero()};
    for (const auto& [axis, low, high] : {std::tuple(0, 0.1, 3.6), {1, 0.0, 3.9}, {2, 0.2, 4.5}}) {
      if (x[axis] - low < nearest.distance) nearest = {x[axis] - low, -Vec3::Unit(axis)};
      if (high - x[axis] < nearest.distance) nearest = {high - x[axis], Vec3::Unit(axis)};
    }
    return nearest;
  });
  for (WallView& wall : world.wall) wall.flat = true;
  for (const double cells : {1.0, 3.0, 4.0})
    EXPECT_NEAR(free_volume(world, world.whole, Vec3::Constant(cells), 1e-3), 3.5 * 3.9 * 3.8 - 2.6 * 1.6 * 1.5, 1e-10);
}

TEST(FreeVolume, IsAllWithoutWalls) {
  const FakeWorld world = cubic(2);
  EXPECT_DOUBLE_EQ(free_volume(world, world.whole, {1, 3, 4}, 1e-3), 8);
}

TEST(FreeVolume, IsExactBeforeFlatWalls) {
  FakeWorld world = cubic(4);
  add_plane(world, {0, 0, 0.3}, {0, 0, 1});
  add_plane(world, {0, 0, 4}, {0, 0, -1});     // along a side of the box
  add_plane(world, {3.15, 0, 0}, {-1, 0, 0});  // which meets the first at a right angle
  EXPECT_NEAR(free_volume(world, world.whole, {4, 4, 4}, 1e-3), 3.15 * 4 * 3.7, 1e-11);
  EXPECT_NEAR(free_volume(world, {{0, 0, -5}, {4, 4, -1}}, {4, 4, 4}, 1e-3), 0, 1e-11) << "all of it behind";
  FakeWorld tilted = cubic(4);
  add_plane(tilted, {2, 2, 2}, {1, 2, 3});
  EXPECT_NEAR(free_volume(tilted, tilted.whole, {4, 4, 4}, 1e-3), 32, 1e-9);
}

TEST(FreeVolume, FollowsFlatWallsThatShareACell) {
  FakeWorld valley = cubic(4), slot = cubic(4);
  add_plane(valley, {2, 0, 1}, {1, 0, 1});
  add_plane(valley, {2, 0, 1}, {-1, 0, 1});  // free where z - 1 > |x - 2|
  add_plane(slot, {0, 0, 1}, {0, 0, 1});
  add_plane(slot, {0, 0, 3}, {0, 0, -1});
  for (FakeWorld* world : {&valley, &slot}) {
    for (WallView& wall : world->wall) wall.flat = true;
    EXPECT_NEAR(free_volume(*world, world->whole, {1, 1, 1}, 1e-3), 32, 32e-3);
  }
}

TEST(FreeBoxes, AreNoneBeforeWallsThatStandAskewWhichIsSoonSeen) {
  FakeWorld world = cubic(4);
  int asked = 0;
  for (const double slope : {1.0, -1.0})
    add_wall(world, [&asked, surface = flat_surface({2, 0, 1}, Vec3(slope, 0, 1).normalized())](const Vec3& x) {
      return ++asked, surface(x);
    });
  for (WallView& wall : world.wall) wall.flat = true;
  EXPECT_FALSE(free_boxes(world, world.whole, {0, 1}, 10));
  EXPECT_LT(asked, 50);
}

TEST(FreeVolume, TakesNothingForASheetWithTwoSides) {
  FakeWorld world = cubic(4);
  add_wall(world, [](const Vec3& x) { return Clearance{std::abs(x.z() - 1.3), Vec3(0, 0, x.z() < 1.3 ? 1 : -1)}; });
  for (const bool flat : {false, true}) {
    world.wall.back().flat = flat;
    EXPECT_DOUBLE_EQ(free_volume(world, world.whole, {4, 4, 4}, 1e-3), 64);
  }
}

TEST(FreeVolume, FollowsGroovesAsCloselyAsItSays) {
  for (const auto& [spacing, depth] : std::vector<std::pair<double, double>>{{1, 0.5}, {2.3, 0.4}, {0.37, 0.6}}) {
    FakeWorld world = cubic(4);
    add_teeth(world, spacing, depth);
    // Volume of the grooves by the primitive of their depth along x.
    const auto grooves = [&, s = spacing, d = depth](double x) {
      const double tip = s * std::round(x / s), past = x - tip;
      return d * tip / 2 + d / s * past * std::abs(past);
    };
    for (const double error : {4e-3, 1e-3}) {
      const double found = free_volume(world, {{0, 0, -depth}, {4, 3, 1}}, {4, 3, 2}, error);
      EXPECT_NEAR(found, 3 * (4 + grooves(4) - grooves(0)), error * 4 * 3) << spacing << ", " << depth;
    }
  }
}

TEST(FreeVolume, FollowsARoundWallAsCloselyAsItSays) {
  FakeWorld world = cubic(4);
  add_pipe(world, 2, 2, 2);
  for (const double error : {4e-3, 1e-3}) {
    const double found = free_volume(world, world.whole, {4, 4, 4}, error);
    EXPECT_NEAR(found, std::numbers::pi * 4 * 4, error * 2 * std::numbers::pi * 2 * 4);
  }
}

TEST(VoidRatio, KnowsTheCubicLattice) {
  FakeWorld world = cubic(8);
  world.make_periodic(Vec3::Zero(), Vec3::Constant(8));
  VoidRatio probe;
  probe.averaging.slices = 5;
  const auto near = testing::DoubleNear(1 / sixth - 1, 1e-11);
  EXPECT_THAT(channel_value(probe, world, "void_ratio"), near);
  EXPECT_THAT(channel_value(probe, world, "smallest"), near);
  EXPECT_THAT(channel_value(probe, world, "largest"), near);
  EXPECT_THAT(channel_value(probe, world, "mean"), near);
  EXPECT_NEAR(channel_value(probe, world, "standard_deviation"), 0, 1e-12);
  const auto cells = field_values(probe, world, "void_ratio");
  EXPECT_EQ(cells.size(), 64u);  // cubes of 5, moved by 1, in 8
  EXPECT_THAT(cells, testing::Each(near));
  EXPECT_THAT(field_values(probe, world, "free_volume_fraction"), testing::Each(testing::DoubleNear(1, 1e-12)));
  EXPECT_THAT(field_values(probe, world, "solid_fraction"), testing::Each(testing::DoubleNear(sixth, 1e-11)));
}

TEST(VoidRatio, OfCellsAndSlicesAgreesWithThatOfEachBox) {
  FakeWorld world = cubic(6);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  for (Row& row : world.position) row.x += part(random), row.y += part(random), row.z += part(random);
  world.box = {{-1e300, 0, -1e300}, {1e300, 6, 1e300}, {false, true, false}};
  VoidRatio probe;
  probe.averaging.cell_size = 2.3, probe.averaging.cell_step = 0.9, probe.averaging.slices = 4;
  probe.averaging.region_low = Vec3(0.4, 0.1, 0.5), probe.averaging.region_high = Vec3(5.2, 5.7, 5.5);
  const Region region{*probe.averaging.region_low, *probe.averaging.region_high};
  const AveragingCells cells = probe.averaging.cells(world, region);
  const auto ratios = field_values(probe, world, "void_ratio");
  ASSERT_EQ(ratios.size(), 3 * 4 * 4u);
  double sum = 0, squares = 0;
  for (std::size_t n = 0; n < ratios.size(); ++n) {
    EXPECT_NEAR(ratios[n], void_ratio(world, cells.cell(n)), 1e-10);
    sum += ratios[n], squares += ratios[n] * ratios[n];
  }
  const double mean = sum / 48;
  EXPECT_NEAR(channel_value(probe, world, "mean"), mean, 1e-12);
  EXPECT_NEAR(channel_value(probe, world, "standard_deviation"), std::sqrt(squares / 48 - mean * mean), 1e-9);
  EXPECT_EQ(channel_value(probe, world, "smallest"), *std::ranges::min_element(ratios));
  EXPECT_EQ(channel_value(probe, world, "largest"), *std::ranges::max_element(ratios));
  EXPECT_NEAR(channel_value(probe, world, "void_ratio"), void_ratio(world, region), 1e-10);
  const auto profile = channel_values(probe, world, "void_ratio_profile"),
             places = channel_values(probe, world, "position");
  for (std::size_t s = 0; s < 4; ++s) {
    Region slice = region;
    slice.low.z() = 0.5 + 1.25 * static_cast<double>(s), slice.high.z() = slice.low.z() + 1.25;
    EXPECT_NEAR(profile[s], void_ratio(world, slice), 1e-10);
    EXPECT_NEAR(places[s], 0.5 * (slice.low.z() + slice.high.z()), 1e-12);
  }
}

TEST(VoidRatio, CountsGroovesOfWalls) {
  FakeWorld world = cubic(6);
  add_teeth(world, 1, 0.8);
  world.with_grooves = Region{{0, 0, -0.8}, {6, 6, 6}};
  VoidRatio probe;
  probe.averaging.slices = 17;  // of 0.4
  EXPECT_NEAR(channel_value(probe, world, "void_ratio"), (216 + 36 * 0.4) / (216 * sixth) - 1,
              2 * 1e-3 * 36 / (216 * sixth));
  // No grain reaches into the grooves.
  const auto profile = channel_values(probe, world, "void_ratio_profile");
  for (std::size_t s = 0; s < 2; ++s) EXPECT_EQ(profile[s], std::numeric_limits<double>::infinity());
  probe.averaging.cell_size = 3, probe.averaging.cell_step = 1;
  const auto centre = field_values(probe, world, "centre"), share = field_values(probe, world, "free_volume_fraction"),
             ratio = field_values(probe, world, "void_ratio");
  int grooved = 0;
  for (std::size_t n = 0; n < share.size(); ++n) {
    // A cell over whole grooves that begins `below` their tips lacks the tips.
    const double below = std::max(0.0, 1.5 - centre[3 * n + 2]), under = 0.5 * below * below / 0.8;
    EXPECT_NEAR(share[n], 1 - under / 3, 1e-3 / 3) << n;
    grooved += below > 0;
    if (below == 0) {
      EXPECT_NEAR(ratio[n], void_ratio(world, probe.averaging.cells(world, *world.with_grooves).cell(n)), 1e-9);
    }
  }
  EXPECT_EQ(grooved, 16);
}

TEST(VoidRatio, LeavesCellsOutThatAreMostlyBehindWalls) {
  FakeWorld world = cubic(6);
  add_plane(world, {0, 0, 3.2}, {0, 0, 1});
  for (Row& row : world.position)
    if (row.z < 3.2) row.z += 100;
  VoidRatio probe;
  probe.averaging.cell_size = 1;
  const auto ratios = field_values(probe, world, "void_ratio"),
             shares = field_values(probe, world, "free_volume_fraction");
  ASSERT_EQ(ratios.size(), 216u);
  EXPECT_EQ(std::ranges::count_if(shares, [](double share) { return std::abs(share) < 1e-12; }), 3 * 36);
  EXPECT_EQ(std::ranges::count_if(shares, [](double share) { return std::abs(share - 0.8) < 1e-12; }), 36);
  EXPECT_NEAR(channel_value(probe, world, "largest"), 1 / sixth - 1, 1e-10);
  world.surface.clear(), world.wall.clear();
  add_plane(world, {0, 0, 6}, {0, 0, 1});  // nothing is left before it
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "largest")));
}

TEST(VoidRatio, IsNoneOfCellsThatAreMostlyBehindWallsOnMapsEither) {
  FakeWorld world = cubic(6);
  for (Row& row : world.position)
    if (row.z < 4) row.z += 100;
  world.add({3.5, 3.5, 3.85}, 0.1), world.add({3.5, 2.5, 3.85}, 0.1);
  add_plane(world, {0, 0, 3.7}, {0, 0, 1});
  VoidRatio probe;
  probe.averaging.cell_size = 2 / world.mean_diameter(), probe.averaging.cell_step = 1 / world.mean_diameter();
  const auto ratios = field_values(probe, world, "void_ratio"),
             shares = field_values(probe, world, "free_volume_fraction");
  ASSERT_EQ(ratios.size(), 125u);
  int rim = 0;
  for (std::size_t n = 0; n < ratios.size(); ++n) {
    EXPECT_EQ(std::isnan(ratios[n]), shares[n] < 0.5) << n << ' ' << shares[n];
    rim += shares[n] > 0.1 && shares[n] < 0.2;
  }
  EXPECT_EQ(rim, 25) << "cells from 2 to 4, of which four have solids";
}

// Grains that a wall has left behind it take room that is none: neither −1 nor anything above says something there.
TEST(VoidRatio, IsUnknownBehindWalls) {
  FakeWorld world = cubic(6);
  add_plane(world, {0, 0, 3.2}, {0, 0, 1});
  VoidRatio probe;
  probe.averaging.cell_size = 1, probe.averaging.slices = 6;
  const auto ratios = field_values(probe, world, "void_ratio"),
             profile = channel_values(probe, world, "void_ratio_profile");
  ASSERT_EQ(ratios.size(), 216u);
  for (std::size_t n = 0; n < ratios.size(); ++n) EXPECT_EQ(std::isnan(ratios[n]), n % 6 < 3) << n;
  for (std::size_t s = 0; s < 6; ++s) EXPECT_EQ(std::isnan(profile[s]), s < 3) << s;
  EXPECT_NEAR(profile[5], 1 / sixth - 1, 1e-10);
  EXPECT_NEAR(channel_value(probe, world, "smallest"), 0.8 / sixth - 1, 1e-10);
  EXPECT_TRUE(std::isfinite(channel_value(probe, world, "mean")));
  probe.averaging.region_low = Vec3(0, 0, 2.4), probe.averaging.region_high = Vec3(6, 6, 3.3);
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "void_ratio"))) << "more solids than room";
  probe.averaging.region_high = Vec3(6, 6, 3.1);
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "void_ratio"))) << "no room";
  world.position.assign(1, {3, 3, 5, 0.5});
  EXPECT_TRUE(std::isnan(channel_value(probe, world, "void_ratio"))) << "no room and no solids";
}

TEST(VoidRatio, IsNoneInsideOfAGrain) {
  FakeWorld world;
  world.add({0, 0, 0}, 2);
  VoidRatio probe;
  probe.averaging.region_low = Vec3(-0.3, 0.1, -0.5), probe.averaging.region_high = Vec3(0.9, 0.2, 0.7);
  probe.averaging.cell_size = probe.averaging.cell_step = 0.1;
  EXPECT_NEAR(channel_value(probe, world, "void_ratio"), 0, 1e-6);
  for (const double ratio : field_values(probe, world, "void_ratio")) EXPECT_NEAR(ratio, 0, 1e-6);
}

TEST(VoidRatio, SaysWhereEachNumberOfItsProfileIs) {
  const auto channels = VoidRatio().channels();
  EXPECT_EQ(channels.back().name, "void_ratio_profile");
  EXPECT_EQ(channels.back().coordinate, "position");
}

TEST(VoidRatio, CountsTheUnionOfClumpsOnce) {
  FakeWorld world;
  world.add({1, 1, 1}, 0.5), world.add({1, 1, 1}, 0.5);
  world.volume_fraction = {0.5, 0.5};
  world.whole = {Vec3::Zero(), Vec3::Constant(2)};
  VoidRatio probe;
  EXPECT_NEAR(channel_value(probe, world, "void_ratio"), 8 / sixth - 1, 1e-11);
  EXPECT_NEAR(field_values(probe, world, "void_ratio").at(0), 8 / sixth - 1, 1e-11);
}

TEST(VoidRatio, RefusesARegionThatIsInsideOut) {
  VoidRatio probe;
  probe.averaging.region_low = Vec3(3, 0, 0), probe.averaging.region_high = Vec3(1, 1, 2);
  EXPECT_EQ(complaints(probe), "region_high: found x = 1.000000 m, allowed: above that of region_low, 3.000000 m\n");
}

INSTANTIATE_TEST_SUITE_P(VoidRatio, ProbeContract,
                         testing::Values(ProbeCase{"cubes", [] { return std::make_shared<VoidRatio>(); }},
                                         ProbeCase{"grooves",
                                                   [] {
                                                     auto probe = std::make_shared<VoidRatio>();
                                                     probe->averaging.depth_axis = "y", probe->averaging.cell_size = 2;
                                                     return probe;
                                                   },
                                                   [] {
                                                     FakeWorld world = lattice_world(6, 4, 8);
                                                     world.wall.clear(), world.surface.clear(), world.contact.clear();
                                                     add_teeth(world, 4e-4, 1e-4);
                                                     return world;
                                                   }}),
                         probe_case_name);

}  // namespace
}  // namespace grit
