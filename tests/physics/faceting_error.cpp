// A curved surface and meshes with their corners on it: differences of forces, and their order in the size of facets.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/order.hpp"
#include "support/scene.hpp"
#include "support/stl_file.hpp"
#include "support/verified.hpp"

namespace grit::test::faceting_error_tests {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double radius = 0.05, overlap = 0.02, row = 2.5 * radius;  // of the grains; spacing of grains
constexpr int count = 400;
/// Low-discrepancy numbers in [0, 1).
double evenly(int i) { return std::fmod(i * std::numbers::phi, 1); }

/// Forces of a wall on the grains.
std::vector<Vec3> forces(Description wall, const std::vector<Grain>& grains) {
  Description d = description("linear-frictional", {{"contact_modulus", 1e6}}, grains);
  wall["material"] = "grain";
  d["walls"]["wall"] = std::move(wall);
  d["guards"] = {{"overlap", 1.0}};
  const Trial trial(d);
  std::vector<Vec3> sum(grains.size(), Vec3::Zero());
  for (const Contact& contact : trial.world().contacts()) {
    EXPECT_TRUE(contact.with_wall);
    sum[trial.world().ids()[contact.a]] -= contact.force;
  }
  return sum;
}

/// Root-mean-square errors over all grains.
struct Difference {
  double strength = 0, direction = 0;  ///< of magnitudes, relative; of directions [rad]
};
Difference difference(const std::vector<Vec3>& found, const std::vector<Vec3>& known) {
  Difference sum;
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_GT(known[i].norm(), 0) << "grain " << i << " has no contact";
    sum.strength += std::pow(found[i].norm() / known[i].norm() - 1, 2);
    sum.direction += (found[i].normalized() - known[i].normalized()).squaredNorm();
  }
  const auto n = static_cast<double>(known.size());
  return {std::sqrt(sum.strength / n), std::sqrt(sum.direction / n)};
}

void add_strip(std::vector<Vec3>& corners, const Vec3& a, const Vec3& b, const Vec3& along) {
  corners.insert(corners.end(), {a, b, b + along, a, b + along, a + along});
}

/// Compares forces of a surface with those of its meshes with n strips per turn or wavelength, made by `strips(n)`.
template <class Strips>
void expect_second_order(const std::string& name, const Description& analytic, const std::vector<Grain>& grains,
                         const Description& more, Strips strips) {
  const auto known = forces(analytic, grains);
  std::vector<double> sizes, strengths, directions;
  for (const int n : {32, 64, 128, 256}) {
    const StlFile file(stl_text(strips(n)));
    Description mesh{
        {"type", "mesh"}, {"path", file.path()}, {"scale", 1.0}, {"merge_distance", 1e-12}, {"open", true}};
    mesh.update(more);
    const Difference off = difference(forces(mesh, grains), known);
    sizes.push_back(1.0 / n), strengths.push_back(off.strength), directions.push_back(off.direction);
  }
  verify("order at which forces' strength errs with the size of facets, " + name, order(sizes, strengths), 2, 0.01);
  verify("order at which their direction does, " + name, order(sizes, directions), 1, 0.01);
}

// Grains on a helix, not in contact with each other.
void expect_cylinder_at_second_order(bool inside) {
  const double length = (count + 1) * row, from_axis = inside ? 1 - radius + overlap : 1 + radius - overlap;
  std::vector<Grain> grains;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * pi * evenly(i);
    grains.push_back({{from_axis * std::cos(angle), from_axis * std::sin(angle), (i + 1) * row}, radius});
  }
  const Description cylinder{
      {"type", "cylinder"}, {"start", {0, 0, 0}}, {"end", {0, 0, length}}, {"radius", 1.0}, {"inside", inside}};
  expect_second_order(inside ? "inside a cylinder" : "outside a cylinder", cylinder, grains, {{"inside", inside}},
                      [&](int n) {
                        const auto at = [&](int i) -> Vec3 {
                          return {std::cos(2 * pi * (i % n) / n), std::sin(2 * pi * (i % n) / n), 0};
                        };
                        std::vector<Vec3> corners;
                        for (int i = 0; i < n; ++i) add_strip(corners, at(i), at(i + 1), {0, 0, length});
                        return corners;
                      });
}

TEST(FacetingError, InsideACylinderFallsAtSecondOrder) { expect_cylinder_at_second_order(true); }
TEST(FacetingError, OutsideACylinderFallsAtSecondOrder) { expect_cylinder_at_second_order(false); }

TEST(FacetingError, OnWavesFallsAtSecondOrder) {
  constexpr double depth = 0.1, breadth = (count + 1) * row;
  const auto at = [](double x) -> Vec3 { return {x, 0, -depth * std::pow(std::sin(pi * x), 2)}; };
  std::vector<Grain> grains;
  for (int i = 0; i < count; ++i) {
    const double x = 1 + evenly(i), slope = -pi * depth * std::sin(2 * pi * x);
    const Vec3 out = Vec3(-slope, 0, 1).normalized();
    grains.push_back({at(x) + (radius - overlap) * out + Vec3(0, (i + 1) * row, 0), radius});
  }
  const Description waves{{"type", "sinusoidal"},      {"corner", {0, 0, 0}}, {"edge_a", {3, 0, 0}},
                          {"edge_b", {0, breadth, 0}}, {"depth", depth},      {"wavelength", 1.0}};
  expect_second_order("on waves", waves, grains, Description::object(), [&](int n) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 3 * n; ++i)
      add_strip(corners, at(static_cast<double>(i) / n), at(static_cast<double>(i + 1) / n), {0, breadth, 0});
    return corners;
  });
}

}  // namespace
}  // namespace grit::test::faceting_error_tests
