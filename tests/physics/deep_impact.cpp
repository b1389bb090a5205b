// Oblique impacts of spheres that spin backwards and overlap by 6 % of a radius: elastic springs keep energy, apart
// from what friction takes, and angular momentum.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "energy_balance.hpp"
#include "support/order.hpp"
#include "support/rebound.hpp"
#include "support/verified.hpp"

namespace grit::test::deep_impact_tests {
namespace {

using energy_balance_tests::density;
using energy_balance_tests::Kept;
using energy_balance_tests::radius;
using std::numbers::pi;

constexpr double modulus = 1e7, degrees = 60, friction = 1.5;

/// A sphere of radius `radius` below one of this radius.
struct Impact {
  double other;
  double mass_of(double r) const { return density * 4 / 3 * pi * r * r * r; }
  double below = mass_of(radius), above = mass_of(other);
  double stiffness = 2 * modulus * radius * other / (radius + other);
  double turn = std::sqrt(stiffness * (1 / below + 1 / above));  ///< rate of the normal spring [rad/s]
  double duration = pi / turn;
  Vec3 in = aslant(0.0625 * radius * turn / std::cos(degrees * pi / 180), degrees);  ///< of above relative to below

  /// They meet `phase` of a step after the start. The spins double the initial slip of the surfaces of equal spheres.
  Description scene(const std::string& law, double dt, double phase) const {
    const double share = below / (below + above), spin = -0.5 * in.x() / radius;
    Description material{{"density", density}, {"contact_modulus", modulus}, {"friction_angle", std::atan(friction)}};
    if (law == "linear-rolling") material["rolling_limit"] = 0;
    Description d = description(law, material,
                                {{Vec3::Zero(), radius, (share - 1) * in, {0, spin, 0}},
                                 {{0, 0, radius + other - phase * dt * in.z()}, other, share * in, {0, spin, 0}}});
    d["time_step"]["value"] = dt;
    return d;
  }
};

/// Along y, about the origin.
double angular_momentum(const World& world) {
  double sum = 0;
  for (std::size_t i = 0; i < world.positions().size(); ++i) {
    const Row &v = world.velocities()[i], &w = world.spins()[i];
    sum += xyz(world.positions()[i]).cross(xyz(v)).y() / v.w + w.y / w.w;
  }
  return sum;
}

struct Change {
  double energy, angular;  ///< of energy including friction, and of angular momentum, over those at the start
  double overlap;          ///< maximum, over the radius of the sphere below
};
Change hit(const Description& d) {
  Kept t(d);
  const double before = t.world().energies().kinetic, turning = angular_momentum(t.world());
  Change change{};
  bool touched = false;
  for (bool touches = false; !touched || touches; touched = touched || touches) {
    t.step();
    const auto contacts = t.world().contacts();
    touches = !contacts.empty();
    if (touches) change.overlap = std::max(change.overlap, contacts.front().overlap / radius);
  }
  const Energies after = t.world().energies();
  EXPECT_EQ(after.elastic(), 0) << "they are separated";
  EXPECT_NEAR(after.closure_error, after.kinetic + after.friction - before, 1e-12 * before);
  change.energy = (after.kinetic + after.friction) / before - 1;
  change.angular = angular_momentum(t.world()) / turning - 1;
  return change;
}

TEST(DeepImpact, KeepsEnergyToSecondOrderInTheStepAndAngularMomentum) {
  for (const std::string law : {"linear-frictional", "linear-rolling"})
    for (const double ratio : {1.0, 2.0}) {
      const Impact impact{radius / ratio};
      const std::string of = law + (ratio == 1 ? ", equal spheres" : ", the other half as large");
      std::vector<double> steps, errors;
      Errors angular("angular momentum after a deep oblique impact, " + of + ", change over that before");
      double deepest = 0;
      for (const int parts : {400, 800, 1600}) {
        // The phase of first contact within a step is random: mean over several.
        double sum = 0;
        constexpr int phases = 8;
        for (int i = 0; i < phases; ++i) {
          const double dt = impact.duration / parts;
          const Change change = hit(impact.scene(law, dt, (i + 0.5) / phases));
          sum += std::abs(change.energy), angular.add(change.angular);
          deepest = std::max(deepest, change.overlap);
        }
        steps.push_back(impact.duration / parts), errors.push_back(sum / phases);
      }
      EXPECT_NEAR(deepest, 0.057, 0.002) << of;
      for (std::size_t k = 1; k < errors.size(); ++k) EXPECT_LT(errors[k], 0.4 * errors[k - 1]) << of;
      verify("order in the step of the error of energy in a deep oblique impact, " + of, order(steps, errors), 2, 0.1);
      verify("energy gained in a deep oblique impact at 1600 steps, " + of + ", over all", errors.back(), 0, 1e-5, 1);
      angular.verify(1e-12);
    }
}

}  // namespace
}  // namespace grit::test::deep_impact_tests
