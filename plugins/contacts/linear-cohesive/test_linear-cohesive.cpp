// The contract of contact laws, pull-off, healing, friction with cohesion, and the energy of a bond that breaks.
#include <gmock/gmock.h>

#include "grit/contact/law_parameters.hpp"
#include "grit/testing/contact_law.hpp"

namespace grit::test {
namespace {

using std::numbers::pi;

Values material(double modulus, double friction_degrees, double strength, double rolling, double ratio = 0.4) {
  return {{"contact_modulus", modulus},
          {"shear_to_normal_stiffness", ratio},
          {"friction_angle", friction_degrees * degree},
          {"tensile_strength", strength},
          {"rolling_stiffness", rolling},
          {"rolling_limit", 0.6 * rolling}};
}
LawSetup setup(const char* name, double friction, double strength, double rolling, std::size_t state_size) {
  return {.name = name,
          .values = {{},
                     {material(1e6, friction, strength, rolling), material(2e6, friction, 2 * strength, rolling, 0.7),
                      material(5e5, 0.5 * friction, 0.5 * strength, rolling, 0.2)},
                     {}},
          .state_size = state_size,
          .attracts = true,
          .usual_limits = false};
}
INSTANTIATE_TEST_SUITE_P(LinearCohesive, ContactLawContract,
                         testing::Values(setup("Rough", 25, 1e3, 0, 4), setup("Smooth", 0, 1e3, 0, 1),
                                         setup("Rolling", 25, 1e3, 0.7, 7), setup("SmoothRolling", 0, 1e3, 0.7, 4),
                                         setup("WithoutStrength", 25, 0, 0.7, 7)),
                         setup_name);

std::unique_ptr<ContactLaw> law_of(const Values& values) { return make_law({{}, {values}, {}}); }

/// Radii 1 and 0.7 m, at rest.
struct Two : Pairs {
  explicit Two(const ContactLaw& law) : Pairs(law, 1e-5) {
    add({.position = Vec3::Zero(), .radius = 1});
    add({.position = {0, 0, 1.8}, .radius = 0.7});
    pair(0, 1);
  }
  /// Places b at rest; returns the normal force.
  double at(double overlap) {
    set(position(1), {0, 0, 1.7 - overlap});
    evaluate();
    return row(0).force.w;
  }
};
constexpr double stiffness = 2 * 1e6 * 0.7 / 1.7, strength = 2e3, pull_off = pi * 0.7 * 0.7 * strength;

TEST(LinearCohesive, HoldsUpToThePullOffForce) {
  const auto law = law_of(material(1e6, 25, strength, 0));
  Two pair(*law);
  const double reach = pull_off / stiffness;
  EXPECT_NEAR(law->reach({1, 0.7, 1, 1, 0, false}, 0, 0), reach, 1e-12 * reach);
  EXPECT_EQ(pair.at(-0.5 * reach), 0) << "no bond before the surfaces touch";
  EXPECT_TRUE(pair.touching(0));
  EXPECT_FALSE(pair.acts(0));
  EXPECT_NEAR(pair.at(0.01), stiffness * 0.01, 1e-9 * stiffness * 0.01);
  EXPECT_NEAR(pair.at(-0.5 * reach), -0.5 * pull_off, 1e-9 * pull_off);
  EXPECT_TRUE(pair.acts(0));
  EXPECT_NEAR(pair.overlap(0), -0.5 * reach, 1e-9 * reach);
  EXPECT_NEAR(pair.at(-(1 - 1e-7) * reach), -pull_off, 1e-6 * pull_off);
  EXPECT_EQ(pair.at(-(1 + 1e-7) * reach), 0) << "broken";
  EXPECT_EQ(pair.at(-0.5 * reach), 0) << "a broken bond heals only in contact";
  pair.at(1e-9);
  EXPECT_NEAR(pair.at(-0.5 * reach), -0.5 * pull_off, 1e-9 * pull_off);
}

TEST(LinearCohesive, BreaksAtTheSameForceAtAWall) {
  const auto law = law_of(material(1e6, 25, strength, 0));
  const double own = pi * 0.5 * 0.5 * strength, reach = law->reach({0.5, 0.5, 1, 0, 0}, 0, 0);
  EXPECT_NEAR(reach, own / (1e6 * 0.5), 1e-12 * reach);
  WallPair wall(*law, {.radius = 0.5}, 1e-5);
  wall.contact.overlap = -0.9 * reach;
  wall.evaluate();
  EXPECT_EQ(wall.row.force.w, 0);
  wall.contact.overlap = 1e-3;
  wall.evaluate();
  wall.contact.overlap = -0.9 * reach;
  wall.evaluate();
  EXPECT_NEAR(wall.row.force.w, -0.9 * own, 1e-9 * own);
}

/// Shear force of a sphere that slides on a wall for long.
double slid(const ContactLaw& law, double overlap) {
  WallPair wall(law, {.radius = 1}, 1e-3);
  wall.contact.overlap = 1e-9;
  wall.evaluate();
  wall.contact.overlap = overlap, wall.contact.velocity = {1e3, 0, 0}, wall.contact.material = 0;
  wall.evaluate();
  return -wall.row.force.x;
}

TEST(LinearCohesive, FrictionHasTheCohesionOfThePullOffForce) {
  const auto law = law_of(material(1e6, 25, strength, 0));
  const double own = pi * strength, slope = std::tan(25 * degree);
  for (const double overlap : {0.01, 0.0, -0.5 * own / 1e6})
    EXPECT_NEAR(slid(*law, overlap), slope * (1e6 * overlap + own), 1e-9 * slope * own) << overlap;
}

TEST(LinearCohesive, RollingLimitCountsThePullOffForce) {
  const auto law = law_of(material(1e6, 25, strength, 0.5));
  WallPair wall(*law, {.radius = 1, .spin = {0, -1e6, 0}}, 1e-3);
  wall.contact.overlap = 0.01;
  wall.evaluate();
  const double carried = 1e6 * 0.01 + pi * strength;
  EXPECT_NEAR(-wall.law_moment().y(), 0.3 * carried, 1e-9 * carried);
}

TEST(LinearCohesive, SmallerStrengthCountsUnlessTheInterfaceOverridesIt) {
  const auto reach = [&](std::map<std::pair<std::size_t, std::size_t>, Values> interfaces) {
    const auto law = make_law({{}, {material(1e6, 25, 2e3, 0), material(1e6, 25, 1e3, 0)}, std::move(interfaces)});
    return law->reach({1, 1, 1, 0, 0}, 0, 1) * 1e6 / pi;
  };
  EXPECT_NEAR(reach({}), 1e3, 1e-9);
  EXPECT_NEAR(reach({{{1, 0}, {{"tensile_strength", 5e3}}}}), 5e3, 1e-9);
}

TEST(LinearCohesive, EnergyOfTensionIsThatOfTheSpring) {
  const auto law = law_of(material(1e6, 25, strength, 0));
  const std::vector<double> loose(4, 0.0), bonded{1, 0, 0, 0};
  const PairSize apart{1, 0.7, 1, 1, -1e-3, false};
  EXPECT_EQ(law->energy(apart, 0, 0, loose).total(), 0);
  EXPECT_NEAR(law->energy(apart, 0, 0, bonded).normal, 0.5 * stiffness * 1e-6, 1e-12 * stiffness * 1e-6);
}

TEST(LinearCohesive, RefusesInvalidParameters) {
  const auto with = [](const Values& values) { return [=] { law_of(values); }; };
  EXPECT_THAT(with({{"tensile_strength", -1.0}}),
              testing::ThrowsMessage<std::invalid_argument>("tensile_strength: out of range"));
  EXPECT_THAT(with({{"cohesion", 1.0}}), testing::ThrowsMessage<std::invalid_argument>("cohesion: no such parameter"));
}

}  // namespace
}  // namespace grit::test
