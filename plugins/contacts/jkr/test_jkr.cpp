// The contract of contact laws, the closed forms of Johnson, Kendall & Roberts, the limit of Hertz, and collisions.
#include <gmock/gmock.h>

#include "grit/contact/law_parameters.hpp"
#include "grit/testing/collision.hpp"
#include "grit/testing/contact_law.hpp"

namespace grit::test {
namespace {

using std::numbers::pi;

Values material(double modulus, double poisson, double energy, double friction_degrees, double restitution) {
  return {{"young_modulus", modulus},
          {"poisson_ratio", poisson},
          {"surface_energy", energy},
          {"friction_angle", friction_degrees * degree},
          {"restitution", restitution}};
}
std::vector<LawSetup> setups() {
  std::vector<LawSetup> all;
  for (const bool adhesion : {false, true})
    for (const bool friction : {false, true})
      for (const bool damping : {false, true}) {
        const double phi = friction ? 25 : 0, e = damping ? 0.4 : 1, energy = adhesion ? 80 : 0;
        all.push_back({.name = std::string(adhesion ? "Adhesive" : "Plain") + (friction ? "Frictional" : "Smooth") +
                               (damping ? "Damped" : ""),
                       .values = {{},
                                  {material(5e6, 0.2, energy, phi, e), material(1e7, 0.3, 2 * energy, phi, e),
                                   material(3e6, 0.45, 0.5 * energy, 0.5 * phi, e)},
                                  {}},
                       .state_size = friction ? 5u : 1u,
                       .wall_sphere = 1e6,
                       .attracts = true,
                       .usual_limits = false});
      }
  return all;
}
INSTANTIATE_TEST_SUITE_P(Jkr, ContactLawContract, testing::ValuesIn(setups()), setup_name);

std::unique_ptr<ContactLaw> law_of(const Values& values) { return make_law({{}, {values}, {}}); }

constexpr double modulus = 5e6, poisson = 0.2, surface_energy = 80, work = 2 * surface_energy,
                 plane_modulus = modulus / 2 / (1 - poisson * poisson), reduced = 0.7 / 1.7,
                 pull_off = 1.5 * pi * work * reduced;

std::unique_ptr<ContactLaw> smooth() { return law_of(material(modulus, poisson, surface_energy, 0, 1)); }

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

/// Overlap and force at a contact radius, equations of the paper: 4 E* a³ / (3 R) − √(8 π w E* a³).
double overlap_of(double a) { return a * a / reduced - std::sqrt(2 * pi * work * a / plane_modulus); }
double force_of(double a) {
  return 4 * plane_modulus * a * a * a / (3 * reduced) - std::sqrt(8 * pi * work * plane_modulus * a * a * a);
}
/// Contact radius at which the overlap is least.
const double least_radius = std::cbrt(pi * work * reduced * reduced / (8 * plane_modulus));

TEST(Jkr, ForceIsThatOfTheContactRadius) {
  const auto law = smooth();
  Two pair(*law);
  pair.at(1e-6);
  for (double a = 1.001 * least_radius; a < 0.3; a *= 1.02)
    EXPECT_NEAR(pair.at(overlap_of(a)), force_of(a), 1e-7 * std::max(std::abs(force_of(a)), pull_off)) << a;
}

TEST(Jkr, PullOffForceIsThreeHalvesPiTimesWorkOfAdhesionAndRadius) {
  const auto law = smooth();
  Two pair(*law);
  pair.at(1e-6);
  const double reach = law->reach({1, 0.7, 1, 1, 0, false}, 0, 0);
  EXPECT_NEAR(reach, -overlap_of(least_radius), 1e-12);
  double least = 0;
  for (int k = 0; k < 20000; ++k) least = std::min(least, pair.at(-reach * k / 20000.0));
  EXPECT_NEAR(least, -pull_off, 1e-6 * pull_off);
  EXPECT_NEAR(pair.at(-(1 - 1e-9) * reach), -5.0 / 9 * pull_off, 1e-3 * pull_off) << "at the end";
  EXPECT_EQ(pair.at(-(1 + 1e-9) * reach), 0);
  EXPECT_EQ(pair.at(-0.5 * reach), 0) << "a contact forms only where surfaces touch";
  EXPECT_NEAR(pair.at(1e-12), -8.0 / 9 * pull_off, 1e-6 * pull_off) << "at once with 8/9 of the pull-off force";
}

TEST(Jkr, WallIsFlat) {
  const auto law = smooth();
  WallPair wall(*law, {.radius = 0.5}, 1e-5);
  wall.contact.overlap = 1e-15;
  wall.evaluate();
  EXPECT_NEAR(wall.row.force.w, -8.0 / 9 * 1.5 * pi * work * 0.5, 1e-6 * work);
}

TEST(Jkr, WithoutAdhesionItIsHertz) {
  const auto law = law_of(material(modulus, poisson, 0, 0, 1));
  Two pair(*law);
  for (const double overlap : {1e-6, 1e-3, 0.1})
    EXPECT_NEAR(pair.at(overlap), 4.0 / 3 * plane_modulus * std::sqrt(reduced * overlap) * overlap,
                1e-9 * plane_modulus * std::sqrt(reduced * overlap) * overlap);
}

TEST(Jkr, SlidesAtForcePlusTwicePullOff) {
  const auto law = law_of(material(modulus, poisson, surface_energy, 20, 1));
  WallPair wall(*law, {.radius = 1}, 1e-3);
  wall.contact.overlap = 0.01, wall.contact.velocity = {1e3, 0, 0};
  wall.evaluate();
  const double limit = std::tan(20 * degree) * (wall.row.force.w + 3 * pi * work);
  EXPECT_NEAR(-wall.row.force.x, limit, 1e-9 * limit);
}

TEST(Jkr, ACollisionLosesTheWorkOfTheBond) {
  // Head-on at several speeds, against the integral of the force over the overlap from 0 to the end.
  const auto law = smooth();
  double lost = 0;
  const int parts = 100000;
  const double touching = std::cbrt(2 * pi * work * reduced * reduced / plane_modulus);
  for (int k = 0; k < parts; ++k) {
    const double a = least_radius + (touching - least_radius) * (k + 0.5) / parts,
                 da = (touching - least_radius) / parts;
    const double slope = 2 * a / reduced - 0.5 * std::sqrt(2 * pi * work / (plane_modulus * a));
    lost -= force_of(a) * slope * da;
  }
  EXPECT_NEAR(law->energy({1, 0.7, 1, 1, -(1 - 1e-12) * law->reach({1, 0.7, 1, 1, 0, false}, 0, 0), false}, 0, 0,
                          std::vector<double>{1})
                  .normal,
              lost, 1e-4 * lost);
  const double mass = 2.0 / 3;
  for (const double factor : {1.2, 3.0}) {
    const double speed = std::sqrt(2 * lost * factor / mass);
    Pairs pairs(*law, 2e-7);
    pairs.add({.radius = 1, .mass = 1});
    pairs.add({.position = {0, 0, 1.7}, .radius = 0.7, .velocity = {0, 0, -speed}, .mass = 2});
    pairs.pair(0, 1);
    do pairs.step(), pairs.kick();
    while (pairs.touching(0));
    const double after = pairs.velocity(1).z - pairs.velocity(0).z;
    EXPECT_NEAR(after * after, speed * speed * (1 - 1 / factor), 5e-3 * speed * speed) << factor;
  }
}

TEST(Jkr, InterfaceSetsTheWorkOfAdhesion) {
  const auto reach = [](std::map<std::pair<std::size_t, std::size_t>, Values> interfaces) {
    const auto law = make_law(
        {{}, {material(modulus, poisson, 40, 0, 1), material(modulus, poisson, 90, 0, 1)}, std::move(interfaces)});
    return law->reach({1, 0.7, 1, 1, 0, false}, 0, 1);
  };
  const double of_unit = reach({{{0, 1}, {{"work_of_adhesion", 1.0}}}});
  EXPECT_NEAR(reach({}), of_unit * std::pow(2 * std::sqrt(40.0 * 90), 2.0 / 3), 1e-9);
  EXPECT_NEAR(reach({{{1, 0}, {{"work_of_adhesion", 8.0}}}}), 4 * of_unit, 1e-9);
}

TEST(Jkr, RestitutionIsThatOfHertzForFastCollisions) {
  const auto law = law_of(material(modulus, poisson, 1e-3, 0, 0.6));
  EXPECT_NEAR(collide(*law, {.radius = 1, .mass = 1}, {.radius = 0.7, .mass = 2}, 3, 1e-6).restitution, 0.6, 2e-3);
}

TEST(Jkr, RefusesInvalidParameters) {
  const auto with = [](const Values& values) { return [=] { law_of(values); }; };
  EXPECT_THAT(with({{"surface_energy", -1.0}}),
              testing::ThrowsMessage<std::invalid_argument>("surface_energy: out of range"));
  EXPECT_THAT(with({{"work_of_adhesion", 1.0}}),
              testing::ThrowsMessage<std::invalid_argument>("work_of_adhesion: no such parameter"));
}

}  // namespace
}  // namespace grit::test
