// The contract of contact laws, the force of liquid bridges, their rupture and its energy.
#include <gmock/gmock.h>

#include "grit/contact/law_parameters.hpp"
#include "grit/testing/collision.hpp"
#include "grit/testing/contact_law.hpp"

namespace grit::test {
namespace {

using std::numbers::pi;

Values material(double modulus, double friction_degrees, double restitution, double contact_angle) {
  return {{"contact_modulus", modulus},
          {"shear_to_normal_stiffness", 0.4},
          {"friction_angle", friction_degrees * degree},
          {"restitution", restitution},
          {"contact_angle", contact_angle * degree}};
}
LawSetup setup(const char* name, double friction, double restitution, double volume, std::size_t state_size) {
  return {.name = name,
          .values = {{{"surface_tension", 1e3}, {"bridge_volume", volume}},
                     {material(1e6, friction, restitution, 30), material(2e6, friction, restitution, 0),
                      material(5e5, 0.5 * friction, restitution, 50)},
                     {}},
          .state_size = state_size,
          .wall_sphere = volume > 0 ? 0.0 : 1.0,
          .attracts = true,
          .usual_limits = false};
}
// A wall is flat to a bridge, and like a sphere of the body's size to the springs.
INSTANTIATE_TEST_SUITE_P(Capillary, ContactLawContract,
                         testing::Values(setup("Rough", 25, 1, 1e-7, 4), setup("Smooth", 0, 1, 1e-7, 1),
                                         setup("RoughDamped", 25, 0.4, 1e-7, 4), setup("SmoothDamped", 0, 0.4, 1e-7, 1),
                                         setup("Dry", 25, 0.4, 0, 4)),
                         setup_name);

constexpr double tension = 1e3, volume = 1e-7, modulus = 1e6;

std::unique_ptr<ContactLaw> law_of(const Values& material, double bridge_volume = volume) {
  return make_law({{{"surface_tension", tension}, {"bridge_volume", bridge_volume}}, {material}, {}});
}

/// Radii 1 and 0.7 m, at rest.
struct Two : Pairs {
  explicit Two(const ContactLaw& law) : Pairs(law, 1e-5) {
    add({.position = Vec3::Zero(), .radius = 1});
    add({.position = {0, 0, 2.7}, .radius = 0.7});
    pair(0, 1);
  }
  /// Places b at rest; returns the normal force.
  double at(double overlap) {
    set(position(1), {0, 0, 1.7 - overlap});
    evaluate();
    return row(0).force.w;
  }
};

TEST(Capillary, ABridgePullsUntilItRuptures) {
  const double angle = 30 * degree, radius = 2 * 0.7 / 1.7, most = 2 * pi * radius * tension * std::cos(angle),
               rupture = (1 + 0.5 * angle) * std::cbrt(volume);
  const auto law = law_of(material(modulus, 25, 1, 30));
  Two pair(*law);
  EXPECT_NEAR(law->reach({1, 0.7, 1, 1, 0, false}, 0, 0), rupture, 1e-12 * rupture);
  EXPECT_EQ(pair.at(-0.5 * rupture), 0) << "no bridge before the surfaces touch";
  EXPECT_NEAR(pair.at(0.01), 2 * modulus * 0.7 / 1.7 * 0.01 - most, 1e-9 * most);
  for (const double share : {0.0, 0.01, 0.1, 0.5, 0.999}) {
    const double x = share * rupture * std::sqrt(radius / volume);
    EXPECT_NEAR(pair.at(-share * rupture), -most / (1 + 1.05 * x + 2.5 * x * x), 1e-9 * most) << share;
  }
  EXPECT_EQ(pair.at(-1.001 * rupture), 0);
  EXPECT_FALSE(pair.touching(0));
  EXPECT_EQ(pair.at(-0.5 * rupture), 0);
}

TEST(Capillary, AWallIsFlat) {
  const auto law = law_of(material(modulus, 25, 1, 0));
  WallPair wall(*law, {.radius = 0.5}, 1e-5);
  wall.contact.overlap = 1e-12;
  wall.evaluate();
  EXPECT_NEAR(wall.row.force.w, -4 * pi * 0.5 * tension, 1e-6 * tension);
}

TEST(Capillary, FrictionDependsOnTheContactOfTheSolids) {
  const auto law = law_of(material(modulus, 25, 1, 0));
  WallPair wall(*law, {.radius = 1}, 1e-3);
  wall.contact.overlap = 0.01, wall.contact.velocity = {1e3, 0, 0};
  wall.evaluate();
  const double limit = std::tan(25 * degree) * modulus * 0.01;
  EXPECT_NEAR(-wall.row.force.x, limit, 1e-9 * limit);
  EXPECT_NEAR(wall.row.force.w, modulus * 0.01 - 4 * pi * tension, 1e-9 * modulus * 0.01);
  wall.contact.overlap = -1e-4;
  wall.evaluate();
  EXPECT_LT(wall.row.force.w, 0);
  EXPECT_EQ(wall.row.force.x, 0) << "no shear through a bridge alone";
}

TEST(Capillary, EnergyOfABridgeIsTheWorkToStretchIt) {
  const auto law = law_of(material(modulus, 0, 1, 20));
  Two pair(*law);
  pair.at(1e-9);
  const PairSize size{1, 0.7, 1, 1, 0, false};
  const double rupture = law->reach(size, 0, 0);
  const int parts = 2000;
  double work = 0;
  for (int k = 0; k < parts; ++k) work -= pair.at(-rupture * (k + 0.5) / parts) * rupture / parts;
  PairSize apart = size;
  apart.overlap = -rupture;
  EXPECT_NEAR(law->energy(apart, 0, 0, std::vector<double>{1}).normal, work, 1e-5 * work);
  EXPECT_EQ(law->energy(apart, 0, 0, std::vector<double>{0}).normal, 0);
}

TEST(Capillary, ACollisionLosesTheWorkOfTheBridge) {
  const auto law = law_of(material(modulus, 0, 1, 0));
  PairSize apart{1, 0.7, 1, 1, 0, false};
  apart.overlap = -law->reach(apart, 0, 0);
  const double lost = law->energy(apart, 0, 0, std::vector<double>{1}).normal, mass = 2.0 / 3;
  const double speed = std::sqrt(2 * 1.5 * lost / mass);
  Pairs pairs(*law, 1e-6);
  pairs.add({.radius = 1, .mass = 1});
  pairs.add({.position = {0, 0, 1.7}, .radius = 0.7, .velocity = {0, 0, -speed}, .mass = 2});
  pairs.pair(0, 1);
  do pairs.step(), pairs.kick();
  while (pairs.touching(0));
  const double after = pairs.velocity(1).z - pairs.velocity(0).z;
  EXPECT_NEAR(after * after, speed * speed / 3, 5e-3 * speed * speed);
}

TEST(Capillary, InterfaceOverrides) {
  const auto reach = [](Values overrides) {
    const auto law = make_law({{{"bridge_volume", 1e-9}},
                               {material(modulus, 0, 1, 20), material(modulus, 0, 1, 40)},
                               {{{0, 1}, std::move(overrides)}}});
    return law->reach({1, 1, 1, 1, 0, false}, 0, 1);
  };
  EXPECT_NEAR(reach({}), (1 + 15 * degree) * 1e-3, 1e-12);
  EXPECT_NEAR(reach({{"contact_angle", 0.0}}), 1e-3, 1e-12);
  EXPECT_NEAR(reach({{"bridge_volume", 8e-9}, {"contact_angle", 0.0}}), 2e-3, 1e-12);
}

TEST(Capillary, DryItHasNoReachAndRestitutionIsExact) {
  const auto law = law_of(material(modulus, 25, 0.5, 0), 0);
  EXPECT_EQ(law->reach({1, 1, 1, 1, 0, false}, 0, 0), 0);
  const double omega = std::sqrt(2 * modulus * 0.7 / 1.7 / (2.0 / 3));
  EXPECT_NEAR(collide(*law, {.radius = 1, .mass = 1}, {.radius = 0.7, .mass = 2}, 3, 2e-4 / omega).restitution, 0.5,
              1e-3);
}

TEST(Capillary, RefusesInvalidParameters) {
  EXPECT_THAT(
      [] {
        law_of({{"contact_angle", 100 * degree}});
      },
      testing::ThrowsMessage<std::invalid_argument>("contact_angle: out of range"));
  EXPECT_THAT([] { law_of({}, -1); }, testing::ThrowsMessage<std::invalid_argument>("bridge_volume: out of range"));
}

}  // namespace
}  // namespace grit::test
