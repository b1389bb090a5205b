// The contract of contact laws, and Hertz impact, restitution, Mindlin shear and rolling.
#include <gmock/gmock.h>

#include "grit/contact/law_parameters.hpp"
#include "grit/contact/restitution.hpp"
#include "grit/testing/collision.hpp"
#include "grit/testing/contact_law.hpp"

namespace grit::test {
namespace {

using std::numbers::pi;

Values material(double modulus, double poisson, double friction_degrees, double restitution, double rolling = 0) {
  return {{"young_modulus", modulus},   {"poisson_ratio", poisson},     {"friction_angle", friction_degrees * degree},
          {"restitution", restitution}, {"rolling_stiffness", rolling}, {"rolling_limit", 0.6 * rolling}};
}
LawValues three(double friction, double restitution, double rolling) {
  return {{},
          {material(5e6, 0.2, friction, restitution, rolling), material(1e7, 0.3, friction, restitution, rolling),
           material(3e6, 0.45, 0.5 * friction, restitution, 0.5 * rolling)},
          {}};
}
std::vector<LawSetup> setups() {
  std::vector<LawSetup> all;
  for (const bool friction : {false, true})
    for (const bool damping : {false, true})
      for (const bool rolling : {false, true}) {
        std::string name = friction ? "Frictional" : "Smooth";
        if (damping) name += "Damped";
        if (rolling) name += "Rolling";
        all.push_back({.name = name,
                       .values = three(friction ? 25 : 0, damping ? 0.4 : 1, rolling ? 0.5 : 0),
                       .state_size = rolling    ? (friction ? 7u : 4u)
                                     : friction ? 4u
                                                : 0u,
                       .wall_sphere = 1e6});
      }
  return all;
}
INSTANTIATE_TEST_SUITE_P(HertzMindlin, ContactLawContract, testing::ValuesIn(setups()), setup_name);

std::unique_ptr<ContactLaw> law_of(const Values& values) { return make_law({{}, {values}, {}}); }

/// Chung & Ooi (2011), doi 10.1007/s10035-011-0277-0, verification tests 1 to 3.
struct Impact {
  const char* what;
  double modulus, poisson, density, radius, speed;  ///< relative speed
  bool plane;                                       ///< rigid
  double overlap, force, duration;                  ///< µm, N, µs
};
class ChungOoi : public testing::TestWithParam<Impact> {};

TEST_P(ChungOoi, OverlapForceAndDuration) {
  const Impact& impact = GetParam();
  const double mass = impact.density * 4 / 3 * pi * std::pow(impact.radius, 3);
  Values grain = material(impact.modulus, impact.poisson, 0, 1), wall = grain;
  wall["young_modulus"] = 1e30;  // rigid
  const auto law = make_law({{}, {grain, wall}, {}});
  const double dt = 1e-4 * 1e-6 * impact.duration;
  const Ball ball{.radius = impact.radius, .mass = mass};
  const Collision hit =
      impact.plane ? collide_with_wall(*law, ball, impact.speed, dt, 1) : collide(*law, ball, ball, impact.speed, dt);
  EXPECT_NEAR(hit.overlap * 1e6, impact.overlap, 1e-4 * impact.overlap) << impact.what;
  EXPECT_NEAR(hit.force, impact.force, 1e-4 * impact.force) << impact.what;
  EXPECT_NEAR(hit.duration * 1e6, impact.duration, 1e-3 * impact.duration) << impact.what;
  EXPECT_NEAR(hit.restitution, 1, 1e-6);
}
INSTANTIATE_TEST_SUITE_P(
    HertzMindlin, ChungOoi,
    testing::Values(Impact{"1 glass", 48e9, 0.2, 2800, 0.01, 20, false, 274.113, 10696.9, 40.338},
                    Impact{"1 limestone", 20e9, 0.25, 2500, 0.01, 20, false, 368.304, 7108.24, 54.200},
                    Impact{"2 aluminium alloy", 70e9, 0.3, 2699, 0.1, 0.2, true, 49.7172, 11369.9, 731.64},
                    Impact{"2 magnesium alloy", 40e9, 0.35, 1800, 0.1, 0.2, true, 52.1233, 7232.68, 767.05},
                    Impact{"3 aluminium oxide", 380e9, 0.23, 4000, 0.0025, 3.9, true, 8.0888, 615.352, 6.1044},
                    Impact{"3 cast iron", 100e9, 0.25, 7000, 0.0025, 3.9, true, 17.1887, 506.760, 12.972}));

TEST(HertzMindlin, RestitutionEqualsItsParameter) {
  // Test 3 of Chung & Ooi; the time step follows from the duration of the elastic impact.
  struct Case {
    double modulus, poisson, density, duration;
  };
  for (const Case& c : {Case{380e9, 0.23, 4000, 6.1044e-6}, Case{100e9, 0.25, 7000, 12.972e-6}})
    for (int tenths = 1; tenths <= 10; ++tenths) {
      const double e = 0.1 * tenths, mass = c.density * 4 / 3 * pi * std::pow(0.0025, 3);
      Values grain = material(c.modulus, c.poisson, 0, e), plane = grain;
      plane["young_modulus"] = 1e30;
      const auto law = make_law({{}, {grain, plane}, {}});
      const Ball ball{.radius = 0.0025, .mass = mass};
      EXPECT_NEAR(collide_with_wall(*law, ball, 3.9, 1e-4 * c.duration, 1).restitution, e, 1e-3) << e;
      EXPECT_NEAR(collide(*law, ball, {.radius = 0.004, .mass = 4 * mass}, 0.7, 1e-4 * c.duration).restitution, e, 1e-3)
          << e;
    }
}

/// The linear closed form holds for Hertz: compared with the dimensionless collision x″ = −4/3 x^1.5 − 2 ζ √(5/3) x^¼
/// x′.
TEST(HertzMindlin, DampedImpactEqualsTheLinearOne) {
  for (const double ratio : {0.01, 0.1, 0.5, 0.9, 1.5, 4.0}) {
    const double viscous = 2 * std::sqrt(5.0 / 3) * ratio;
    // p = x′ + 4/5 D x^1.25 removes the infinite slope of the dashpot at first contact.
    const auto power = [](double x) { return x > 0 ? x * std::sqrt(std::sqrt(x)) : 0.0; };
    const auto speed = [&](double x, double p) { return p - 0.8 * viscous * power(x); };
    const auto push = [](double x) { return x > 0 ? -4.0 / 3 * x * std::sqrt(x) : 0.0; };
    const double h = 0.003 / (1 + viscous);
    double x = 0, p = 1, before = 2, now = 1;
    while (x >= 0 && now <= before) {  // the force is zero when the speed stops falling
      const double x1 = speed(x, p), p1 = push(x);
      const double x2 = speed(x + 0.5 * h * x1, p + 0.5 * h * p1), p2 = push(x + 0.5 * h * x1);
      const double x3 = speed(x + 0.5 * h * x2, p + 0.5 * h * p2), p3 = push(x + 0.5 * h * x2);
      const double x4 = speed(x + h * x3, p + h * p3), p4 = push(x + h * x3);
      x += h / 6 * (x1 + 2 * x2 + 2 * x3 + x4), p += h / 6 * (p1 + 2 * p2 + 2 * p3 + p4);
      before = now, now = speed(x, p);
    }
    EXPECT_NEAR(-before, restitution_of_damping(ratio), 1e-6) << ratio;
  }
}

TEST(HertzMindlin, StiffnessesInClosedForm) {
  const auto law = make_law({{}, {material(70e9, 0.3, 25, 1, 0.5), material(200e9, 0.25, 20, 1, 0.1)}, {}});
  const double e = 1 / ((1 - 0.09) / 70e9 + (1 - 0.0625) / 200e9);
  const double ga = 70e9 / 2.6, gb = 200e9 / 2.5, g = 1 / (1.7 / ga + 1.75 / gb);
  const double ra = 0.002, rb = 0.005, r = ra * rb / (ra + rb), overlap = 1e-5;
  const Stiffness k = law->stiffness({ra, rb, 1, 1, overlap}, 0, 1);
  EXPECT_NEAR(k.normal, 2 * e * std::sqrt(r * overlap), 1e-12 * k.normal);
  EXPECT_NEAR(k.shear, 8 * g * std::sqrt(r * overlap), 1e-12 * k.shear);
  EXPECT_NEAR(k.rolling, 0.3 * k.shear * ra * rb, 1e-12 * k.rolling);
  const Stiffness wall = law->stiffness({ra, ra, 1, 0, overlap}, 0, 1);
  EXPECT_NEAR(wall.normal, 2 * e * std::sqrt(ra * overlap), 1e-12 * wall.normal);
  // A fixed sphere of the same size is no wall.
  const Stiffness fixed = law->stiffness(
      {.radius_a = ra, .radius_b = ra, .inverse_mass_a = 1, .inverse_mass_b = 0, .overlap = overlap, .wall = false}, 0,
      1);
  EXPECT_NEAR(fixed.normal, wall.normal / std::sqrt(2), 1e-12 * wall.normal);
  // New contacts use an overlap of 1e-4 R*.
  EXPECT_NEAR(law->stiffness({ra, rb, 1, 1, 0}, 0, 1).normal, 2 * e * r * 0.01, 1e-12 * e * r);
}

TEST(HertzMindlin, ShearFallsWithTheContactRadius) {
  const auto law = law_of(material(5e6, 0.2, 45, 1));
  WallPair wall(*law, {.radius = 1}, 1e-5);
  wall.contact.overlap = 0.04, wall.contact.velocity = {100, 0, 0};
  wall.evaluate();
  const double loaded = -wall.row.force.x;
  EXPECT_NEAR(loaded, 8 * 5e6 / 2.4 / 2 / 1.8 * 0.2 * 1e-3, 1e-9 * loaded);
  wall.contact.velocity.setZero();
  wall.contact.overlap = 0.09;
  wall.evaluate();
  EXPECT_NEAR(-wall.row.force.x, loaded, 1e-12 * loaded) << "loading keeps the shear force";
  wall.contact.overlap = 0.0225;
  wall.evaluate();
  EXPECT_NEAR(-wall.row.force.x, loaded * 0.15 / 0.3, 1e-12 * loaded)
      << "unloading reduces it in proportion to the contact radius";
}

TEST(HertzMindlin, ObliqueImpactSlidesByTheClosedForm) {
  // Chung & Ooi test 4, gross sliding: e_t = 1 − μ(1+e)/tan θ, ω = −2.5 μ(1+e) v_n / r.
  const double e = 0.98, mu = 0.092, radius = 0.0025, mass = 4000 * 4.0 / 3 * pi * std::pow(radius, 3);
  const auto law = law_of(material(380e9, 0.23, std::atan(mu) / degree, e));
  for (const double angle : {40.0, 60.0, 80.0}) {
    const double vn = 3.9 * std::cos(angle * degree), vt = 3.9 * std::sin(angle * degree), dt = 1e-9;
    WallPair wall(*law, {.position = {0, 0, radius}, .radius = radius, .velocity = {vt, 0, -vn}, .mass = mass}, dt);
    do {
      wall.position.z += dt * wall.velocity.z;
      wall.contact.overlap = radius - wall.position.z;
      wall.evaluate();
      wall.velocity.x += dt * wall.velocity.w * wall.sum.force.x;
      wall.velocity.z += dt * wall.velocity.w * wall.sum.force.z;
      wall.spin.y += dt * wall.spin.w * wall.sum.moment.y;
    } while (wall.row.force.w > 0);
    EXPECT_NEAR(wall.velocity.x / vt, 1 - mu * (1 + e) / std::tan(angle * degree), 2e-3) << angle;
    EXPECT_NEAR(wall.spin.y, 2.5 * mu * (1 + e) * vn / radius, 0.01 * 2.5 * mu * (1 + e) * vn / radius) << angle;
  }
}

TEST(HertzMindlin, InterfaceOverridesTheSmallerOfTwo) {
  const auto rolled = [](std::map<std::pair<std::size_t, std::size_t>, Values> interfaces) {
    Values a = material(5e6, 0.2, 25, 1, 0.5), b = a;
    a["rolling_limit"] = 0.1, b["rolling_limit"] = 0.2;
    const auto law = make_law({{}, {a, b}, std::move(interfaces)});
    WallPair wall(*law, {.radius = 0.5, .spin = {0, -1e6, 0}}, 1e-3);
    wall.contact.overlap = 0.01, wall.contact.material = 1;
    wall.evaluate();
    return -wall.law_moment().y() / (0.5 * wall.row.force.w);
  };
  EXPECT_NEAR(rolled({}), 0.1, 1e-12);
  EXPECT_NEAR(rolled({{{0, 1}, {{"rolling_limit", 0.7}}}}), 0.7, 1e-12);
}

TEST(HertzMindlin, RefusesInvalidParameters) {
  EXPECT_THAT(
      [] {
        law_of({{"poisson_ratio", 0.51}});
      },
      testing::ThrowsMessage<std::invalid_argument>("poisson_ratio: out of range"));
  EXPECT_THAT(
      [] {
        law_of({{"restitution", 0.001}});
      },
      testing::ThrowsMessage<std::invalid_argument>("restitution: out of range"));
  EXPECT_THAT(
      [] {
        law_of({{"contact_modulus", 1e8}});
      },
      testing::ThrowsMessage<std::invalid_argument>("contact_modulus: no such parameter"));
}

}  // namespace
}  // namespace grit::test
