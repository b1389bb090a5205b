#include "bodies/lattice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "grit/error.hpp"
#include "support/scene.hpp"

namespace grit::test::lattice_tests {
namespace {

using testing::HasSubstr;

const Cell open_cell{Vec3::Constant(-std::numeric_limits<double>::infinity()),
                     Vec3::Constant(std::numeric_limits<double>::infinity())};

struct Expected {
  const char* kind;
  Vec3 repeat;  // over the spacing
  std::size_t bodies, neighbours;
  double solid_fraction;
};
/// Closed forms, e.g. of C. Kittel, Introduction to Solid State Physics, chapter 1.
const Expected expected[] = {
    {"simple-cubic", Vec3::Ones(), 1, 6, std::numbers::pi / 6},
    {"bcc", Vec3::Constant(2 / std::sqrt(3.0)), 2, 8, std::numbers::pi* std::sqrt(3.0) / 8},
    {"fcc", Vec3::Constant(std::sqrt(2.0)), 4, 12, std::numbers::pi / std::sqrt(18.0)},
    {"hcp", {1, std::sqrt(3.0), std::sqrt(8.0 / 3)}, 4, 12, std::numbers::pi / std::sqrt(18.0)}};

LatticeSource lattice(const std::string& kind, const Vec3& low, const Vec3& high, double diameter) {
  LatticeSource source;
  source.kind = kind, source.low = low, source.high = high, source.diameter = diameter;
  return source;
}

/// Distances from a body to all others and their images, over the spacing.
std::vector<double> distances(const std::vector<Row>& bodies, std::size_t from, double spacing, const Vec3& period) {
  std::vector<double> all;
  for (std::size_t j = 0; j < bodies.size(); ++j)
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const Vec3 shift = period.cwiseProduct(Vec3(x, y, z));
          if (j == from && shift.isZero(0.0)) continue;
          all.push_back((xyz(bodies[j]) + shift - xyz(bodies[from])).norm() / spacing);
        }
  std::ranges::sort(all);
  return all;
}

TEST(Lattice, TilesAPeriodicCell) {
  constexpr double spacing = 2e-3;
  for (const Expected& one : expected) {
    const Vec3 low(0.1, -0.2, 0.3), period = spacing * one.repeat.cwiseProduct(Vec3(4, 3, 3));
    const Cell cell{low, low + period, {true, true, true}};
    const auto bodies = make_lattice(lattice(one.kind, cell.low, cell.high, spacing), cell);
    ASSERT_EQ(bodies.size(), 36 * one.bodies) << one.kind;
    double solid = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      EXPECT_TRUE((xyz(bodies[i]).array() >= cell.low.array()).all() &&
                  (xyz(bodies[i]).array() < cell.high.array()).all());
      const auto near = distances(bodies, i, spacing, period);
      EXPECT_NEAR(near.front(), 1, 1e-12) << one.kind;
      EXPECT_NEAR(near[one.neighbours - 1], 1, 1e-12) << one.kind;
      EXPECT_GT(near[one.neighbours], 1.15) << one.kind;  // the second shell of bcc, 2/√3
      solid += 4.0 / 3 * std::numbers::pi * std::pow(bodies[i].w, 3);
    }
    EXPECT_NEAR(solid / period.prod(), one.solid_fraction, 1e-9) << one.kind;
  }
}

TEST(Lattice, FillsABoxWithWholeBodies) {
  // Spheres that fit exactly between the sides count.
  auto bodies = make_lattice(lattice("simple-cubic", {1, 2, 3}, {5, 5, 5}, 1), open_cell);
  ASSERT_EQ(bodies.size(), 4u * 3 * 2);
  EXPECT_EQ(xyz(bodies.front()), Vec3(1.5, 2.5, 3.5));
  EXPECT_EQ(xyz(bodies[1]), Vec3(2.5, 2.5, 3.5));
  EXPECT_EQ(xyz(bodies.back()), Vec3(4.5, 4.5, 4.5));
  const double side = 1 + std::sqrt(2.0);
  bodies = make_lattice(lattice("fcc", Vec3::Zero(), Vec3::Constant(side), 1), open_cell);
  EXPECT_EQ(bodies.size(), 14u);  // corners and faces of a cube
  bodies = make_lattice(lattice("fcc", Vec3::Zero(), Vec3(side, side, side - 1e-6), 1), open_cell);
  EXPECT_EQ(bodies.size(), 9u);  // the upper face is gone
  bodies = make_lattice(lattice("bcc", Vec3::Zero(), Vec3::Constant(1 + 2 / std::sqrt(3.0)), 1), open_cell);
  EXPECT_EQ(bodies.size(), 9u);
  for (const Row& body : make_lattice(lattice("hcp", Vec3::Zero(), Vec3(7.3, 6.1, 5.9), 1), open_cell)) {
    EXPECT_GE(xyz(body).minCoeff(), 0.5);
    EXPECT_TRUE((xyz(body).array() <= Vec3(6.8, 5.6, 5.4).array()).all());
  }
}

TEST(Lattice, HasASpacing) {
  LatticeSource source = lattice("simple-cubic", Vec3::Zero(), Vec3(4, 1, 1), 1);
  source.spacing = 1.5;
  const auto bodies = make_lattice(source, open_cell);
  ASSERT_EQ(bodies.size(), 3u);
  EXPECT_EQ(bodies[2].x, 3.5);
  EXPECT_EQ(bodies[2].w, 0.5);
}

TEST(Lattice, IsCountedWithoutBeingMade) {
  for (const Expected& one : expected) {
    LatticeSource source = lattice(one.kind, Vec3::Zero(), Vec3(7.3, 6.1, 5.9), 1);
    source.spacing = 1.1;
    EXPECT_EQ(count_of_lattice(source, {}), make_lattice(source, open_cell).size()) << one.kind;
    source.high = 1.1 * one.repeat.cwiseProduct(Vec3(4, 3, 3));
    const Cell cell{source.low, source.high, {true, false, true}};
    EXPECT_EQ(count_of_lattice(source, cell.periodic), make_lattice(source, cell).size()) << one.kind;
  }
}

TEST(Lattice, IsCountedBeyondAllIntegers) {
  const LatticeSource tiny = lattice("simple-cubic", Vec3::Zero(), Vec3::Ones(), 1e-12);
  EXPECT_NEAR(count_of_lattice(tiny, {}), 1e36, 1e25);
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, {});
  d["bodies"]["grains"]["source"] = {
      {"type", "lattice"}, {"kind", "simple-cubic"}, {"low", {0, 0, 0}}, {"high", {1, 1, 1}}, {"diameter", 1e-12}};
  const Scene scene = scene_of(d);
  const std::shared_ptr<const BodyKind> sphere = scene.description->bodies.at("grains").kind.make();
  EXPECT_GE(body_count(*scene.description, "grains", sphere), 1'000'000'000'000u);
}

TEST(Lattice, ReportsWhatDoesNotFit) {
  const auto message = [](const LatticeSource& source, const Cell& cell) -> std::string {
    try {
      make_lattice(source, cell);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const Cell cell{Vec3::Zero(), Vec3(5, 5, 5.5), {true, true, true}};
  EXPECT_EQ(message(lattice("simple-cubic", cell.low, cell.high, 1), cell),
            "lattice: the box is 5.5 repeat lengths of 1 m long along the periodic axis z; use a whole number of them, "
            "such as 6 with a spacing of 0.9166666667 m");
  EXPECT_THAT(message(lattice("bcc", {0, 0, -1}, cell.high, 1), cell), HasSubstr("lattice: the box ( 0  0 -1) … "));
  EXPECT_EQ(message(lattice("bcc", Vec3::Zero(), Vec3(5, 0.9, 5), 1), open_cell),
            "lattice: no body of diameter 1 m fits into the box; use a larger box or a smaller diameter");
  for (const double diameter : {1e-5, 1e-12, 1e-200})
    EXPECT_THAT(message(lattice("fcc", Vec3::Zero(), Vec3::Ones(), diameter), open_cell),
                HasSubstr("bodies; allowed are up to 4e9"))
        << diameter;
}

/// A scene of close-packed spheres that overlap a little, periodic in all directions.
Description close_packed(const std::string& kind, const Vec3& repeat, double spacing) {
  Description d = description("linear-rolling", {{"contact_modulus", 1e6}}, {});
  const Vec3 high = spacing * repeat.cwiseProduct(Vec3(4, 3, 3));
  d["domain"] = {{"low", {0, 0, 0}}, {"high", vector(high)}, {"periodic", {true, true, true}}};
  d["bodies"]["grains"]["source"] = {
      {"type", "lattice"},           {"kind", kind},      {"low", {0, 0, 0}}, {"high", vector(high)},
      {"diameter", 1.001 * spacing}, {"spacing", spacing}};
  return d;
}

TEST(Lattice, HasItsContactsAcrossPeriodicSides) {
  for (const Expected& one : expected) {
    const Trial trial(close_packed(one.kind, one.repeat, 2e-3));
    const World& world = trial.world();
    std::vector<std::size_t> contacts(world.ids().size(), 0);
    for (const Contact& contact : world.contacts()) ++contacts[contact.a], ++contacts[contact.b];
    EXPECT_EQ(contacts, std::vector<std::size_t>(36 * one.bodies, one.neighbours)) << one.kind;
    double force = 0;
    for (const Row& f : world.forces()) force = std::max(force, xyz(f).norm());
    double normal = 0;
    for (const Contact& contact : world.contacts()) normal = std::max(normal, contact.force.norm());
    EXPECT_LT(force, 1e-9 * normal) << one.kind;
  }
}

TEST(Lattice, OfADescriptionIsChecked) {
  const auto message = [](const char* key, const Description& value) -> std::string {
    Description d = close_packed("fcc", Vec3::Ones(), 2e-3);
    d["bodies"]["grains"]["source"][key] = value;
    try {
      scene_of(d);
    } catch (const DescriptionError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(
      message("kind", "diamond"),
      HasSubstr("/bodies/grains/source/kind: found \"diamond\"; allowed is one of simple-cubic, bcc, fcc, hcp"));
  EXPECT_THAT(message("diameter", 0), HasSubstr("/bodies/grains/source/diameter: found 0 m; allowed is above 0 m"));
  EXPECT_THAT(message("high", {0, 1, 1}), HasSubstr("/bodies/grains/source/high/0: found high not above low along x"));
}

}  // namespace
}  // namespace grit::test::lattice_tests
