// The contract of contact laws, Coulomb friction and restitution.
#include <gmock/gmock.h>

#include "grit/contact/law_parameters.hpp"
#include "grit/contact/restitution.hpp"
#include "grit/testing/collision.hpp"
#include "grit/testing/contact_law.hpp"

namespace grit::test {
namespace {

Values material(double modulus, double friction_degrees, double restitution, double ratio = 0.4) {
  return {{"contact_modulus", modulus},
          {"shear_to_normal_stiffness", ratio},
          {"friction_angle", friction_degrees * degree},
          {"restitution", restitution}};
}
LawValues three(double friction, double restitution, bool shear_damping) {
  return {{{"shear_damping", shear_damping}},
          {material(1e6, friction, restitution), material(2e6, friction, restitution, 0.7),
           material(5e5, 0.5 * friction, restitution, 0.2)},
          {}};
}
std::vector<LawSetup> setups() {
  return {{"Frictional", three(25, 1, false), 3},     {"Smooth", three(0, 1, false), 0},
          {"Damped", three(25, 0.4, false), 3},       {"SmoothDamped", three(0, 0.4, false), 0},
          {"DampedInShear", three(25, 0.4, true), 3}, {"SmoothDampedInShear", three(0, 0.4, true), 0},
          {"ShearDashpotOff", three(25, 1, true), 3}};
}
INSTANTIATE_TEST_SUITE_P(LinearFrictional, ContactLawContract, testing::ValuesIn(setups()), setup_name);

std::unique_ptr<ContactLaw> law_of(const Values& values, bool shear_damping = false) {
  return make_law({{{"shear_damping", shear_damping}}, {values}, {}});
}

TEST(LinearFrictional, StiffnessesAreThoseOfTwoSpringsInSeries) {
  const auto law = make_law({{}, {material(1e6, 25, 1, 0.4), material(3e6, 20, 1, 0.2)}, {}});
  const Stiffness k = law->stiffness({2, 0.5, 1, 1, 0.01}, 0, 1);
  EXPECT_DOUBLE_EQ(k.normal, 2 * 2e6 * 1.5e6 / 3.5e6);
  EXPECT_DOUBLE_EQ(k.shear, 0.3 * k.normal);
  EXPECT_EQ(k.rolling, 0);
  const Stiffness wall = law->stiffness({2, 2, 1, 0, 0.01}, 0, 1);
  EXPECT_DOUBLE_EQ(wall.normal, 2e6);
  EXPECT_DOUBLE_EQ(wall.shear, 0.4 * 2e6);
}

TEST(LinearFrictional, InterfaceOverridesTheSmallerOfTwo) {
  const double normal = 1e6 * 0.01;  // normal force at rest
  const auto slid = [&](std::map<std::pair<std::size_t, std::size_t>, Values> interfaces) {
    const auto law = make_law({{}, {material(1e6, 25, 1), material(1e6, 15, 1)}, std::move(interfaces)});
    WallPair wall(*law, {.radius = 1}, 1e-3);
    wall.contact.overlap = 0.01, wall.contact.material = 1, wall.contact.velocity = {1e3, 0, 0};
    wall.evaluate();
    return -wall.row.force.x;
  };
  EXPECT_NEAR(slid({}), std::tan(15 * degree) * normal, 1e-9 * normal);
  EXPECT_NEAR(slid({{{1, 0}, {{"friction_angle", 40 * degree}}}}), std::tan(40 * degree) * normal, 1e-9 * normal);
}

TEST(LinearFrictional, ElasticCollisionLastsHalfAPeriod) {
  const auto law = law_of(material(1e6, 25, 1));
  const double k = 2 * 1e6 * 0.7 / 1.7, m = 1.0 * 2.0 / 3.0, omega = std::sqrt(k / m);
  const Collision hit = collide(*law, {.radius = 1, .mass = 1}, {.radius = 0.7, .mass = 2}, 3, 1e-4 / omega);
  EXPECT_NEAR(hit.duration, std::numbers::pi / omega, 3e-4 / omega);
  EXPECT_NEAR(hit.overlap, 3 / omega, 1e-6 / omega);
  EXPECT_NEAR(hit.force, 3 * std::sqrt(k * m), 1e-6 * 3 * std::sqrt(k * m));
  EXPECT_NEAR(hit.restitution, 1, 1e-7);
}

TEST(LinearFrictional, RestitutionEqualsItsParameter) {
  for (int tenths = 1; tenths <= 10; ++tenths) {
    const double e = 0.1 * tenths;
    const auto law = law_of(material(1e6, 25, e));
    const double omega = std::sqrt(2 * 1e6 * 0.7 / 1.7 / (2.0 / 3));
    const Collision hit = collide(*law, {.radius = 1, .mass = 1}, {.radius = 0.7, .mass = 2}, 3, 2e-4 / omega);
    EXPECT_NEAR(hit.restitution, e, 1e-3) << e;
    const Collision wall = collide_with_wall(*law, {.radius = 0.5, .mass = 1.3}, 3, 2e-4 / std::sqrt(5e5 / 1.3));
    EXPECT_NEAR(wall.restitution, e, 1e-3) << e;
  }
}

TEST(Restitution, ClosedFormAtKnownPoints) {
  EXPECT_EQ(restitution_of_damping(0), 1);
  EXPECT_NEAR(restitution_of_damping(1), std::exp(-2), 1e-12);
  EXPECT_NEAR(restitution_of_damping(1 - 1e-6), std::exp(-2), 1e-5);
  EXPECT_NEAR(restitution_of_damping(1 + 1e-6), std::exp(-2), 1e-5);
  // ζ = cos 60° and ζ = cosh 1.
  EXPECT_NEAR(restitution_of_damping(0.5), std::exp(-2 * std::numbers::pi / 3 / std::sqrt(3)), 1e-14);
  EXPECT_NEAR(restitution_of_damping(std::cosh(1)), std::exp(-2 / std::tanh(1)), 1e-14);
  for (const double e : {least_restitution, 0.1, 0.5, 0.99, 1.0})
    EXPECT_NEAR(restitution_of_damping(damping_of_restitution(e)), e, 1e-12);
}

TEST(LinearFrictional, ShearDashpotActsOnlyWhileSticking) {
  const auto law = law_of(material(1e6, 30, 0.5), true);
  const double k = 1e6, ks = 0.4 * k, overlap = 0.01, dt = 1e-6, inverse_mass = 1 / 1.3;
  const double dash = 2 * damping_of_restitution(0.5) * std::sqrt(ks / (3.5 * inverse_mass));
  const auto at = [&](double speed) {
    WallPair wall(*law, {.radius = 1, .mass = 1.3}, dt);
    wall.contact.overlap = overlap, wall.contact.velocity = {speed, 0, 0};
    wall.evaluate();
    return wall;
  };
  auto sticking = at(0.5);
  EXPECT_NEAR(sticking.row.force.x, -ks * dt * 0.5 - dash * 0.5, 1e-9 * k * overlap);
  EXPECT_NEAR(sticking.state()[0], -ks * dt * 0.5, 1e-12 * k * overlap);
  const double limit = std::tan(30 * degree) * k * overlap;
  auto sliding = at(1e6);
  EXPECT_NEAR(sliding.row.force.x, -limit, 1e-9 * limit);
  EXPECT_NEAR(sliding.state()[0], -limit, 1e-9 * limit);
}

TEST(LinearFrictional, SlippingSphereStartsToRoll) {
  // Slips until t = 2 u0 / (7 μ g), then rolls at 5/7 u0.
  const auto law = law_of(material(1e8, 15, 1));
  const double gravity = 9.81, mass = 2, radius = 0.1, dt = 2e-5, mu = std::tan(15 * degree);
  const double u0 = 1, weight = mass * gravity, slipping = 2 * u0 / (7 * mu * gravity);
  WallPair wall(*law, {.radius = radius, .velocity = {u0, 0, 0}, .mass = mass}, dt);
  wall.contact.overlap = weight / (1e8 * radius);
  for (double t = 0; t < 2 * slipping; t += dt) {
    wall.evaluate();
    wall.velocity.x += dt * wall.velocity.w * wall.sum.force.x;
    wall.spin.y += dt * wall.spin.w * wall.sum.moment.y;
    if (t < 0.98 * slipping) {
      ASSERT_NEAR(wall.velocity.x, u0 - mu * gravity * (t + dt), 3e-4);  // the spring is loaded first
    }
  }
  EXPECT_NEAR(wall.velocity.x, 5.0 / 7 * u0, 5e-3);
  EXPECT_NEAR(wall.spin.y * radius, 5.0 / 7 * u0, 1.5e-2);
}

TEST(LinearFrictional, RefusesInvalidParameters) {
  EXPECT_THAT(
      [] {
        law_of({{"restitution", 0.0}});
      },
      testing::ThrowsMessage<std::invalid_argument>("restitution: out of range"));
  EXPECT_THAT(
      [] {
        law_of({{"contact_modulus", 0.0}});
      },
      testing::ThrowsMessage<std::invalid_argument>("contact_modulus: out of range"));
  EXPECT_THAT(
      [] {
        law_of({{"friction_angle", 90 * degree}});
      },
      testing::ThrowsMessage<std::invalid_argument>("friction_angle: out of range"));
}

}  // namespace
}  // namespace grit::test
