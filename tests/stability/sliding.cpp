// A block and a ball on a slope at the limits of sliding and rolling: the friction angle from both sides, and creep
// below it. The plane is horizontal and gravity is inclined.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/mapped.hpp"
#include "support/scene.hpp"

namespace grit::test::sliding_tests {
namespace {

constexpr double g = 9.81, radius = 0.01, density = 2500, modulus = 1e8;

struct Edge {
  std::string name, law;
  double friction, rolling_limit;
  bool turns;  ///< a ball; otherwise a block, a sphere without rotation

  double limit() const { return turns ? std::min(rolling_limit, friction) : friction; }
  /// Steady acceleration at a slope above the limit [m/s²].
  double acceleration(double slope) const {
    const double angle = std::atan(slope), beyond = g * (std::sin(angle) - limit() * std::cos(angle));
    return turns ? 5.0 / 7 * beyond : beyond;
  }
};

Trial on_slope(const Edge& edge, double slope, double damping) {
  const double angle = std::atan(slope);
  Description m{{"density", density}, {"friction_angle", std::atan(edge.friction)}};
  m[edge.law == "hertz-mindlin" ? "young_modulus" : "contact_modulus"] = modulus;
  if (edge.law == "linear-rolling") m["rolling_limit"] = edge.turns ? edge.rolling_limit : 0;
  // Overlap by its weight.
  const double mass = density * 4 / 3 * std::numbers::pi * std::pow(radius, 3), weight = mass * g * std::cos(angle);
  const double curved = 4.0 / 3 * modulus / (2 * (1 - 0.3 * 0.3)) * std::sqrt(radius);
  const double sunk = edge.law == "hertz-mindlin" ? std::pow(weight / curved, 2.0 / 3) : weight / (modulus * radius);
  Description d = description(edge.law, m, {{{0, 0, radius - sunk}, radius}});
  d["walls"]["slope"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {g * std::sin(angle), 0, -g * std::cos(angle)}}};
  if (!edge.turns) d["engines"]["hold"] = {{"type", "hold"}, {"rotation", "xyz"}};
  if (damping > 0) d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", damping}};
  d["guards"] = {{"energy", 1}, {"travel", 1}};
  return Trial(d);
}
void until(Trial& t, double time) {
  while (t.world().time() < time) t.step();
}

/// Mean speed [m/s] after initial slip by oscillations of the springs has ended.
double creep(const Edge& edge, double slope) {
  Trial t = on_slope(edge, slope, 0.3);
  until(t, 1);
  const double place = t.position(0).x();
  until(t, 1.2);
  return (t.position(0).x() - place) / 0.2;
}
/// Undamped; oscillations of the springs average out.
double acceleration(const Edge& edge, double slope) {
  Trial t = on_slope(edge, slope, 0);
  until(t, 0.5);
  const double first = t.world().time(), place = t.position(0).x();
  until(t, 1);
  const double middle = t.world().time(), way = t.position(0).x() - place;
  until(t, 2 * middle - first);
  return (t.position(0).x() - place - 2 * way) / std::pow(middle - first, 2);
}

class Sliding : public testing::TestWithParam<Edge> {};

TEST_P(Sliding, BeginsAtTheAngleOfFrictionAndNothingCreepsBelow) {
  const Edge& edge = GetParam();
  const auto& map =
      "acceleration over gravity, or speed of creep over √(g R) below|distance of the slope from its limit";
  constexpr double nearest = 1e-3;
  figure("distance from the limit of friction, of it", nearest);
  for (const double beyond : {nearest, 3e-3, 1e-2, 3e-2, 0.1, 0.3}) {
    const double below = creep(edge, (1 - beyond) * edge.limit()) / std::sqrt(g * radius);
    const double slope = (1 + beyond) * edge.limit(), above = acceleration(edge, slope);
    EXPECT_LT(std::abs(below), 1e-12) << edge.name << ' ' << beyond;
    EXPECT_NEAR(above / edge.acceleration(slope), 1, 2e-2) << edge.name << ' ' << beyond;
    map_point(map, edge.name + ", slides above", beyond, above / g);
    map_point(map, "predicted, " + edge.name, beyond, edge.acceleration(slope) / g);
    map_point(map, edge.name + ", creeps below", beyond, std::max(std::abs(below), 1e-16));
  }
}

INSTANTIATE_TEST_SUITE_P(All, Sliding,
                         testing::Values(Edge{"block", "linear-frictional", 0.3, 0, false},
                                         Edge{"block, Hertz", "hertz-mindlin", 0.3, 0, false},
                                         Edge{"ball that resists rolling", "linear-rolling", 0.8, 0.1, true}),
                         [](const auto& info) { return "case" + std::to_string(info.index); });

}  // namespace
}  // namespace grit::test::sliding_tests
