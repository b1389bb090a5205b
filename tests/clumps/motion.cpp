// A clump as a rigid body.
#include <gtest/gtest.h>

#include <cmath>

#include "support/clump.hpp"
#include "support/packing.hpp"
#include "support/verified.hpp"

namespace grit::test::motion_tests {
namespace {

const Description stuff{{"density", 2600}, {"contact_modulus", 1e7}};

/// An isolated clump that spins about the principal axis `axis`, and slightly about the others.
Description top(int axis, double speed, double little) {
  Description d = description("linear-rolling", stuff, {{Vec3::Zero(), 1e-3}});
  make_clumps(d, boomerang());
  const Trial still([&] {
    Description s = d;
    s["time_step"]["value"] = 1e-6;
    return s;
  }());
  const Mat3 axes = still.world().clumps().front().axes;
  const Vec3 spin = axes * (speed * Vec3(Vec3::Unit(axis)) + little * Vec3::Ones());
  d["bodies"]["grains"]["source"]["bodies"][0]["spin"] = vector(spin);
  d["time_step"] = {{"value", 0.02 / speed}, {"allow_unstable", true}};  // no contacts
  return d;
}

double energy(const Trial& trial) { return kinetic_energy_of(trial.world().clumps().front(), 0); }

TEST(ClumpMotion, OfAFreeTopKeepsMomentumAndEnergy) {
  for (int axis = 0; axis < 3; ++axis) {
    Trial trial(top(axis, 100, 3));
    const Vec3 momentum = trial.world().clumps().front().momentum;
    const double start = energy(trial);
    double worst = 0;
    for (int round = 0; round < 200; ++round) {
      trial.step(100);
      worst = std::max(worst, std::abs(energy(trial) / start - 1));
      const Mat3 axes = trial.world().clumps().front().axes;
      ASSERT_LT((axes.transpose() * axes - Mat3::Identity()).norm(), 1e-14);
    }
    EXPECT_EQ((trial.world().clumps().front().momentum - momentum).norm(), 0);
    verify("energy of a free top over 60 turns about axis " + std::to_string(axis + 1), 1 + worst, 1, 2e-5);
  }
}

/// Dzhanibekov effect: about its intermediate axis a body flips periodically, with a period given by elliptic
/// integrals.
TEST(ClumpMotion, AboutTheMiddleAxisTurnsOverInTime) {
  Trial trial(top(1, 100, 0.1));
  const ClumpView start = trial.world().clumps().front();
  const Vec3 inertia = start.inertia, l = start.axes.transpose() * start.momentum;
  // Landau and Lifshitz, Mechanics, § 37; the sign of M² − 2 E I₂ determines the axis of precession.
  const double e2 = l.cwiseProduct(l).cwiseQuotient(inertia).sum(), m2 = l.squaredNorm();
  double i1 = inertia[0], i3 = inertia[2];
  const double i2 = inertia[1];
  if (m2 < e2 * i2) std::swap(i1, i3);
  const double rate = std::sqrt(std::abs((i3 - i2) * (m2 - e2 * i1) / (i1 * i2 * i3)));
  const double modulus = std::sqrt(std::abs((i2 - i1) * (e2 * i3 - m2) / ((i3 - i2) * (m2 - e2 * i1))));
  const double half_period = 2 * std::comp_ellint_1(modulus) / rate;
  const auto along = [&] {
    const ClumpView now = trial.world().clumps().front();
    return (now.axes.transpose() * now.momentum)[1];
  };
  std::vector<double> flips;
  double before = along();
  while (flips.size() < 3) {
    trial.step();
    const double now = along(), dt = trial.world().dt();
    if ((now > 0) != (before > 0)) flips.push_back(trial.world().time() - dt * now / (now - before));
    before = now;
  }
  verify("time from one turning over of a top to the next", flips[1] - flips[0], half_period, 1e-3);
  verify("time of the turning over after that", flips[2] - flips[1], half_period, 1e-3);
}

TEST(ClumpMotion, KeepsItsSpheresWhereTheyAre) {
  Description d =
      description("linear-rolling", stuff, {{Vec3(5e-3, 5e-3, 5e-3), 1e-3, {0.3, -0.2, 0.1}, {50, 80, -20}}});
  make_clumps(d, boomerang());
  d["time_step"]["value"] = 1e-5;
  Trial trial(d);
  const auto apart = [&](std::uint32_t i, std::uint32_t j) { return (trial.position(i) - trial.position(j)).norm(); };
  const double a = apart(0, 1), b = apart(1, 2), c = apart(2, 0);
  const Vec3 before = trial.position(1);
  trial.step();
  const Vec3 way = trial.position(1) - before;
  const Vec3 velocity = xyz(trial.world().velocities()[index_of(trial.world(), 1)]);
  EXPECT_LT((way - 1e-5 * velocity).norm(), 1e-12 * way.norm() + 1e-17)
      << "a sphere's velocity is its displacement over the step";
  trial.step(20000);
  EXPECT_NEAR(apart(0, 1), a, 1e-14);
  EXPECT_NEAR(apart(1, 2), b, 1e-14);
  EXPECT_NEAR(apart(2, 0), c, 1e-14);
}

/// Two balls as spheres and as clumps of one sphere each, after 20 ms; the maximum number of wall contacts.
struct Twins {
  explicit Twins(Description d) : spheres(d), clumps((make_clumps(d, listed({ball({3, 4, 5}, 7)})), d)) {
    for (int round = 0; round < 200; ++round) {
      spheres.step(100), clumps.step(100);
      for (const WallView& wall : spheres.world().walls()) max_contacts = std::max(max_contacts, wall.contacts);
    }
  }
  double apart(std::uint32_t id) const { return (spheres.position(id) - clumps.position(id)).norm(); }
  Trial spheres, clumps;
  std::uint32_t max_contacts = 0;
};

TEST(ClumpMotion, OfOneSphereIsThatOfTheSphere) {
  const auto balls = [](double apart) {
    Description d =
        description("linear-rolling", stuff,
                    {{{0, 0, 1.2e-3}, 1e-3, {0.2, 0, 0}, {0, 30, 0}}, {{apart, 0, 1.1e-3}, 0.9e-3, {-0.1, 0.05, 0}}});
    d["engines"]["gravity"] = {{"type", "gravity"}};
    d["time_step"]["value"] = 1e-6;
    return d;
  };
  Description near = balls(2.1e-3);
  near["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  // Local damping depends on the signs of velocities, which in a contact may be round-off: damped balls do not meet.
  Description damped = balls(21e-3);
  damped["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.2}};
  const Twins rolling(near), flying(damped);
  EXPECT_GT(rolling.max_contacts, 0u);
  // Mass and inertia of the union are accurate to 1e-7.
  for (const std::uint32_t id : {0u, 1u}) {
    EXPECT_LT(rolling.apart(id), 1e-5 * 1e-3) << id;
    EXPECT_LT(flying.apart(id), 1e-5 * 1e-3) << id;
  }
}

TEST(ClumpMotion, InACollisionKeepsMomentaAndEnergy) {
  for (const std::string law : {"linear-rolling", "hertz-mindlin"}) {
    Description material{{"density", 2600}, {"friction_angle", 0}};
    if (law == "linear-rolling") material["rolling_limit"] = 0;
    if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
    Description d =
        description(law, material,
                    {{{0, 0, 0}, 1e-3, {0.5, 0, 0}, {100, -50, 20}}, {{2.2e-3, 3e-4, -2e-4}, 1.2e-3, {-0.5, 0.1, 0}}});
    make_clumps(d, boomerang());
    d["time_step"]["value"] = 2e-8;
    Trial trial(d);
    const auto momenta = [&](Vec3& linear, Vec3& angular) {
      linear = angular = Vec3::Zero();
      double kinetic = 0;
      for (const ClumpView& clump : trial.world().clumps()) {
        const double half = trial.world().step() > 0 ? 0.5 * trial.kernel().state().time.previous_dt : 0;
        const Vec3 p = clump.mass * clump.velocity + half * clump.force;
        linear += p, angular += clump.centre.cross(p) + clump.momentum + half * clump.moment;
        kinetic += kinetic_energy_of(clump, half);
      }
      return kinetic;
    };
    Vec3 linear, angular, linear_after, angular_after;
    const double energy = momenta(linear, angular);
    bool touched = false;
    for (int k = 0; k < 400; ++k) trial.step(500), touched |= !trial.world().contacts().empty();
    ASSERT_TRUE(touched && trial.world().contacts().empty());
    const double after = momenta(linear_after, angular_after);
    EXPECT_LT((linear_after - linear).norm(), 1e-12 * linear.norm());
    // Forces and arms are at the same instant: also to round-off.
    EXPECT_LT((angular_after - angular).norm(), 1e-9 * angular.norm());
    verify("kinetic energy after an undamped oblique hit of two clumps, " + law, after / energy, 1, 1e-4);
  }
}

/// Spheres of a clump that crosses a side of a deforming cell are moved back one by one.
TEST(ClumpMotion, IsTheSameAcrossThePeriodicSides) {
  Description d =
      description("linear-rolling", stuff,
                  {{{9.9e-3, 0.1e-3, 5e-3}, 1e-3, {2, -3, 1}, {300, 500, -200}}, {{5e-3, 5e-3, 5e-3}, 1e-3}});
  make_clumps(d, boomerang());
  d["domain"] = {
      {"low", {0, 0, 0}}, {"high", {0.01, 0.01, 0.01}}, {"periodic", {true, true, true}}, {"strain_rate", {-5, 4, 3}}};
  d["time_step"]["value"] = 1e-6;
  Trial trial(d);
  const auto apart = [&] {
    Vec3 away = trial.position(0) - trial.position(1);
    const Cell& cell = trial.world().cell();
    for (int k = 0; k < 3; ++k)
      away[k] -= std::round(away[k] / (cell.high[k] - cell.low[k])) * (cell.high[k] - cell.low[k]);
    return away.norm();
  };
  const double a = apart();
  // A neighbour search may change the order of clumps.
  const auto first_centre = [&] { return std::ranges::find(trial.world().clumps(), 0u, &ClumpView::id)->centre; };
  const Vec3 centre = first_centre();
  for (int round = 0; round < 20; ++round) {
    trial.kernel().request_rebuild();
    trial.step(500);
    ASSERT_NEAR(apart(), a, 1e-14);
    ASSERT_EQ(trial.kernel().state().pairs.touching_count(), 0u) << "a clump does not meet itself";
  }
  // After a neighbour search moved them back, they stay there.
  trial.kernel().request_rebuild();
  trial.step(2);
  const Cell& cell = trial.world().cell();
  const double way = 2e-5;
  for (std::uint32_t id = 0; id < 6; ++id)
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(trial.position(id)[k], cell.low[k] - way);
      EXPECT_LT(trial.position(id)[k], cell.high[k] + way);
    }
  std::vector<Vec3> before;
  for (std::uint32_t id = 0; id < 6; ++id) before.push_back(trial.position(id));
  trial.step();
  for (std::uint32_t id = 0; id < 6; ++id) {
    const Vec3 velocity = xyz(trial.world().velocities()[index_of(trial.world(), id)]);
    EXPECT_LT((trial.position(id) - before[id] - 1e-6 * velocity).norm(), 1e-15) << id;
  }
  EXPECT_GT((first_centre() - centre).norm(), 1e-3);
}

}  // namespace
}  // namespace grit::test::motion_tests
