// Head-on and oblique collisions of two spheres: duration, energy, restitution, and order of the error in the time
// step.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/order.hpp"
#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::collision_tests {
namespace {

using std::numbers::pi;

constexpr double modulus = 1e8, radius_a = 1e-3, radius_b = 1.5e-3, density = 2500, speed = 1;
double mass(double radius) { return density * 4 / 3 * pi * radius * radius * radius; }

/// The spring of the linear law between both, and derived values.
struct Spring {
  double stiffness = 2 * modulus * radius_a * radius_b / (radius_a + radius_b);
  double reduced_mass = 1 / (1 / mass(radius_a) + 1 / mass(radius_b));
  double frequency = std::sqrt(stiffness / reduced_mass);
  double duration = pi / frequency;
};

/// Spheres with a gap that approach along x without net momentum, eccentric by `offset`.
Description pair(const std::string& law, Description material, double gap, double dt, double offset = 0) {
  material["density"] = density;
  const double share = mass(radius_b) / (mass(radius_a) + mass(radius_b));
  const double along = std::sqrt((radius_a + radius_b) * (radius_a + radius_b) - offset * offset) + gap;
  Description d = description(
      law, material,
      {{Vec3::Zero(), radius_a, {share * speed, 0, 0}}, {{along, offset, 0}, radius_b, {(share - 1) * speed, 0, 0}}});
  d["time_step"]["value"] = dt;
  return d;
}
Description smooth() { return {{"contact_modulus", modulus}, {"friction_angle", 0}, {"rolling_limit", 0}}; }

double overlap(const Trial& t) { return radius_a + radius_b - (t.position(1) - t.position(0)).norm(); }
double closing_speed(const Trial& t) { return (t.velocity(0) - t.velocity(1)).x(); }

struct Hit {
  double duration, overlap, force, speed;  ///< s; maxima [m], [N]; of separation [m/s]
  double last_inside, first_outside;       ///< overlaps of the steps before and after separation [m]
};

/// Runs from first contact, at time 0, until separation.
Hit collide(const Description& d) {
  Trial t(d);
  Hit hit{};
  do {
    hit.last_inside = overlap(t);
    t.step();
    hit.overlap = std::max(hit.overlap, overlap(t));
    if (!t.world().contacts().empty()) hit.force = std::max(hit.force, t.world().contacts().front().normal_force);
  } while (overlap(t) > 0);
  hit.first_outside = overlap(t);
  hit.speed = -closing_speed(t);
  hit.duration = t.world().time() + hit.first_outside / hit.speed;  // less the free flight since separation
  return hit;
}

TEST(Collision, LastsHalfAPeriodOfTheSpring) {
  const Spring spring;
  const Hit hit = collide(pair("linear-rolling", smooth(), 0, spring.duration / 400));
  // The leap-frog frequency is too high by (ω dt)²/24 = 2.57e-6; the end of the last step adds a term of third order.
  verify("duration of a linear collision [s]", hit.duration, spring.duration, 3e-6);
  verify("overlap of a linear collision [m]", hit.overlap, speed / spring.frequency, 1e-5);
  verify("force of a linear collision [N]", hit.force, speed * std::sqrt(spring.stiffness * spring.reduced_mass), 1e-5);
}

TEST(Collision, ErrorIsOfSecondOrderInTheStep) {
  const Spring spring;
  std::vector<double> steps, places, speeds;
  for (const int n : {20, 40, 80, 160, 320}) {
    Trial t(pair("linear-rolling", smooth(), 0, spring.duration / n));
    t.step(static_cast<std::size_t>(n * 6 / 10));
    const double phase = spring.frequency * t.world().time();
    steps.push_back(spring.duration / n);
    places.push_back(overlap(t) - speed / spring.frequency * std::sin(phase));
    speeds.push_back(closing_speed(t) - speed * std::cos(phase));
  }
  verify("order of the error of places in the time step", order(steps, places), 2, 0.0015);
  verify("order of the error of speeds in the time step", order(steps, speeds), 2, 0.0015);
}

TEST(Collision, EnergyComesBackButForThePartingStep) {
  // Leap-frog conserves the energy ½ m v² + ½ k x(t) x(t + dt) of a spring exactly; in the steps of first contact and
  // of separation this product is not zero, but at most (v dt/2)².
  const Spring spring;
  for (const double safety : {0.1, 0.01}) {
    Trial limits(pair("linear-rolling", smooth(), 0, 1e-9));
    const double dt = safety * limits.kernel().critical_time_step(), angle = spring.frequency * dt;
    double worst = 0;
    for (int i = 0; i < 25; ++i) {
      const double gap = i / 25.0 * speed * dt;
      const Hit hit = collide(pair("linear-rolling", smooth(), gap, dt));
      const double gain = hit.speed * hit.speed / (speed * speed) - 1;
      const double left = (speed * dt - gap) * gap, parted = -hit.last_inside * hit.first_outside;
      EXPECT_NEAR(gain, spring.frequency * spring.frequency / (speed * speed) * (parted - left), 1e-11) << gap;
      worst = std::max(worst, std::abs(gain));
    }
    EXPECT_LE(worst, angle * angle / 4);
    RecordProperty("energy_error_at_safety_" + std::to_string(safety), std::to_string(worst));
  }
}

TEST(Collision, EnergyIsKeptWhileTheyTouch) {
  const Spring spring;
  const double dt = spring.duration / 50, angle = spring.frequency * dt;
  const auto elastic = [](const Trial& t) {
    const double ratio = t.kernel().kinetic_energy_ratio();
    return std::isfinite(ratio) ? equilibrium(t.world()).kinetic_energy / ratio : 0.0;
  };
  const double energy = 0.5 * spring.reduced_mass * speed * speed;
  Trial straight(pair("linear-rolling", smooth(), 0, dt));
  double least = energy;
  for (int i = 0; i < 48; ++i) {
    straight.step();
    const double kinetic = equilibrium(straight.world()).kinetic_energy, stored = elastic(straight);
    least = std::min(least, kinetic);
    // At full steps the kinetic energy differs from the conserved one by exactly ⅛ (ω dt)² k x².
    EXPECT_NEAR(kinetic + stored - angle * angle / 4 * stored, energy, 1e-12 * energy) << i;
  }
  EXPECT_LT(least, 0.01 * energy) << "all of it went through the spring";

  Trial aslant(pair("linear-rolling", smooth(), 0, dt, 0.7 * (radius_a + radius_b)));
  for (int i = 0; i < 80; ++i) {
    aslant.step();
    EXPECT_NEAR(equilibrium(aslant.world()).kinetic_energy + elastic(aslant), energy, angle * angle / 4 * energy) << i;
  }
  EXPECT_EQ(aslant.spin(0).norm() + aslant.spin(1).norm(), 0) << "smooth spheres do not rotate";
}

struct Damped {
  const char* law;
  Description material;
  double duration;  ///< of the elastic collision, about [s]

  friend void PrintTo(const Damped& damped, std::ostream* out) { *out << damped.law; }
};
class Restitution : public testing::TestWithParam<Damped> {};

TEST_P(Restitution, OutIsIn) {
  const Damped& p = GetParam();
  for (const double e : {0.95, 0.8, 0.6, 0.4, 0.2, 0.1}) {
    Description material = p.material;
    material["friction_angle"] = 0, material["restitution"] = e;
    double error[2];
    for (const int halves : {0, 1}) {
      const double dt = p.duration / (4000 << halves);
      error[halves] = collide(pair(p.law, material, 0, dt)).speed / speed - e;
      // The dashpot uses the velocity of half a step ago: an error of first order, largest for the strongest dashpot.
      EXPECT_NEAR(error[halves], 0, 1e-4 / (1 << halves)) << e;

      Description floor = description(p.law, material, {{{0, 0, radius_a}, radius_a, {0, 0, -speed}}});
      floor["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
      floor["time_step"]["value"] = dt;
      Trial t(floor);
      do t.step();
      while (t.position(0).z() < radius_a);
      EXPECT_NEAR(t.velocity(0).z() / speed, e, 1e-4 / (1 << halves)) << e;
    }
    EXPECT_LT(std::abs(error[1]), 0.7 * std::abs(error[0])) << e;
  }
}
INSTANTIATE_TEST_SUITE_P(Collision, Restitution,
                         testing::Values(Damped{"linear-frictional", {{"contact_modulus", modulus}}, Spring().duration},
                                         Damped{"linear-rolling", {{"contact_modulus", modulus}}, Spring().duration},
                                         Damped{
                                             "hertz-mindlin", {{"young_modulus", 1e9}, {"poisson_ratio", 0.25}}, 3e-5}),
                         [](const auto& info) {
                           return std::string(info.index == 0 ? "Linear" : info.index == 1 ? "Rolling" : "Hertz");
                         });

}  // namespace
}  // namespace grit::test::collision_tests
