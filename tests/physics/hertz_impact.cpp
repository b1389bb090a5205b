// Chung & Ooi (2011), doi 10.1007/s10035-011-0277-0, tests 1 to 3, as complete runs: overlap, force and duration of
// elastic Hertzian impacts, and rebound with dashpots.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::hertz_impact_tests {
namespace {

struct Impact {
  const char* name;
  double modulus, poisson, density, radius, speed;
  bool plane;  ///< rigid; otherwise an identical sphere with the opposite velocity

  friend void PrintTo(const Impact& impact, std::ostream* out) { *out << impact.name; }
  double mass() const { return density * 4 / 3 * std::numbers::pi * std::pow(radius, 3); }
  double closing() const { return plane ? speed : 2 * speed; }
  double effective_mass() const { return plane ? mass() : mass() / 2; }
  double spring() const {  ///< 4/3 E* √R*
    return 4.0 / 3 * modulus / (1 - poisson * poisson) / (plane ? 1 : 2) * std::sqrt(plane ? radius : radius / 2);
  }
  double overlap() const { return std::pow(1.25 * effective_mass() * closing() * closing() / spring(), 0.4); }
  double force() const { return spring() * std::pow(overlap(), 1.5); }
  double duration() const {  ///< 2 ∫ dx / √(1 − x^2.5) = 2.9432…
    return 4 * std::sqrt(std::numbers::pi) / 5 * std::tgamma(0.4) / std::tgamma(0.9) * overlap() / closing();
  }
};

Description scene(const Impact& impact, double restitution, double dt) {
  const double r = impact.radius;
  std::vector<Grain> grains{{{0, 0, r}, r, {0, 0, -impact.speed}}};
  if (!impact.plane) grains.push_back({{0, 0, -r}, r, {0, 0, impact.speed}});
  Description d = description("hertz-mindlin",
                              {{"density", impact.density},
                               {"young_modulus", impact.modulus},
                               {"poisson_ratio", impact.poisson},
                               {"restitution", restitution},
                               {"friction_angle", "19.29 deg"}},
                              grains);
  if (impact.plane) {
    d["materials"]["rigid"] = {{"young_modulus", 1e30}, {"friction_angle", "19.29 deg"}};
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ(), "rigid");
  }
  d["time_step"]["value"] = dt;
  return d;
}

class ChungOoi : public testing::TestWithParam<Impact> {};

TEST_P(ChungOoi, OverlapForceAndDuration) {
  const Impact& impact = GetParam();
  Trial t(scene(impact, 1, impact.duration() / 4000));
  const double share = impact.plane ? 1 : 2;
  double overlap = 0, force = 0;
  do {
    t.step();
    overlap = std::max(overlap, share * (impact.radius - t.position(0).z()));
    for (const Contact& contact : t.world().contacts()) force = std::max(force, contact.normal_force);
  } while (t.position(0).z() < impact.radius);
  const double speed = t.velocity(0).z(), duration = t.world().time() - (t.position(0).z() - impact.radius) / speed;
  // Error of second order in the step: (dt/duration)² = 6e-8, and sampling of the maxima.
  verify("overlap [m]", overlap, impact.overlap(), 1e-7);
  verify("force [N]", force, impact.force(), 1e-7);
  verify("duration [s]", duration, impact.duration(), 1e-7);
  verify("speed of rebound [m/s]", speed, impact.speed, 1e-10);
  EXPECT_EQ(t.spin(0).norm(), 0);
}

TEST_P(ChungOoi, ReboundsAsTheRestitutionSays) {
  const Impact& impact = GetParam();
  for (const double e : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    Trial t(scene(impact, e, impact.duration() / 4000));
    do t.step();
    while (t.position(0).z() < impact.radius);
    // The dashpot uses velocities half a step old: first order, at most a fifth of dt/duration.
    char what[48];
    std::snprintf(what, sizeof what, "restitution of %.1f, error absolute", e);
    verify(what, t.velocity(0).z() / impact.speed, e, 1e-4, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Hertz, ChungOoi,
                         testing::Values(Impact{"Test1Glass", 48e9, 0.20, 2800, 0.01, 10, false},
                                         Impact{"Test1Limestone", 20e9, 0.25, 2500, 0.01, 10, false},
                                         Impact{"Test2AluminiumAlloy", 70e9, 0.30, 2699, 0.1, 0.2, true},
                                         Impact{"Test2MagnesiumAlloy", 40e9, 0.35, 1800, 0.1, 0.2, true},
                                         Impact{"Test3AluminiumOxide", 380e9, 0.23, 4000, 0.0025, 3.9, true},
                                         Impact{"Test3CastIron", 100e9, 0.25, 7000, 0.0025, 3.9, true}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace grit::test::hertz_impact_tests
