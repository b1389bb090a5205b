// Rolling and twisting resistance in isolation, for a pair and at a wall: centres are held, and there is no friction. A
// spring oscillates according to its stiffness, and at its limit the deceleration follows from the limit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::turning_springs_tests {
namespace {

using std::numbers::pi;

constexpr double radius_a = 2e-3, radius_b = 1e-3, depth = 1e-7, density = 2500;
constexpr double modulus = 1e8, poisson = 0.3, shear_ratio = 0.4, turning_ratio = 0.7;

struct Turning {
  std::string law, kind;  ///< "rolling" or "twisting"
  bool wall;              ///< wall, or a sphere of another radius

  friend void PrintTo(const Turning& turning, std::ostream* out) { *out << turning.words(); }
  std::string words() const { return kind + (wall ? " on a wall, " : " on another, ") + law; }

  bool hertz() const { return law == "hertz-mindlin"; }
  Vec3 axis() const { return kind == "rolling" ? Vec3::UnitX() : Vec3::UnitZ(); }
  double reduced_radius() const { return wall ? radius_b : radius_a * radius_b / (radius_a + radius_b); }
  double area_radius() const { return std::sqrt(reduced_radius() * depth); }
  double spring() const { return wall ? modulus * radius_b : 2 * modulus * reduced_radius(); }
  double force() const {
    return hertz() ? 2.0 / 3 * modulus / (1 - poisson * poisson) * area_radius() * depth : spring() * depth;
  }
  /// β K_s R_a R_b
  double stiffness() const {
    const double shear =
        hertz() ? 2 * modulus / ((2 - poisson) * (1 + poisson)) * area_radius() : shear_ratio * spring();
    return turning_ratio * shear * (wall ? radius_b : radius_a) * radius_b;
  }
  double arm() const { return wall ? radius_b : 0.5 * (radius_a + radius_b); }
  static double inertia(double r) { return 0.4 * density * 4 / 3 * pi * std::pow(r, 5); }
  double inverse_inertia() const { return 1 / inertia(radius_b) + (wall ? 0 : 1 / inertia(radius_a)); }
  double frequency() const { return std::sqrt(stiffness() * inverse_inertia()); }

  Description scene(double limit, double spin) const {
    Description m{{"density", density}, {"friction_angle", 0}};
    if (hertz()) m["young_modulus"] = modulus, m["poisson_ratio"] = poisson;
    else m["contact_modulus"] = modulus, m["shear_to_normal_stiffness"] = shear_ratio, m["rolling_limit"] = 0;
    m[kind + "_stiffness"] = turning_ratio, m[kind + "_limit"] = limit;
    std::vector<Grain> grains{{{0, 0, radius_b - depth}, radius_b, Vec3::Zero(), spin * axis()}};
    if (!wall) grains.push_back({{0, 0, -radius_a}, radius_a});
    Description d = description(law, m, grains);
    if (wall) d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["engines"]["hold"] = {{"type", "hold"}, {"rotation", "none"}, {"translation", "xyz"}};
    d["time_step"]["value"] = 2 * pi / frequency() / 2000;
    return d;
  }
  double spin(const Trial& t) const { return axis().dot(t.spin(0)) - (wall ? 0 : axis().dot(t.spin(1))); }
};

class TurningSprings : public testing::TestWithParam<Turning> {};

TEST_P(TurningSprings, SwingAsTheirStiffnessSays) {
  const Turning& turning = GetParam();
  Trial t(turning.scene(100, 1e-3));
  double before = 0, now = turning.spin(t);
  while (now > 0) {
    ASSERT_LT(t.world().step(), 1000u);
    t.step();
    before = std::exchange(now, turning.spin(t));
  }
  const double zero = t.world().time() - now / (now - before) * t.world().dt();
  verify("quarter of a swing of a sphere that resists " + turning.words() + " [s]", zero,
         0.5 * pi / turning.frequency(), 1e-5);
}

TEST_P(TurningSprings, BrakeAsTheirLimitSays) {
  const Turning& turning = GetParam();
  constexpr double limit = 0.3, spin = 1e3;
  Trial t(turning.scene(limit, spin));
  t.step(200);
  const double before = turning.spin(t);
  t.step(2000);
  const double braked = (before - turning.spin(t)) / (2000 * t.world().dt());
  verify("deceleration of a sphere that resists " + turning.words() + " [rad/s²]", braked,
         limit * turning.arm() * turning.force() * turning.inverse_inertia(), 1e-9);
  EXPECT_GT(turning.spin(t), 0.1 * spin);
}

INSTANTIATE_TEST_SUITE_P(
    All, TurningSprings,
    testing::Values(Turning{"linear-rolling", "rolling", false}, Turning{"linear-rolling", "rolling", true},
                    Turning{"linear-rolling", "twisting", false}, Turning{"linear-rolling", "twisting", true},
                    Turning{"hertz-mindlin", "rolling", false}, Turning{"hertz-mindlin", "rolling", true}));

}  // namespace
}  // namespace grit::test::turning_springs_tests
