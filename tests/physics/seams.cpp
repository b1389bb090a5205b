// Surfaces of several walls: edges between coplanar faces have no effect, shared edges count once.
#include <gmock/gmock.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "support/scene.hpp"
#include "support/stl_file.hpp"
#include "support/verified.hpp"

namespace grit::test::seams_tests {
namespace {

// The overlap by the weight is 7e-4 of the radius.
constexpr double radius = 1e-3, tile = 4e-3, gravity = 2e4;

Description rectangle(const Vec3& corner, const Vec3& a, const Vec3& b) {
  return {{"type", "rectangle"},
          {"corner", vector(corner)},
          {"edge_a", vector(a)},
          {"edge_b", vector(b)},
          {"material", "grain"}};
}

Description rolling_ball(const std::string& law, const Vec3& place, const Vec3& velocity, double friction_angle) {
  Description d = description(law, {{"friction_angle", friction_angle}}, {{place, radius, velocity}});
  if (law == "hertz-mindlin") d["materials"]["grain"]["young_modulus"] = 1e9;
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -gravity}}};
  if (law == "linear-rolling") d["materials"]["grain"]["rolling_limit"] = 2e-5;
  d["time_step"]["value"] = 1e-6;
  return d;
}

/// A floor of 3 × 3 tiles about the origin.
void tile_floor(Description& d) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      d["walls"]["tile" + std::to_string(3 * x + y + 5)] =
          rectangle(Vec3((x - 0.5) * tile, (y - 0.5) * tile, 0), tile * Vec3::UnitX(), tile * Vec3::UnitY());
}

Description mesh(const StlFile& file) {
  return {{"type", "mesh"}, {"path", file.path()}, {"scale", 1.0}, {"open", true}, {"material", "grain"}};
}

/// Two triangles per tile of the floor, with alternating diagonals.
std::vector<Vec3> triangle_floor() {
  std::vector<Vec3> corners;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y) {
      const auto at = [&](double a, double b) { return Vec3((x + a - 0.5) * tile, (y + b - 0.5) * tile, 0); };
      if ((x + y) % 2 == 0) corners.insert(corners.end(), {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
      else corners.insert(corners.end(), {at(0, 0), at(1, 0), at(0, 1), at(1, 0), at(1, 1), at(0, 1)});
    }
  return corners;
}

/// Paths over an edge, along an edge, over a vertex, and oblique.
struct Path {
  Vec3 from, velocity;
};
class Seams : public testing::TestWithParam<std::tuple<std::string, int, double>> {
 protected:
  /// Rolls a ball over a floor made of pieces by `add_floor`, and over a plane.
  template <class AddFloor>
  void expect_not_felt(AddFloor add_floor) const;
};

template <class AddFloor>
void Seams::expect_not_felt(AddFloor add_floor) const {
  const auto& [law, number, friction] = GetParam();
  const Path paths[] = {{{-0.7 * tile, 0.1e-3, 0}, {0.2, 0, 0}},
                        {{-0.7 * tile, 0.5 * tile, 0}, {0.2, 0, 0}},
                        {{-0.7 * tile, -0.7 * tile, 0}, {0.14, 0.14, 0}},
                        {{-0.7 * tile, -0.6 * tile, 0}, {0.18, 0.07, 0}}};
  const Path& path = paths[number];
  Description tiles = rolling_ball(law, path.from + Vec3(0, 0, 0.9995 * radius), path.velocity, friction);
  Description whole = tiles;
  add_floor(tiles);
  whole["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  Trial on_tiles(tiles), on_whole(whole);
  int touching = 0;
  Errors force("force on a ball that rolls over seams, change over its weight");
  Errors moment("moment on a ball that rolls over seams, change over its weight times radius");
  for (int step = 0; step < 100000 && on_whole.position(0).x() < 0.6 * tile; ++step) {
    on_tiles.step(), on_whole.step();
    const auto contacts = on_whole.world().contacts();
    ASSERT_EQ(on_tiles.world().contacts().size(), contacts.size()) << on_whole.position(0).transpose();
    touching += static_cast<int>(contacts.size());
    const double weight = gravity * on_whole.mass(0);
    force.add((xyz(on_tiles.world().forces()[0]) - xyz(on_whole.world().forces()[0])).norm() / weight);
    moment.add((xyz(on_tiles.world().moments()[0]) - xyz(on_whole.world().moments()[0])).norm() / (weight * radius));
  }
  force.verify(1e-12), moment.verify(1e-12);
  EXPECT_GT(on_whole.position(0).x(), 0.6 * tile) << "it crossed the tile";
  EXPECT_GT(touching, 10000) << "it rolled on the floor";
}

TEST_P(Seams, OfCoplanarWallsAreNotFelt) { expect_not_felt(tile_floor); }

TEST_P(Seams, OfCoplanarTrianglesAreNotFelt) {
  const StlFile file(stl_text(triangle_floor()));
  expect_not_felt([&](Description& d) { d["walls"]["floor"] = mesh(file); });
}

INSTANTIATE_TEST_SUITE_P(All, Seams,
                         testing::Combine(testing::Values("linear-frictional", "linear-rolling", "hertz-mindlin"),
                                          testing::Range(0, 4), testing::Values(0.05, 0.5)));

/// Balls next to the joint of two coplanar rectangles with an arbitrary orientation, where the edge of one and the face
/// of the other are equally near, except for rounding.
TEST(SeamsAskew, AreNotFeltBesideTheJoint) {
  Errors aside("sideways force on a ball beside a seam askew in space, over its weight");
  for (const double angle : {0.0, 0.3, 0.83, 1.9, 2.6}) {
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3(0.3, -0.7, 0.45).normalized()).toRotationMatrix();
    for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(0.0123, -0.0457, 0.0311), Vec3(1.03, -0.71, 0.37)}) {
      std::vector<Grain> grains;
      std::vector<double> beyond;
      for (const double radii : {0.0, 1e-14, 1e-11, 1e-9, 1e-8, 3e-8, 1e-7, 3e-7, 1e-6})
        for (const double side : {-1.0, 1.0}) {
          beyond.push_back(side * radii);
          const Vec3 place(3 * radius * static_cast<double>(grains.size()), side * radii * radius, 0.9993 * radius);
          grains.push_back({origin + turn * place, radius});
        }
      const auto count = static_cast<double>(grains.size());
      const double length = 3 * radius * count;
      const Vec3 along = turn * Vec3(length, 0, 0), across = turn * Vec3(0, tile, 0);
      Description d = description("linear-frictional", {{"friction_angle", 0.3}}, grains);
      d["walls"]["one"] = rectangle(origin - 0.5 / count * along, along, across);
      d["walls"]["other"] = rectangle(origin - 0.5 / count * along - across, along, across);
      const Trial trial(d);
      EXPECT_EQ(trial.world().contacts().size(), grains.size()) << angle << ", " << origin.transpose();
      for (std::size_t i = 0; i < grains.size(); ++i) {
        const Vec3 force = turn.transpose() * xyz(trial.world().forces()[i]);
        aside.add(force.y() / force.z());
        EXPECT_NEAR(force.y() / force.z(), 0, 1e-12) << beyond[i] << ", " << angle << ", " << origin.transpose();
      }
    }
  }
  aside.verify(1e-12);
}

TEST(Corners, AreTouchedOnceByEachFace) {
  Description d =
      description("linear-frictional", {{"friction_angle", 0.3}}, {{Vec3::Constant(0.999 * radius), radius}});
  d["walls"]["floor"] = rectangle(Vec3::Zero(), tile * Vec3::UnitX(), tile * Vec3::UnitY());
  d["walls"]["left"] = rectangle(Vec3::Zero(), tile * Vec3::UnitY(), tile * Vec3::UnitZ());
  d["walls"]["front"] = rectangle(Vec3::Zero(), tile * Vec3::UnitX(), tile * Vec3::UnitZ());
  const Trial trial(d);
  EXPECT_EQ(trial.world().contacts().size(), 3u);
  const Vec3 force = xyz(trial.world().forces()[0]);
  verify("force of one face of a corner over that of another", force.x() / force.z(), 1, 1e-12);
  verify("force of the third over that of another", force.y() / force.z(), 1, 1e-12);
}

TEST(Corners, AnEdgeThatTwoFacesShareCountsOnce) {
  // The ball overlaps the edge of a step: its top and its side give contacts at the same edge.
  const Vec3 out = Vec3(1, 0, 1).normalized();
  Description d = description("linear-frictional", {{"friction_angle", 0.3}}, {{0.999 * radius * out, radius}});
  d["walls"]["top"] = rectangle(Vec3(-tile, -tile, 0), tile * Vec3::UnitX(), 2 * tile * Vec3::UnitY());
  Description alone = d;
  d["walls"]["side"] = rectangle(Vec3(0, -tile, -tile), 2 * tile * Vec3::UnitY(), tile * Vec3::UnitZ());
  const Trial both(d), one(alone);
  ASSERT_EQ(both.world().contacts().size(), 1u);
  const Vec3 alone_force = xyz(one.world().forces()[0]);
  verify("force of an edge that two faces share, change over that of one",
         (xyz(both.world().forces()[0]) - alone_force).norm() / alone_force.norm(), 0, 1e-12, 1);
}

TEST(Corners, AShallowValleyKeepsBothFaces) {
  const double slope = 0.05;
  Description d = description("linear-frictional", {{"friction_angle", 0.3}},
                              {{Vec3(0, 0, 0.999 * radius / std::cos(slope)), radius}});
  d["walls"]["left"] = plane(Vec3::Zero(), Vec3(std::sin(slope), 0, std::cos(slope)));
  d["walls"]["right"] = plane(Vec3::Zero(), Vec3(-std::sin(slope), 0, std::cos(slope)));
  EXPECT_EQ(Trial(d).world().contacts().size(), 2u);
}

/// Balls at the same height at points along x, side by side along y; force on each over that of a plane.
std::vector<Vec3> forces_along(const std::vector<double>& places, double overlap, const Description& walls) {
  std::vector<Grain> grains;
  for (std::size_t i = 0; i < places.size(); ++i)
    grains.push_back({{places[i], 3 * radius * static_cast<double>(i), radius - overlap}, radius});
  Description d = description("linear-frictional", {{"friction_angle", 0.0}}, grains);
  d["walls"] = walls;
  Description whole = d;
  whole["walls"] = {{"floor", plane(Vec3::Zero(), Vec3::UnitZ())}};
  const Trial trial(d), flat(whole);
  std::vector<Vec3> forces;
  for (std::size_t i = 0; i < places.size(); ++i)
    forces.push_back(xyz(trial.world().forces()[i]) / flat.world().forces()[i].z);
  return forces;
}

/// Force of frictionless lands on such a ball, each at its closest point.
Vec3 by_each(double x, double overlap, const std::vector<std::pair<double, double>>& lands) {
  Vec3 force = Vec3::Zero();
  for (const auto& [from, to] : lands) {
    const Vec3 away(x - std::clamp(x, from, to), 0, radius - overlap);
    force += std::max(0.0, radius - away.norm()) / overlap * away.normalized();
  }
  return force;
}

/// From above one land to above the next.
constexpr double groove = 40e-6, land = 60e-6, pressed = 2e-6;

void expect_each_land_once(const std::string& of, const Description& walls,
                           const std::vector<std::pair<double, double>>& lands) {
  std::vector<double> places;
  for (int i = 0; i <= 40; ++i) places.push_back((land + groove) * i / 40);
  const std::vector<Vec3> forces = forces_along(places, pressed, walls);
  Errors error("force of " + of + " on a ball over them, off that of each at its closest place, over that of a plane");
  for (std::size_t i = 0; i < places.size(); ++i) error.add((forces[i] - by_each(places[i], pressed, lands)).norm());
  error.verify(1e-9);
}

TEST(Gaps, BetweenCoplanarWallsLeaveEachItsForce) {
  const auto sheet = [](double from) { return rectangle(Vec3(from, -1, 0), land * Vec3::UnitX(), 2 * Vec3::UnitY()); };
  expect_each_land_once("two sheets with a gap between them", {{"left", sheet(0)}, {"right", sheet(land + groove)}},
                        {{0, land}, {land + groove, 2 * land + groove}});
}

TEST(Gaps, BetweenLandsLeaveEachItsForce) {
  constexpr double spacing = land + groove;
  const Description walls = {{"floor",
                              {{"type", "saw-tooth"},
                               {"corner", vector(Vec3(-20 * spacing, -1, 0))},
                               {"edge_a", vector(Vec3(40 * spacing, 0, 0))},
                               {"edge_b", vector(Vec3(0, 2, 0))},
                               {"depth", groove / 2},
                               {"spacing", spacing},
                               {"offset", land},
                               {"material", "grain"}}}};
  std::vector<std::pair<double, double>> lands;
  for (int i = -20; i < 20; ++i) lands.emplace_back(i * spacing, i * spacing + land);
  expect_each_land_once("lands between grooves", walls, lands);
}

TEST(Gaps, AreClosedByAWallBetween) {
  const auto sheet = [](double from, double to) {
    return rectangle(Vec3(from, -1, 0), (to - from) * Vec3::UnitX(), 2 * Vec3::UnitY());
  };
  // The ball extends over the narrow sheet in the middle.
  const std::vector<Vec3> forces =
      forces_along({-0.01e-3, 0, 0.01e-3, 0.02e-3, 0.03e-3}, pressed,
                   {{"left", sheet(-tile, 0)}, {"middle", sheet(0, 0.02e-3)}, {"right", sheet(0.02e-3, tile)}});
  Errors error("force of three coplanar sheets on a ball that reaches over one of them, off that of a plane");
  for (const Vec3& force : forces) error.add((force - Vec3::UnitZ()).norm());
  error.verify(1e-12);
}

}  // namespace
}  // namespace grit::test::seams_tests
