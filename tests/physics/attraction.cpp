// Bodies held together by attraction: energies of bonds that break, hanging balls, neighbour lists and counts of
// contacts with a law that acts at a distance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "energy_balance.hpp"
#include "grit/error.hpp"
#include "support/verified.hpp"

namespace grit::test::attraction_tests {
namespace {

using energy_balance_tests::grains;
using energy_balance_tests::Kept;
using energy_balance_tests::kinetic_at;
using energy_balance_tests::mass;
using energy_balance_tests::radius;

constexpr double modulus = 1e7, stiffness = modulus * radius;

Description cohesive(double strength, double friction = 0) {
  return {{"contact_modulus", modulus}, {"tensile_strength", strength}, {"friction_angle", friction}};
}
double pull_off(double strength) { return strength * std::numbers::pi * radius * radius; }
/// Energy that a bond stores when it breaks [J].
double bond_energy(double strength) { return 0.5 * pull_off(strength) * pull_off(strength) / stiffness; }

/// Two balls that collide at 2 `speed`.
Description impact(double strength, double speed) {
  return grains("linear-cohesive", cohesive(strength),
                {{Vec3::Zero(), radius, {speed, 0, 0}}, {{2.01 * radius, 0, 0}, radius, {-speed, 0, 0}}});
}

TEST(Attraction, ABondThatBreaksTakesItsEnergy) {
  const double strength = 5e3, speed = 0.1;
  Description d = impact(strength, speed);
  d["time_step"]["value"] = 2e-8;
  Kept hit(d);
  ASSERT_LT(bond_energy(strength), 0.5 * kinetic_at(speed));
  do hit.step();
  while (hit.velocity(0).x() > 0 || !hit.world().contacts().empty());
  const Energies now = hit.world().energies();
  const double start = 2 * kinetic_at(speed);
  verify("energy that a linear bond takes when it breaks, over ½ F²/k", now.viscosity / bond_energy(strength), 1, 0.02);
  verify("closure error over the energy of a collision with a bond", now.closure_error / start, 0, 1e-3, 1.0);
  EXPECT_NEAR(now.kinetic, start - bond_energy(strength), 1e-2 * bond_energy(strength));
  EXPECT_EQ(now.elastic(), 0);
}

TEST(Attraction, SlowBallsStickAndKeepTheirEnergy) {
  const double strength = 4e5, speed = 0.01;
  ASSERT_GT(bond_energy(strength), 2 * kinetic_at(speed));
  Kept hit(impact(strength, speed));
  double largest = 0;
  for (int k = 0; k < 400; ++k) {
    hit.step(100);
    const Energies now = hit.world().energies();
    EXPECT_NEAR(now.kinetic + now.elastic(), 2 * kinetic_at(speed), 2e-3 * kinetic_at(speed));
    EXPECT_EQ(now.dissipated(), 0);
    for (const Contact& contact : hit.world().contacts()) largest = std::max(largest, -contact.overlap);
  }
  EXPECT_GT(largest, 0.9 * speed / std::sqrt(2 * stiffness / mass)) << "the spring is in tension half of the time";
  EXPECT_EQ(hit.world().contacts().size(), 1u);
}

/// Two balls hang from a ceiling, the second from the first, and swing up and down.
Description hanging(const Description& material, const std::string& law) {
  Description d =
      grains(law, material, {{{0, 0, -(1 - 1e-6) * radius}, radius}, {{0, 0, -(3 - 2e-6) * radius}, radius}});
  d["walls"]["ceiling"] = plane(Vec3::Zero(), -Vec3::UnitZ());
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["time_step"]["safety"] = 0.05;
  return d;
}
void expect_hangs(const Description& d) {
  for (const bool balance : {false, true}) {
    Trial trial(d, 1, balance ? BodyState::energy : StateRequest{});
    if (balance) trial.world().energies();
    ASSERT_NO_THROW(trial.step(20000)) << balance;
    EXPECT_EQ(trial.world().contacts().size(), 2u);
    if (balance) {
      const Energies now = trial.world().energies();
      EXPECT_LE(std::abs(now.closure_error),
                0.01 * (now.kinetic + std::abs(now.elastic()) + std::abs(now.gravitational)));
    }
  }
}

TEST(Attraction, HangingBallsDoNotTripTheEnergyGuard) {
  const double weight = mass * 9.81;
  const double strength = 10 * weight / pull_off(1);
  Description d = hanging(cohesive(strength), "linear-cohesive");
  d["guards"]["energy"] = 0.01;
  expect_hangs(d);
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.7}};
  expect_hangs(d);
  Trial rest(d);
  rest.step(60000);
  const auto contacts = rest.world().contacts();
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(contacts[0].normal_force, -weight, 1e-6 * weight);
  EXPECT_TRUE(contacts[1].with_wall);
  EXPECT_NEAR(contacts[1].normal_force, -2 * weight, 1e-6 * weight);
  EXPECT_NEAR(contacts[1].overlap, -2 * weight / stiffness, 1e-6 * weight / stiffness);
  EXPECT_NEAR(rest.world().walls()[0].force.z(), -2 * weight, 1e-6 * weight);
  EXPECT_EQ(rest.world().walls()[0].contacts, 1u);
}

TEST(Attraction, GuardFindsEnergyThatTensionCreates) {
  Description d = hanging(cohesive(100 * mass * 9.81 / pull_off(1)), "linear-cohesive");
  Trial stable(d);
  d["time_step"] = {{"value", 3 / 0.05 * stable.world().dt()}, {"allow_unstable", true}};
  d["guards"]["travel"] = 1e9, d["guards"]["overlap"] = 1e9;
  Trial trial(d);
  EXPECT_THAT([&] { trial.step(20000); },
              testing::ThrowsMessage<NumericsError>(testing::HasSubstr("energy was created")));
}

TEST(Attraction, BallsFallThatAreTooHeavy) {
  Description d = hanging(cohesive(1.5 * mass * 9.81 / pull_off(1)), "linear-cohesive");
  Trial trial(d);
  trial.step(20000);
  EXPECT_EQ(trial.world().walls()[0].contacts, 0u);
  EXPECT_LT(trial.position(0).z(), -1.1 * radius);
}

/// A bond that is stretched over more than the skins, through many neighbour searches, until it breaks. Coming back,
/// the bodies attract each other only after their surfaces have touched again.
TEST(Attraction, NeighbourListsIncludeTheReach) {
  const double strength = 0.4 * stiffness / (std::numbers::pi * radius), reach = 0.4 * radius, speed = 0.02;
  for (const bool wall : {false, true}) {
    Description d =
        grains("linear-cohesive", cohesive(strength), {{{0, 0, (1 - 1e-9) * radius}, radius, {0, 0, speed}}});
    const auto moving = [](const char* group, double velocity) {
      return Description{{"type", "prescribed-motion"}, {"groups", {group}}, {"velocity", {0, 0, velocity}}};
    };
    d["engines"]["up"] = moving("grains", speed);
    if (wall) {
      d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    } else {
      d["bodies"]["below"] = d["bodies"]["grains"];
      d["bodies"]["below"]["source"]["bodies"][0]["position"] = {0, 0, -(1 - 1e-9) * radius};
      d["engines"]["down"] = moving("below", -speed);
    }
    for (const auto& [name, sign] : {std::pair("back", -1.0), std::pair("out", 1.0)}) {
      Description stage = d["stages"][0];
      stage["name"] = name;
      stage["change"]["engines"]["up"]["velocity"] = {0, 0, sign * speed};
      if (!wall) stage["change"]["engines"]["down"]["velocity"] = {0, 0, -sign * speed};
      d["stages"].push_back(stage);
    }
    d["domain"] = {{"low", {-0.02, -0.02, -0.02}}, {"high", {0.02, 0.02, 0.02}}};
    d["time_step"] = {{"value", 1e-5}, {"allow_unstable", true}};
    Trial trial(d);
    const double closing = wall ? speed : 2 * speed, precision = 1e-6 * stiffness * reach;
    double gap = -(wall ? 1e-9 : 2e-9) * radius;
    int steps = 0;
    const auto step = [&](double sign) {
      if (++steps % 7 == 0) trial.kernel().request_rebuild();
      trial.step();
      gap += sign * 1e-5 * closing;
    };
    const auto force = [&] {
      const auto contacts = trial.world().contacts();
      return contacts.empty() ? 0 : contacts[0].normal_force;
    };
    while (gap < 1.1 * reach) {
      step(1);
      ASSERT_EQ(trial.world().contacts().size(), gap < reach ? 1u : 0u) << gap / reach;
      ASSERT_NEAR(force(), gap < reach ? -stiffness * gap : 0, precision);
    }
    EXPECT_EQ(trial.kernel().state().pairs.touching_count(), 0u);
    trial.begin_stage(1, "back");
    while (gap > -0.01 * radius) {
      step(-1);
      ASSERT_NEAR(force(), gap < 0 ? -stiffness * gap : 0, precision) << "the bond is broken; " << gap / reach;
    }
    EXPECT_EQ(trial.world().contacts().size(), 1u);
    trial.begin_stage(2, "out");
    while (gap < 0.5 * reach) {
      step(1);
      ASSERT_NEAR(force(), -stiffness * gap, precision) << "the surfaces have touched; " << gap / reach;
    }
  }
}

TEST(Attraction, PeriodsIncludeTheReach) {
  const double reach = 0.4 * radius, strength = 0.4 * stiffness / (std::numbers::pi * radius);
  const auto step = [&](double length) {
    Description d = energy_balance_tests::periodic("linear-cohesive", cohesive(strength), {{Vec3::Zero(), radius}},
                                                   Vec3::Constant(length), Vec3::Zero());
    Trial trial(d);
  };
  const double shortest = 4 * (radius + 0.03 * 2 * radius) + 2 * reach;
  EXPECT_NO_THROW(step(1.01 * shortest));
  EXPECT_THAT([&] { step(0.99 * shortest); },
              testing::ThrowsMessage<NumericsError>(testing::HasSubstr("below the minimum of")));
}

TEST(Attraction, ContactsAreThoseWithAForce) {
  const double strength = 0.4 * stiffness / (std::numbers::pi * radius);
  Description d =
      grains("linear-cohesive", cohesive(strength), {{{0, 0, 1.2 * radius}, radius}, {{0, 0, 3.4 * radius}, radius}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  Trial trial(d);
  EXPECT_TRUE(trial.kernel().state().pairs.contacts(0)) << "within the reach";
  EXPECT_EQ(trial.kernel().state().pairs.touching_count(), 0u);
  EXPECT_EQ(trial.kernel().state().wall_contacts.touching_count(), 0u);
  EXPECT_TRUE(trial.world().contacts().empty());
  EXPECT_EQ(trial.world().walls()[0].contacts, 0u);
  EXPECT_EQ(trial.world().mean_contact_force(), 0);
}

TEST(Attraction, AChangeOfTheReachSearchesNeighboursAgain) {
  Description d = grains("linear-cohesive", cohesive(1e5), {{{0, 0, 0}, radius}, {{0, 0, 2.5 * radius}, radius}});
  Description next = d["stages"][0];
  next["name"] = "strong", next["change"]["materials"]["grain"]["tensile_strength"] = 2e5;
  d["stages"].push_back(next);
  next = d["stages"][0], next["name"] = "same", next["change"]["materials"]["grain"]["friction_angle"] = 0.1;
  d["stages"].push_back(next);
  Trial trial(d);
  trial.step(3);
  const auto searches = trial.kernel().state().lists.rebuilds();
  trial.begin_stage(1, "strong"), trial.step();
  EXPECT_EQ(trial.kernel().state().lists.rebuilds(), searches + 1);
  trial.begin_stage(2, "same"), trial.step();
  EXPECT_EQ(trial.kernel().state().lists.rebuilds(), searches + 1);
}

/// A ball that is pulled off a plane, and its largest tension [N] and last gap [m].
struct PulledOff {
  double tension = 0, gap = 0;
};
PulledOff pull_off(const std::string& law, const Description& material, const Description& settings = {},
                   double travel = 1e-7) {
  const double speed = 1e-3;
  Description d = grains(law, material, {{{0, 0, radius - 1e-9}, radius, {0, 0, speed}}});
  if (!settings.is_null()) d["contacts"].update(settings);
  d["engines"]["hold"] = {{"type", "hold"}, {"translation", "xyz"}};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["time_step"] = {{"value", travel / speed}, {"allow_unstable", true}};
  Trial trial(d);
  PulledOff found;
  while (!trial.world().contacts().empty()) {
    const Contact& contact = trial.world().contacts()[0];
    found.tension = std::max(found.tension, -contact.normal_force), found.gap = -contact.overlap;
    trial.step();
  }
  return found;
}

TEST(PullOff, OfALinearBondIsItsStrength) {
  const double strength = 2e5;
  const PulledOff found = pull_off("linear-cohesive", cohesive(strength), {}, 1e-8);
  verify("pull-off force of a linear bond at a plane, over its strength", found.tension / pull_off(strength), 1, 1e-3);
  verify("gap at which a linear bond breaks, over F/k", found.gap / (pull_off(strength) / stiffness), 1, 1e-3);
}

constexpr double young = 1e7, poisson = 0.25, surface_energy = 0.5, work = 2 * surface_energy;
const double plane_modulus = young / (2 * (1 - poisson * poisson));
const Description sticky{
    {"young_modulus", young}, {"poisson_ratio", poisson}, {"surface_energy", surface_energy}, {"friction_angle", 0}};

TEST(PullOff, IsWhatJohnsonKendallAndRobertsSay) {
  const PulledOff found = pull_off("jkr", sticky, {}, 2e-9);
  const double force = 1.5 * std::numbers::pi * work * radius;
  const double least = std::cbrt(std::numbers::pi * work * radius * radius / (8 * plane_modulus));
  const double gap = std::sqrt(2 * std::numbers::pi * work * least / plane_modulus) - least * least / radius;
  verify("pull-off force of a JKR contact at a plane, over 3/2 π w R", found.tension / force, 1, 1e-4);
  verify("gap at which a JKR contact breaks, over the closed form", found.gap / gap, 1, 2e-3);
}

TEST(PullOff, OfALiquidBridgeIsThatOfItsMeniscus) {
  const double angle = 0.4, volume = 1e-13, tension = 0.072;
  const PulledOff found = pull_off("capillary", {{"contact_modulus", modulus}, {"contact_angle", angle}},
                                   {{"surface_tension", tension}, {"bridge_volume", volume}}, 1e-8);
  verify("force of a liquid bridge at a plane, over 4π R γ cos θ",
         found.tension / (4 * std::numbers::pi * radius * tension * std::cos(angle)), 1, 2e-3);
  verify("rupture distance of a liquid bridge, over (1 + θ/2) V^(1/3)",
         found.gap / ((1 + 0.5 * angle) * std::cbrt(volume)), 1, 1e-3);
}

TEST(Attraction, JkrBallsHangAndDoNotTripTheEnergyGuard) {
  Description material = sticky;
  material["surface_energy"] = 2 * mass * 9.81 / (std::numbers::pi * radius);
  Description d = hanging(material, "jkr");
  d["guards"]["energy"] = 0.01;
  expect_hangs(d);
}

TEST(Attraction, WetBallsHangAndDoNotTripTheEnergyGuard) {
  Description d = hanging({{"contact_modulus", modulus}}, "capillary");
  d["contacts"].update(
      {{"surface_tension", 4 * mass * 9.81 / (2 * std::numbers::pi * radius)}, {"bridge_volume", 1e-12}});
  d["guards"]["energy"] = 0.01;
  expect_hangs(d);
}

/// Head-on, with enough speed to part again.
TEST(Attraction, CollisionsCloseTheEnergyBalance) {
  for (const std::string law : {"jkr", "capillary"}) {
    const double speed = 0.2;
    const Description material = law == "jkr" ? sticky : Description{{"contact_modulus", modulus}};
    Description d =
        grains(law, material, {{Vec3::Zero(), radius, {speed, 0, 0}}, {{2.01 * radius, 0, 0}, radius, {-speed, 0, 0}}});
    if (law == "capillary") d["contacts"].update({{"bridge_volume", 1e-12}});
    d["time_step"]["value"] = 2e-8;
    Kept hit(d);
    do hit.step();
    while (hit.velocity(0).x() > 0 || !hit.world().contacts().empty());
    const Energies now = hit.world().energies();
    EXPECT_GT(now.viscosity, 0) << law;
    EXPECT_NEAR(now.kinetic + now.viscosity, 2 * kinetic_at(speed), 0.02 * now.viscosity) << law;
    verify("closure error over the energy of a collision, " + law, now.closure_error / (2 * kinetic_at(speed)), 0, 1e-3,
           1.0);
  }
}

}  // namespace
}  // namespace grit::test::attraction_tests
