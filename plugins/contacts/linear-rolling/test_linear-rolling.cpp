// The contract of contact laws, stiffnesses, limits, walls, rolling and twisting.
#include <gmock/gmock.h>

#include "grit/contact/law_parameters.hpp"
#include "grit/testing/collision.hpp"
#include "grit/testing/contact_law.hpp"

namespace grit::test {
namespace {

using std::numbers::pi;

Values material(double modulus, double friction_degrees, double rolling, double twisting, double ratio = 0.4) {
  return {{"contact_modulus", modulus},
          {"shear_to_normal_stiffness", ratio},
          {"friction_angle", friction_degrees * degree},
          {"rolling_stiffness", rolling},
          {"rolling_limit", 0.6 * rolling},
          {"twisting_stiffness", twisting},
          {"twisting_limit", 0.3 * twisting}};
}
LawValues three(double rolling, double twisting, double restitution = 1) {
  LawValues all{{},
                {material(1e6, 25, rolling, twisting), material(2e6, 30, 0.5 * rolling, twisting, 0.7),
                 material(5e5, 10, rolling, 0.5 * twisting, 0.2)},
                {}};
  for (Values& one : all.materials) one["restitution"] = restitution;
  return all;
}
std::vector<LawSetup> setups() {
  return {{"Sliding", three(0, 0), 3},
          {"Rolling", three(0.7, 0), 6},
          {"Twisting", three(0, 0.5), 7},
          {"RollingTwisting", three(0.7, 0.5), 7},
          {"SlidingDamped", three(0, 0, 0.4), 3},
          {"RollingDamped", three(0.7, 0, 0.4), 6},
          {"TwistingDamped", three(0, 0.5, 0.4), 7},
          {"RollingTwistingDamped", three(0.7, 0.5, 0.4), 7}};
}
INSTANTIATE_TEST_SUITE_P(LinearRolling, ContactLawContract, testing::ValuesIn(setups()), setup_name);

TEST(LinearRolling, PrerequisitesAreEvaluatedToo) {
  using testing::ElementsAre;
  const auto parts = [](double friction, double rolling, double twisting) {
    return make_law({{}, {material(1e6, friction, rolling, twisting)}, {}})->loop().parts;
  };
  EXPECT_THAT(parts(0, 0, 0), ElementsAre());
  EXPECT_THAT(parts(20, 0, 0), ElementsAre("shear"));
  EXPECT_THAT(parts(0, 0.5, 0), ElementsAre("rolling"));
  EXPECT_THAT(parts(0, 0, 0.5), ElementsAre("shear", "rolling", "twisting"));
}

TEST(LinearRolling, StiffnessesInClosedForm) {
  const auto law = make_law({{}, {material(1e8, 18, 0.7, 0.2, 0.3), material(3e8, 30, 0.3, 0.6, 0.5)}, {}});
  const double ra = 0.002, rb = 0.0005, soft = 1e8 * ra, hard = 3e8 * rb;
  const Stiffness k = law->stiffness({ra, rb, 1, 1, 0}, 0, 1);
  EXPECT_DOUBLE_EQ(k.normal, 2 * soft * hard / (soft + hard));
  EXPECT_DOUBLE_EQ(k.shear, 0.4 * k.normal);
  EXPECT_DOUBLE_EQ(k.rolling, 0.5 * k.shear * ra * rb);
  EXPECT_DOUBLE_EQ(k.twisting, 0.4 * k.shear * ra * rb);
  EXPECT_EQ(k.damping_ratio, 0);
  // One material: E 2 R_a R_b / (R_a + R_b).
  EXPECT_DOUBLE_EQ(law->stiffness({ra, rb, 1, 1, 0}, 0, 0).normal, 1e8 * 2 * ra * rb / (ra + rb));
}

TEST(LinearRolling, WallUsesRadiusAndStiffnessOfTheBody) {
  const auto law = make_law({{}, {material(1e8, 18, 0.7, 0.2, 0.3), material(3e8, 30, 0.3, 0.6, 0.5)}, {}});
  const double r = 0.002;
  const Stiffness k = law->stiffness({r, r, 1, 0, 0}, 0, 1);
  EXPECT_DOUBLE_EQ(k.normal, 1e8 * r);
  EXPECT_DOUBLE_EQ(k.shear, 0.3 * 1e8 * r);
  EXPECT_DOUBLE_EQ(k.rolling, 0.7 * k.shear * r * r);
  EXPECT_DOUBLE_EQ(k.twisting, 0.2 * k.shear * r * r);
}

/// Moment on a wall over normal force and radius, for a grain that rolls or twists indefinitely.
Vec3 most(const ContactLaw& law, const Vec3& spin) {
  WallPair wall(law, {.radius = 0.5, .spin = spin}, 1e-3);
  wall.contact.overlap = 0.01, wall.contact.material = 1;
  wall.evaluate();
  return wall.law_moment() / (0.5 * wall.row.force.w);
}

TEST(LinearRolling, SmallerLimitCountsUnlessTheInterfaceOverridesIt) {
  Values a = material(1e6, 25, 0.7, 0.5), b = a;
  a["rolling_limit"] = 0.1, b["rolling_limit"] = 0.2, a["twisting_limit"] = 0.05, b["twisting_limit"] = 0.03;
  const auto plain = make_law({{}, {a, b}, {}});
  EXPECT_NEAR(most(*plain, {0, -1e6, 0}).y(), -0.1, 1e-12);
  EXPECT_NEAR(most(*plain, {0, 0, -1e6}).z(), -0.03, 1e-12);
  const auto own = make_law({{}, {a, b}, {{{1, 0}, {{"rolling_limit", 0.7}, {"twisting_limit", 0.4}}}}});
  EXPECT_NEAR(most(*own, {0, -1e6, 0}).y(), -0.7, 1e-12);
  EXPECT_NEAR(most(*own, {0, 0, -1e6}).z(), -0.4, 1e-12);
}

TEST(LinearRolling, LimitRadiusIsTheMeanOrTheSmaller) {
  for (const std::string which : {"mean", "smaller"}) {
    const auto law = make_law({{{"limit_radius", which}}, {material(1e6, 25, 0.5, 0)}, {}});
    Pairs pairs(*law, 1e-3);
    pairs.add({.radius = 1, .spin = {0, -700, 0}});
    pairs.add({.position = {0, 0, 1.39}, .radius = 0.4, .spin = {0, 1750, 0}});
    pairs.pair(0, 1);
    pairs.evaluate();
    EXPECT_NEAR(pairs.row(0).moment.y, -0.3 * (which == "mean" ? 0.7 : 0.4) * pairs.row(0).force.w,
                1e-9 * pairs.row(0).force.w);
  }
}

TEST(LinearRolling, ElasticCollisionLastsHalfAPeriod) {
  const auto law = make_law({{}, {material(1e6, 25, 0.5, 0)}, {}});
  const double k = 2 * 1e6 * 0.7 / 1.7, m = 2.0 / 3.0, omega = std::sqrt(k / m);
  const Collision hit = collide(*law, {.radius = 1, .mass = 1}, {.radius = 0.7, .mass = 2}, 3, 1e-4 / omega);
  EXPECT_NEAR(hit.duration, pi / omega, 3e-4 / omega);
  EXPECT_NEAR(hit.overlap, 3 / omega, 1e-6 / omega);
  EXPECT_NEAR(hit.restitution, 1, 1e-7);
}

TEST(LinearRolling, RestitutionEqualsItsParameter) {
  for (const double e : {0.2, 0.5, 0.9}) {
    Values damped = material(1e6, 25, 0.5, 0);
    damped["restitution"] = e;
    const auto law = make_law({{}, {damped}, {}});
    const double omega = std::sqrt(2 * 1e6 * 0.7 / 1.7 / (2.0 / 3));
    EXPECT_NEAR(collide(*law, {.radius = 1, .mass = 1}, {.radius = 0.7, .mass = 2}, 3, 2e-4 / omega).restitution, e,
                1e-3);
    EXPECT_NEAR(collide_with_wall(*law, {.radius = 0.5, .mass = 1.3}, 3, 2e-4 / std::sqrt(5e5 / 1.3)).restitution, e,
                1e-3);
  }
  Values lossy = material(1e6, 25, 0.5, 0), elastic = lossy;
  lossy["restitution"] = 0.3;
  const auto law = make_law({{}, {lossy, elastic}, {{{0, 1}, {{"restitution", 0.7}}}}});
  EXPECT_NEAR(collide_with_wall(*law, {.radius = 0.5, .mass = 1.3}, 3, 2e-4 / std::sqrt(5e5 / 1.3), 1).restitution, 0.7,
              1e-3);
}

TEST(LinearRolling, SphereOnASlopeStaysUpToTheRollingLimit) {
  // A sphere sticks to a slope while tan α < η (and μ); beyond, it rolls with a = 5/7 g (sin α − η cos α).
  const double eta = 0.3, radius = 0.1, mass = 2, gravity = 9.81, dt = 5e-6;
  const auto law = make_law({{}, {material(1e8, 40, 0.5, 0)}, {}});  // η = 0.6 · 0.5
  for (const double slope : {0.9 * std::atan(eta), 1.3 * std::atan(eta)}) {
    const double weight = mass * gravity, pull = weight * std::sin(slope);
    WallPair wall(*law, {.radius = radius, .mass = mass}, dt);
    wall.contact.overlap = weight * std::cos(slope) / (1e8 * radius);
    const int steps = 40000;
    for (int step = 0; step < steps; ++step) {
      wall.evaluate();
      wall.velocity.x += dt * wall.velocity.w * (wall.sum.force.x + pull);
      wall.spin.y += dt * wall.spin.w * wall.sum.moment.y;
    }
    const double rolling = 5.0 / 7 * gravity * (std::sin(slope) - eta * std::cos(slope)) * steps * dt;
    EXPECT_NEAR(wall.velocity.x, std::max(0.0, rolling), 0.02) << slope;
  }
}

TEST(LinearRolling, TwistingSpheresStopOnlyByTwistingResistance) {
  // Equal and opposite spins about the normal: M = −β_t k_s R_a R_b ψ, an oscillator with ω² = 2 k_t / I.
  const auto law = make_law({{}, {material(1e6, 25, 0, 0.5)}, {}});
  const double k = 0.5 * 0.4 * 1e6, inertia = 0.4, omega = std::sqrt(2 * k / inertia), spin = 1e-3;
  Pairs pairs(*law, 1e-4 / omega);
  pairs.add({.radius = 1, .spin = {0, 0, -spin}});
  pairs.add({.position = {0, 0, 1.9}, .radius = 1, .spin = {0, 0, spin}});
  pairs.pair(0, 1);
  set(pairs.velocity(0), Vec3::Zero());
  double turned = 0, largest = 0;
  const int quarter = static_cast<int>(0.5 * pi * 1e4);
  for (int step = 0; step < quarter; ++step) {
    pairs.evaluate(), pairs.kick();
    set(pairs.velocity(0), Vec3::Zero()), set(pairs.velocity(1), Vec3::Zero());
    turned += pairs.dt * 2 * pairs.spin(1).z;
    largest = std::max(largest, -pairs.row(0).moment.z);
  }
  EXPECT_NEAR(pairs.spin(1).z, 0, 1e-3 * spin);
  EXPECT_NEAR(turned, 2 * spin / omega, 1e-3 * 2 * spin / omega);
  EXPECT_NEAR(largest, k * turned, 1e-3 * largest);
}

TEST(LinearRolling, RefusesInvalidParameters) {
  const auto with = [](const Values& values) { return [=] { make_law({{}, {values}, {}}); }; };
  EXPECT_THAT(with({{"rolling_limit", -0.1}}),
              testing::ThrowsMessage<std::invalid_argument>("rolling_limit: out of range"));
  EXPECT_THAT(with({{"restitution", 0.001}}),
              testing::ThrowsMessage<std::invalid_argument>("restitution: out of range"));
  EXPECT_THAT(with({{"young_modulus", 1e9}}),
              testing::ThrowsMessage<std::invalid_argument>("young_modulus: no such parameter"));
}

}  // namespace
}  // namespace grit::test
