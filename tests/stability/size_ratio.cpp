// Impact of a small grain on a large one: no sticking and no gain of energy at any size ratio.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "support/mapped.hpp"
#include "support/scene.hpp"

namespace grit::test::size_ratio_tests {
namespace {

constexpr double large = 10e-3, speed = 0.1;

struct Outcome {
  double energy;   ///< after over before
  double rebound;  ///< normal speed of separation over that of approach
};

/// The small grain hits the large one at an angle to the line of centres; both rotate freely. Uses the default step
/// unless `safety` is given; the initial gap is a fraction `away` of the displacement in a step.
Outcome collide(const std::string& law, double ratio, double angle, std::optional<double> safety = {},
                double away = 0) {
  const double small = large / ratio;
  const Vec3 touching(large + small, 0, 0), velocity = speed * Vec3(-std::cos(angle), std::sin(angle), 0);
  Description material{{"density", 2500}, {"friction_angle", 0.5}};
  if (law == "hertz-mindlin") material["young_modulus"] = 1e8;
  else material["contact_modulus"] = 1e7;
  Description d = description(law, material, {{Vec3::Zero(), large}, {touching, small, velocity}});
  if (safety) d["time_step"]["safety"] = *safety;
  d["guards"] = {{"energy", 1e9}, {"travel", 1}, {"overlap", 1}};
  const Vec3 apart = touching - away * Trial(d).world().dt() * velocity;
  d["bodies"]["grains"]["source"]["bodies"][1]["position"] = vector(apart);
  Trial t(d);
  const auto energy = [&] {
    double sum = 0;
    for (const std::uint32_t body : {0u, 1u}) {
      const double r = body == 0 ? large : small;
      sum += 0.5 * t.mass(body) * (t.velocity(body).squaredNorm() + 0.4 * r * r * t.spin(body).squaredNorm());
    }
    return sum;
  };
  const double before = energy();
  bool touched = false;
  for (int step = 0; step < 1000000; ++step) {
    t.step();
    const bool contacts = !t.world().contacts().empty();
    if (touched && !contacts) break;
    touched |= contacts;
  }
  const Vec3 normal = (t.position(1) - t.position(0)).normalized();
  return {energy() / before, (t.velocity(1) - t.velocity(0)).dot(normal) / (speed * std::cos(angle))};
}

class SizeRatio : public testing::TestWithParam<std::string> {};

TEST_P(SizeRatio, NeitherMakesGrainsStickNorGainEnergy) {
  double worst = 0, most_gained = 0;
  for (const double ratio : {1.0, 3.0, 10.0, 30.0, 100.0}) {
    double most = 0, least_rebound = 1e9, most_usual = 0, most_energy = 0;
    for (double angle = 0.05; angle < 1.2; angle += 0.2) {
      const Outcome fine = collide(GetParam(), ratio, angle, 0.02);
      EXPECT_LT(fine.energy, 1 + 2e-3) << "ratio " << ratio << ", angle " << angle;
      EXPECT_NEAR(fine.rebound, 1, 2e-2) << "ratio " << ratio << ", angle " << angle;
      const Outcome coarse = collide(GetParam(), ratio, angle, 0.2);
      most = std::max(most, std::abs(coarse.rebound - 1));
      least_rebound = std::min(least_rebound, coarse.rebound);
      for (const double share : {0.0, 0.2, 0.4, 0.6, 0.8}) {
        const Outcome usual = collide(GetParam(), ratio, angle, {}, share);
        most_usual = std::max(most_usual, std::abs(usual.rebound - 1));
        most_energy = std::max(most_energy, usual.energy);
      }
    }
    EXPECT_GT(least_rebound, 0.5) << "ratio " << ratio << ": it sticks";
    worst = std::max(worst, most_usual), most_gained = std::max(most_gained, most_energy - 1);
    // (π/7)²/4: maximum relative gain in an impact of seven steps.
    EXPECT_LT(most_usual, 0.05) << "ratio " << ratio;
    EXPECT_LT(most_energy, 1.05) << "ratio " << ratio;
    map_point("error of the rebound at a fifth of the critical step|ratio of sizes", GetParam(), ratio, most);
    map_point("error of the rebound at the step that grit chooses|ratio of sizes", GetParam(), ratio, most_usual);
    map_point("most that is left of the energy of two sizes at the step that grit chooses|ratio of sizes", GetParam(),
              ratio, most_energy);
  }
  figure("error of the rebound of two sizes at the chosen step", worst);
  figure("two sizes, most that an impact gains at the chosen step", most_gained);
}

INSTANTIATE_TEST_SUITE_P(All, SizeRatio, testing::Values("linear-frictional", "linear-rolling", "hertz-mindlin"));

}  // namespace
}  // namespace grit::test::size_ratio_tests
