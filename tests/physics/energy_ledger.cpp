// Where energy goes, against closed forms; and how well the ledger closes.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "grit/plugin.hpp"
#include "support/clump.hpp"
#include "support/packing.hpp"
#include "support/verified.hpp"

namespace grit::test::energy_ledger_tests {
namespace {

constexpr double radius = 1e-3, density = 2500, safety = 0.02;
const double mass = density * 4.0 / 3 * std::numbers::pi * radius * radius * radius;

Description grains(const std::string& law, const Description& more, const std::vector<Grain>& list) {
  Description material = more;
  material["density"] = density;
  Description d = description(law, material, list);
  d["time_step"]["safety"] = safety;
  return d;
}

/// Far below the critical step [s]: a fall without contacts is not to be refused for the stiffness of those it might
/// have.
constexpr double fall_step = 1e-6;

/// A world whose ledger begins at once.
struct Kept : Trial {
  explicit Kept(const Description& d) : Trial(d, 1, BodyState::energy) { world().energies(); }
};

double kinetic_at(double speed) { return 0.5 * mass * speed * speed; }

TEST(EnergyLedger, OfAFallIsKineticAndGravitational) {
  Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius}});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["time_step"]["value"] = fall_step;
  Kept fall(d);
  fall.step(1000);
  const EnergyLedger now = fall.world().energies();
  EXPECT_LE(std::abs(now.closure_error), 1e-12 * now.kinetic);
  EXPECT_NEAR(now.gravitational, mass * 9.81 * fall.position(0).z(), 1e-12 * now.kinetic);
}

TEST(EnergyLedger, LocalDampingTakesItsShareOfTheWork) {
  Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius}});
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.3}};
  d["time_step"]["value"] = fall_step;
  Kept fall(d);
  fall.step(1000);
  const EnergyLedger now = fall.world().energies();
  // A body at rest is not damped: the first half step is free.
  verify("share of a fall's energy that local damping takes", now.local_damping / -now.gravitational, 0.3, 2e-3);
  EXPECT_LE(std::abs(now.closure_error), 1e-3 * now.kinetic) << "the half step is braked by whole forces";
}

// Damping adds to the force that brakes the grains and takes from the one that drives them apart again: a spring is
// loaded by 1 / (1 + λ) of what they bring, and gives 1 - λ of that back.
TEST(EnergyLedger, LocalDampingTakesItsShareOfAnImpact) {
  const double speed = 0.1, damping = 0.3;
  Description d = grains("linear-rolling", {},
                         {{Vec3::Zero(), radius, {speed, 0, 0}}, {{2 * radius, 0, 0}, radius, {-speed, 0, 0}}});
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", damping}};
  Kept pair(d);
  pair.step(2000);
  const EnergyLedger now = pair.world().energies();
  const double before = 2 * kinetic_at(speed), left = (1 - damping) / (1 + damping);
  ASSERT_EQ(now.elastic(), 0) << "they are apart again";
  EXPECT_NEAR(now.local_damping / before, 1 - left, 2e-3);
  EXPECT_NEAR(now.kinetic / before, left, 2e-3);
  EXPECT_LE(std::abs(now.closure_error), 1e-3 * before);
}

TEST(EnergyLedger, ADashpotTakesWhatRestitutionSays) {
  for (const std::string law : {"linear-frictional", "hertz-mindlin"}) {
    Description material{{"restitution", 0.5}, {"friction_angle", 0}};
    if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
    const double speed = 0.5;
    Description d =
        grains(law, material, {{Vec3::Zero(), radius, {speed, 0, 0}}, {{2.01 * radius, 0, 0}, radius, {-speed, 0, 0}}});
    d["time_step"]["value"] = 2e-8;
    Kept hit(d);
    do hit.step();
    while (hit.velocity(0).x() > 0 || !hit.world().contacts().empty());
    const EnergyLedger now = hit.world().energies();
    const double start = 2 * kinetic_at(speed);
    verify("share of the energy that the dashpot takes at restitution 0.5, " + law, now.viscosity / start, 0.75,
           law == "hertz-mindlin" ? 1e-4 : 1e-3);
    verify("closure error over the energy of a damped collision, " + law, now.closure_error / start, 0, 1e-5, 1.0);
    EXPECT_EQ(now.friction, 0);
  }
}

TEST(EnergyLedger, ABallThatSlidesUntilItRollsLosesTwoSevenths) {
  for (const std::string law : {"linear-frictional", "linear-rolling", "hertz-mindlin"}) {
    Description material{{"friction_angle", 0.2}};
    if (law == "linear-rolling") material["rolling_limit"] = 0;
    if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
    const double speed = 0.3;
    Description d = grains(law, material, {{{0, 0, 0.9999 * radius}, radius, {speed, 0, 0}}});
    d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -100}}};
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["time_step"]["safety"] = 0.1;
    Kept slide(d);
    while (slide.spin(0).y() * radius < 0.999 * slide.velocity(0).x()) slide.step(100);
    slide.step(5000);
    const EnergyLedger now = slide.world().energies();
    verify("energy lost over kinetic energy of a ball that slides until it rolls, " + law,
           now.friction / kinetic_at(speed), 2.0 / 7, law == "hertz-mindlin" ? 1e-2 : 5e-3);
    verify("closure error over the energy of a ball that slides until it rolls, " + law,
           now.closure_error / kinetic_at(speed), 0, 5e-3, 1.0);
  }
}

Description rough(const std::string& law, double friction_angle) {
  Description material{{"friction_angle", friction_angle}};
  if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
  else material["contact_modulus"] = 1e7;
  if (law == "linear-rolling") material["rolling_stiffness"] = 0;
  return material;
}

TEST(EnergyLedger, FrictionOfDeepContactsIsWhatMotionLoses) {
  // Laws tell slip with the radii as arms, but bodies are nearer to each other than these: of slip times force they
  // feel less, by 5 % at the start.
  for (const std::string law : {"linear-rolling", "linear-frictional", "hertz-mindlin"})
    for (const double ratio : {1.0, 4.0}) {
      const double other = radius / ratio;
      const Vec3 apart(0.95 * (radius + other), 0, 0), across(0, 2, 0), spin(0, 0, 3 / radius);
      Description d = grains(law, rough(law, 0.02),
                             {{Vec3::Zero(), radius, across, spin}, {apart, other, -across, Vec3(0, 0, -1 / radius)}});
      d["time_step"]["safety"] = 0.1 * safety;
      d["guards"]["overlap"] = 0.3;
      Kept slide(d);
      while (slide.world().pair_count() > 0) slide.step(10);
      const EnergyLedger now = slide.world().energies();
      EXPECT_GT(now.friction, 1e-3 * now.kinetic);
      EXPECT_EQ(now.elastic(), 0);
      verify("friction of two of a ratio of " + std::string(ratio == 1 ? "1" : "4") +
                 " that slide and overlap by a twentieth, over what motion lost, " + law,
             now.friction / (now.friction - now.closure_error), 1, 2e-3);
    }
}

TEST(EnergyLedger, ABallThatIsPressedDeepAndRollsDownASlopeLosesNothing) {
  for (const std::string law : {"linear-rolling", "linear-frictional", "hertz-mindlin"}) {
    const double depth = 0.1, angle = 0.4, contact_modulus = 1e7;
    const double pressed =
        law == "hertz-mindlin" ? 0.02 * 1e8 * radius * radius : contact_modulus * radius * depth * radius;
    Description d = grains(law, rough(law, 1.3), {{{0, 0, (1 - depth) * radius}, radius}});
    const double g = pressed / (mass * std::cos(angle));
    d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {g * std::sin(angle), 0, -g * std::cos(angle)}}};
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());

    Kept roll(d);
    while (roll.position(0).x() < 20 * radius) roll.step(10);
    const EnergyLedger now = roll.world().energies();
    EXPECT_LE(now.friction, 1e-3 * now.kinetic) << "it sticks";
    verify("closure error over the energy of a ball that is pressed deep and rolls down a slope, " + law,
           now.closure_error / now.kinetic, 0, 2e-3, 1.0);
  }
}

TEST(EnergyLedger, RollingResistanceTakesWhatIsLeft) {
  const double speed = 0.1;
  Description d = grains("linear-rolling", {{"friction_angle", 0.5}, {"rolling_limit", 0.01}},
                         {{{0, 0, 0.9999 * radius}, radius, {speed, 0, 0}, {0, speed / radius, 0}}});
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {0, 0, -1000}}};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["time_step"]["safety"] = 0.1;
  Kept roll(d);
  const double start = roll.world().energies().kinetic;
  while (roll.spin(0).y() > 0) roll.step(100);
  const EnergyLedger now = roll.world().energies();
  verify("energy that rolling resistance takes of a ball that rolls to rest, over its kinetic energy",
         now.rolling / start, 1, 2e-2);
  verify("closure error over the energy of a ball that rolls to rest", now.closure_error / start, 0, 5e-3, 1.0);
}

// Nothing is reckoned before somebody asks, and from then on all of it, on the same way.
TEST(EnergyLedger, OneThatBeginsLateIsTheRestOfAnEarlyOne) {
  Description d = grains("linear-rolling", {{"friction_angle", 0.2}, {"rolling_limit", 0.01}},
                         {{{0, 0, 0.9999 * radius}, radius, {0.3, 0, 0}}});
  d["engines"]["gravity"] = {{"type", "gravity"}, {"acceleration", {1, 0, -1000}}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.1}};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["floor"]["motion"]["velocity"] = {0, 0, 1e-3};
  d["time_step"]["safety"] = 0.1;
  Kept early(d);
  Trial late(d, 1, BodyState::energy);
  early.step(500), late.step(500);
  const EnergyLedger before = early.world().energies();
  EXPECT_EQ(late.world().energies().dissipated(), 0);
  early.step(500), late.step(500);
  const EnergyLedger whole = early.world().energies(), rest = late.world().energies();
  EXPECT_EQ(early.position(0), late.position(0));
  for (const auto member : {&EnergyLedger::friction, &EnergyLedger::rolling, &EnergyLedger::local_damping,
                            &EnergyLedger::gravitational, &EnergyLedger::walls}) {
    EXPECT_NE(rest.*member, 0);
    EXPECT_NEAR(rest.*member, whole.*member - before.*member, 1e-12 * std::abs(whole.*member));
  }
}

TEST(EnergyLedger, AWallsWorkIsStored) {
  Description d = grains("linear-frictional", {{"friction_angle", 0}}, {{{0, 0, radius}, radius}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["lid"] = plane({0, 0, 2 * radius}, -Vec3::UnitZ());
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -1e-3};
  Kept press(d);
  while (press.world().wall_states().states()[1].pose.shift.z() > -1e-5) press.step(100);
  const EnergyLedger now = press.world().energies();
  EXPECT_GT(now.elastic_normal, 0);
  verify("energy stored over the work of a wall that presses a grain", now.elastic_normal / now.walls, 1, 2e-6);
  EXPECT_LE(std::abs(now.closure_error), 1e-6 * now.walls);
}

TEST(EnergyLedger, AChangeOfStiffnessIsPutInBySettings) {
  Description d =
      grains("linear-frictional", {{"friction_angle", 0.2}}, {{Vec3::Zero(), radius}, {{1.99 * radius, 0, 0}, radius}});
  d["materials"]["grain"]["contact_modulus"] = 1e8;
  d["stages"].push_back({{"name", "stiffer"},
                         {"change", {{"materials", {{"grain", {{"contact_modulus", 3e8}}}}}}},
                         {"until", {{"type", "steps"}, {"value", 1}}},
                         {"limit", 1}});
  Kept part(d);
  const double before = part.world().energies().elastic();
  part.world().begin_stage("stiffer", *part.scene().stages.at(1).start);
  part.world().find_forces();
  EnergyLedger now = part.world().energies();
  EXPECT_NEAR(now.settings, 2 * before, 1e-12 * before);
  EXPECT_NEAR(now.elastic(), 3 * before, 1e-12 * before);
  EXPECT_LE(std::abs(now.closure_error), 1e-12 * before);
  part.step(2000);
  now = part.world().energies();
  EXPECT_EQ(now.elastic(), 0) << "they have parted";
  EXPECT_NEAR(now.kinetic, 3 * before, 2e-3 * before);
}

/// A packing that is pressed: closure over all that was put in.
double closure_of_a_packing(double share_of_critical, double modulus) {
  const Vec3 low = Vec3::Zero(), high = Vec3::Constant(6e-3);
  Description d = description("linear-rolling", {{"contact_modulus", modulus}, {"density", 2600}},
                              jumble({6, 6, 6}, 1e-3, 0.005, 5));
  const char* const names[3][2] = {{"left", "right"}, {"front", "back"}, {"bottom", "lid"}};
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {true, false})
      d["walls"][names[axis][up ? 0 : 1]] = side(axis, up ? low[axis] : high[axis], low, high, up);
  d["walls"]["lid"]["motion"]["velocity"] = {0, 0, -0.2};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.2}};
  d["time_step"]["safety"] = share_of_critical;
  d["guards"]["overlap"] = 0.9;
  Kept press(d);
  while (press.world().time() < 1.5e-3) press.step();
  const EnergyLedger now = press.world().energies();
  EXPECT_GT(now.friction, 0.01 * now.walls);
  EXPECT_GT(now.local_damping, 0.01 * now.walls);
  EXPECT_GT(now.walls, 0);
  return std::abs(now.closure_error) / (now.walls + now.dissipated());
}

TEST(EnergyLedger, WhatASpringHeldGoesWithTheSettingThatSwitchesItOff) {
  for (const std::string law : {"linear-rolling", "linear-frictional", "hertz-mindlin"})
    for (const std::string off :
         {"shear_to_normal_stiffness", "friction_angle", "rolling_stiffness", "rolling_limit"}) {
      SCOPED_TRACE(law + ", " + off);
      const bool rolls = law != "linear-frictional", hertz = law == "hertz-mindlin";
      if ((!rolls && off.starts_with("rolling")) || (hertz && off == "shear_to_normal_stiffness")) continue;
      Description d = grains(law, {{"friction_angle", 0.5}},
                             {{Vec3::Zero(), radius}, {{1.99 * radius, 0, 0}, radius, {0, 1e-3, 0}, {0, 0, 3}}});
      auto& grain = d["materials"]["grain"];
      if (rolls) grain["rolling_stiffness"] = 0.7, grain["rolling_limit"] = 0.4;
      // Another pair keeps the feature on.
      d["materials"]["other"] = grain;
      d["stages"].push_back({{"name", "without"},
                             {"change", {{"materials", {{"grain", {{off, 0}}}}}}},
                             {"until", {{"type", "steps"}, {"value", 1}}},
                             {"limit", 1}});
      Kept pair(d);
      pair.step(40);
      const EnergyLedger before = pair.world().energies();
      ASSERT_GT(off.starts_with("rolling") ? before.elastic_rolling : before.elastic_shear, 0);
      pair.world().begin_stage("without", *pair.scene().stages.at(1).start);
      pair.world().find_forces();
      const EnergyLedger now = pair.world().energies();
      EXPECT_LT(now.settings, 0);
      EXPECT_NEAR(now.friction + now.rolling, before.friction + before.rolling, 1e-12 * before.elastic());
      // Half a step of the force that is gone, of the 40 that loaded the spring.
      EXPECT_NEAR(now.closure_error, before.closure_error, -0.05 * now.settings);
    }
}

TEST(EnergyLedger, OfAPackingClosesBetterWithShorterSteps) {
  const double coarse = closure_of_a_packing(0.8, 1e7), fine = closure_of_a_packing(0.1, 1e7);
  verify("closure error of a packing pressed at 0.1 of the critical step, over work and dissipation", fine, 0, 0.01,
         1.0);
  EXPECT_LE(fine, 0.5 * coarse);
}

Description periodic(const std::string& law, const Description& material, const std::vector<Grain>& list,
                     const Vec3& size, const Vec3& strain_rate) {
  Description d = grains(law, material, list);
  d["domain"] = {{"low", {0, 0, 0}},
                 {"high", vector(size)},
                 {"periodic", {true, true, true}},
                 {"strain_rate", vector(strain_rate)}};
  return d;
}

double turnover(const EnergyLedger& now) {
  return std::abs(now.walls) + std::abs(now.cell) + std::abs(now.engines) + now.dissipated() + now.elastic();
}
double closure_share(const EnergyLedger& now) { return std::abs(now.closure_error) / turnover(now); }

// All spheres go with the mean flow, so that each contact is as deep as the cell says.
TEST(EnergyLedger, ACellsWorkIsStoredInALattice) {
  constexpr int side = 3;
  const double spacing = 1.99 * radius, modulus = 1e8;
  std::vector<Grain> list;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z) list.push_back({spacing * Vec3(x + 0.25, y + 0.25, z + 0.25), radius});
  Kept lattice(
      periodic("linear-rolling", {{"contact_modulus", modulus}}, list, Vec3::Constant(side * spacing), {-40, 0, 10}));
  const double kinetic = lattice.world().energies().kinetic;
  lattice.step(2000);
  const EnergyLedger now = lattice.world().energies();
  const Cell& cell = lattice.world().cell();
  double stored = 0;
  const auto spring = [&](double apart) { return 0.5 * modulus * radius * std::pow(2 * radius - apart, 2); };
  for (int k = 0; k < 3; ++k)
    stored += side * side * side * (spring((cell.high[k] - cell.low[k]) / side) - spring(spacing));
  ASSERT_GT(stored, 500 * kinetic);
  verify("work of a cell that squeezes a lattice, less its motion's, over what its springs store",
         (now.cell - (now.kinetic - kinetic)) / stored, 1, 1e-9);
  EXPECT_LE(std::abs(now.closure_error), 1e-9 * stored);
}

// Apart from each other, they go with the mean flow, and on at the other side with what flows there.
TEST(EnergyLedger, ACellsWorkMovesWhatGoesThroughIt) {
  for (const bool clumped : {false, true}) {
    SCOPED_TRACE(clumped);
    Description d = periodic("linear-rolling", {}, {{Vec3::Constant(0.012), radius, {3, -2, 1}, {20, 30, 10}}},
                             Vec3::Constant(0.02), {-20, 30, 10});
    if (clumped) make_clumps(d, boomerang());
    d["time_step"]["value"] = 1e-6;
    Kept one(d);
    const double before = one.world().energies().kinetic;
    for (int round = 0; round < 20; ++round) one.world().search_next(), one.step(1000);
    const EnergyLedger now = one.world().energies();
    EXPECT_GT(std::abs(now.kinetic - before), 0.01 * before);
    EXPECT_LE(std::abs(now.closure_error), 2e-8 * now.kinetic);
  }
}

/// A packing in a cell that is pressed along two axes and stretched along the third.
EnergyLedger strained_packing(double share_of_critical, bool clumped, double friction, double damping = 0) {
  Description d = periodic("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", friction}},
                           jumble({6, 6, 6}, 1e-3, 0.005, 5), Vec3::Constant(6e-3), {-40, -30, 20});
  if (friction == 0) d["materials"]["grain"]["rolling_limit"] = 0;
  if (clumped) make_clumps(d, boomerang());
  if (damping > 0) d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", damping}};
  d["time_step"]["safety"] = share_of_critical;
  d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
  Kept cell(d);
  while (cell.world().time() < 1.5e-3) cell.step();
  return cell.world().energies();
}

TEST(EnergyLedger, OfAStrainedPackingClosesBetterWithShorterSteps) {
  for (const bool clumped : {false, true}) {
    const std::string of = clumped ? "clumps" : "spheres";
    const double smooth = closure_share(strained_packing(0.05, clumped, 0, 0.2));
    verify("closure error of smooth " + of + " in a cell that strains, over all that is turned over", smooth, 0, 1e-3,
           1.0);
    const EnergyLedger rough = strained_packing(0.05, clumped, 0.3);
    EXPECT_GT(std::abs(rough.cell), 0.3 * turnover(rough));
    EXPECT_GT(rough.friction, 0.1 * turnover(rough));
    // What is left is the law's, of the order of overlap over radius.
    verify("closure error of rough " + of + " in a cell that strains, over all that is turned over",
           closure_share(rough), 0, 5e-3, 1.0);
    if (clumped) continue;
    verify("closure error of smooth spheres in a cell that strains, over that at half of the step",
           closure_share(strained_packing(0.2, false, 0, 0.2)) / closure_share(strained_packing(0.1, false, 0, 0.2)), 4,
           0.1);
  }
}

// Along a slow strain, bodies are in balance.
TEST(EnergyLedger, ACellsWorkIsThatOfItsStresses) {
  Description d = periodic("linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0.3}},
                           jumble({6, 6, 6}, 1e-3, 0, 5), Vec3::Constant(6e-3), {-8, -6, 4});
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.2}};
  d["time_step"]["safety"] = 0.4;
  d["guards"]["overlap"] = 0.9;
  Kept cell(d);
  const auto power = [&] {
    const Cell& now = cell.world().cell();
    const Mat3 stress = mean_stress(cell.world(), {now.low, now.high});
    return -(now.high - now.low).prod() * now.strain_rate.dot(stress.diagonal());
  };
  while (cell.world().time() < 1e-3) cell.step();
  const double before = cell.world().energies().cell;
  double work = 0;
  for (double last = power(); cell.world().time() < 6e-3;) {
    const double from = cell.world().time();
    cell.step();
    const double now = power();
    work += 0.5 * (last + now) * (cell.world().time() - from), last = now;
  }
  verify("work of a cell that strains slowly over that of its stresses", (cell.world().energies().cell - before) / work,
         1, 0.01);
}

TEST(EnergyLedger, AChangeOfTheStrainRateIsPutInBySettings) {
  for (const bool clumped : {false, true}) {
    std::vector<Grain> apart = jumble({6, 6, 6}, 1e-3, 0.05, 5);
    for (Grain& grain : apart) grain.radius *= 0.85;
    Description d = periodic("linear-frictional", {{"contact_modulus", 1e7}, {"friction_angle", 0}}, apart,
                             Vec3::Constant(6e-3), Vec3::Zero());
    if (clumped) make_clumps(d, boomerang());
    d["time_step"]["safety"] = 0.1;
    d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
    const auto stage = [&](const std::string& name, const Vec3& rate) {
      d["stages"].push_back({{"name", name},
                             {"change", {{"domain", {{"strain_rate", vector(rate)}}}}},
                             {"until", {{"type", "steps"}, {"value", 1}}},
                             {"limit", 1}});
    };
    stage("fast", {-40, 30, 0}), stage("slow", {4, 0, -3});
    Kept cell(d);
    for (const int next : {1, 2}) {
      cell.step(300);
      const EnergyLedger before = cell.world().energies();
      cell.world().begin_stage(next == 1 ? "fast" : "slow", *cell.scene().stages.at(next).start);
      cell.world().find_forces();
      const EnergyLedger now = cell.world().energies();
      const double scale = now.kinetic + turnover(now);
      EXPECT_NEAR(now.closure_error, before.closure_error, 1e-6 * scale);
      EXPECT_NEAR(now.kinetic - before.kinetic, now.settings - before.settings, 1e-3 * scale);
      EXPECT_GT(std::abs(now.settings - before.settings), 0.05 * scale);
    }
    cell.step(300);
    const EnergyLedger now = cell.world().energies();
    EXPECT_LE(std::abs(now.closure_error), 2e-3 * (now.kinetic + turnover(now)));
  }
}

Description hold(bool translation, bool rotation) {
  return {{"type", "hold"}, {"translation", translation}, {"rotation", rotation}};
}

TEST(EnergyLedger, WhatHoldsGrainsPressesTheirSpring) {
  const double speed = 0.1, modulus = 1e8;
  Description d = grains("linear-rolling", {{"contact_modulus", modulus}},
                         {{Vec3::Zero(), radius, {speed, 0, 0}}, {{2 * radius, 0, 0}, radius, {-speed, 0, 0}}});
  d["engines"]["hold"] = hold(true, true);
  Kept pair(d);
  pair.step(1000);
  const EnergyLedger now = pair.world().energies();
  const double overlap = 2 * speed * pair.world().time(), stored = 0.5 * modulus * radius * overlap * overlap;
  EXPECT_EQ(now.kinetic, 2 * kinetic_at(speed)) << "they do not feel the spring";
  verify("work of what holds two grains at their speeds over what their spring stores", now.engines / stored, 1, 1e-9);
  EXPECT_LE(std::abs(now.closure_error), 1e-9 * stored);
}

TEST(EnergyLedger, WhatHoldsAGrainLiftsIt) {
  for (const bool clumped : {false, true}) {
    Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius, {0.5, 0, 2}}});
    if (clumped) make_clumps(d, boomerang());
    d["engines"]["gravity"] = {{"type", "gravity"}};
    d["engines"]["hold"] = hold(true, false);
    d["time_step"]["value"] = fall_step;
    Kept lift(d);
    lift.step(1000);
    const EnergyLedger now = lift.world().energies();
    const double height = 2 * lift.world().time();
    EXPECT_NEAR(now.engines, lift.mass(0) * 9.81 * height, 1e-10 * now.engines);
    EXPECT_LE(std::abs(now.closure_error), 1e-10 * now.engines);
  }
}

TEST(EnergyLedger, WhatHoldsASpinRubs) {
  const double overlap = 1e-5 * radius, spin = 50, angle = 0.2, modulus = 1e8, shear = 0.3;
  Description d =
      grains("linear-frictional",
             {{"contact_modulus", modulus}, {"friction_angle", angle}, {"shear_to_normal_stiffness", shear}},
             {{{0, 0, radius - overlap}, radius, Vec3::Zero(), {0, spin, 0}}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["engines"]["hold"] = hold(true, true);
  Kept rub(d);
  rub.step(3000);
  const EnergyLedger now = rub.world().energies();
  const double stiffness = modulus * radius, limit = std::tan(angle) * stiffness * overlap;
  const double way = spin * radius * rub.world().time(), loaded = limit / (shear * stiffness);
  ASSERT_GT(way, 10 * loaded);
  verify("work of what holds a spin against friction", now.engines, limit * (way - 0.5 * loaded), 1e-3);
  EXPECT_GT(now.friction, 0.9 * now.engines);
  verify("closure error over the work of what holds a spin against friction", now.closure_error / now.engines, 0, 1e-4,
         1.0);
}

// As it is held, it turns on while its momentum stays, and presses and rubs with one sphere after the other.
TEST(EnergyLedger, WhatHoldsAClumpPressesAndRubs) {
  for (const double friction : {0.0, 0.2}) {
    Description d = grains("linear-frictional", {{"contact_modulus", 1e7}, {"friction_angle", friction}},
                           {{{0, 0, 0.66 * radius}, radius, {0.3, 0, -0.01}, {20, 30, 40}}});
    make_clumps(d, boomerang());
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["engines"]["hold"] = hold(true, true);
    d["time_step"]["value"] = 1e-6;
    d["guards"] = {{"overlap", 0.9}, {"travel", 0.2}};
    Kept clump(d);
    clump.step(4000);
    const EnergyLedger now = clump.world().energies();
    EXPECT_GT(now.elastic(), 0.1 * now.engines);
    if (friction > 0) EXPECT_GT(now.friction, 0.1 * now.engines);
    verify(std::string("closure error over the work of what holds a clump on a ") +
               (friction > 0 ? "rough" : "smooth") + " floor",
           now.closure_error / now.engines, 0, friction > 0 ? 5e-3 : 1e-4, 1.0);
  }
}

TEST(EnergyLedger, IsWholeAfterBodiesAreLetGo) {
  Description d = grains("linear-rolling", {},
                         {{Vec3::Zero(), radius, {0.1, 0, 0}}, {{1.995 * radius, 0, 0}, radius, {-0.1, 0.05, 0}}});
  d["engines"]["hold"] = hold(true, true);
  d["stages"].push_back({{"name", "free"},
                         {"change", {{"engines", {{"hold", nullptr}}}}},
                         {"until", {{"type", "steps"}, {"value", 1}}},
                         {"limit", 1}});
  Kept pair(d);
  pair.step(100);
  const EnergyLedger held = pair.world().energies();
  pair.world().begin_stage("free", *pair.scene().stages.at(1).start);
  pair.world().find_forces();
  pair.step(3000);
  const EnergyLedger now = pair.world().energies();
  EXPECT_GT(held.engines, 0.1 * held.elastic());
  EXPECT_NEAR(now.engines, held.engines, 0.05 * held.engines) << "half a step of the last hundred";
  EXPECT_LE(closure_share(now), 1e-3);
}

TEST(EnergyLedger, WhatHoldsBodiesAtRestDoesNothing) {
  Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius}, {{1.99 * radius, 0, 0}, radius}});
  d["engines"]["hold"] = hold(true, true);
  Kept pair(d);
  pair.step(100);
  const EnergyLedger now = pair.world().energies();
  EXPECT_GT(now.elastic(), 0);
  EXPECT_EQ(now.engines, 0);
  EXPECT_EQ(now.kinetic, 0);
  EXPECT_EQ(now.closure_error, 0);
}

/// Pushes bodies by what a test says.
struct Push final : Engine {
  using Act = std::function<void(const World&, std::span<Row> force, std::span<Row> moment)>;
  static inline Act act;
  void declare(Parameters&) override {}
  Phase phase() const override { return Phase::forces; }
  void forces(const World& world, std::span<Row> force, std::span<Row> moment) const override {
    act(world, force, moment);
  }
};
void pushed(Description& d, Push::Act act) {
  static const PluginInfo info = [] {
    PluginInfo push;
    push.kind = "engine", push.name = "push", push.version = "1.0.0", push.doc = "for tests";
    push.make_engine = []() -> Engine* { return new Push; };
    return push;
  }();
  installed().add(info);
  Push::act = std::move(act);
  d["engines"]["push"] = {{"type", "push"}};
}

TEST(EnergyLedger, AConstantForceDoesItsWorkAlongTheWay) {
  const Vec3 push(2e-3, -1e-3, 3e-3);
  Description d = grains("linear-rolling", {}, {{Vec3::Zero(), radius, {0, 0.1, 0}}});
  d["time_step"]["value"] = fall_step;
  pushed(d, [=](const World&, std::span<Row> force, std::span<Row>) {
    for (Row& one : force) one += Row{push.x(), push.y(), push.z(), 0};
  });
  Kept way(d);
  way.step(1000);
  const EnergyLedger now = way.world().energies();
  verify("work of an engine's constant force over force times way", now.engines / push.dot(way.position(0)), 1, 1e-12);
  EXPECT_LE(std::abs(now.closure_error), 1e-12 * now.engines);
}

/// A body in an engine's spring that is turned on and off: closure over the largest work.
double closure_in_a_spring(double dt, bool clumped, const Vec3& strain_rate = Vec3::Zero()) {
  const double stiffness = 1, frequency = 300;
  Description d = periodic("linear-rolling", {}, {{Vec3(0.0196, 0.01, 0.01), radius, {0.5, 0, 1}, {100, 200, -300}}},
                           Vec3::Constant(0.02), strain_rate);
  if (clumped) make_clumps(d, boomerang());
  d["time_step"]["value"] = dt;
  d["guards"]["travel"] = 0.2;
  pushed(d, [=](const World& world, std::span<Row> force, std::span<Row> moment) {
    const double now = stiffness * (1 + 0.5 * std::sin(frequency * world.time()));
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (world.ids()[i] != 0) continue;  // of a clump, one sphere alone
      const Vec3 pull = now * (Vec3::Constant(0.01) - xyz(world.positions()[i]));
      force[i] = {pull.x(), pull.y(), pull.z(), 0}, moment[i] = {1e-9, -2e-9, 3e-9, 0};
    }
  });
  Kept swing(d);
  double largest = 0;
  while (swing.world().time() < 0.02) swing.step(), largest = std::max(largest, swing.world().energies().engines);
  return std::abs(swing.world().energies().closure_error) / largest;
}

TEST(EnergyLedger, ClosesAroundAnEnginesSpring) {
  for (const bool clumped : {false, true})
    for (const bool strained : {false, true}) {
      const Vec3 rate = strained ? Vec3(-20, 15, 10) : Vec3::Zero();
      const double coarse = closure_in_a_spring(2e-6, clumped, rate), fine = closure_in_a_spring(1e-6, clumped, rate);
      const std::string what = std::string(clumped ? "a clump" : "a sphere") + " in an engine's spring" +
                               (strained ? ", in a cell that strains" : "");
      verify("closure error of " + what + ", over the engine's work", fine, 0, 1e-6, 1.0);
      if (strained) EXPECT_LE(fine, 0.4 * coarse);
      else verify("closure error of " + what + ", over that at half of the step", coarse / fine, 4, 0.05);
    }
}

}  // namespace
}  // namespace grit::test::energy_ledger_tests
