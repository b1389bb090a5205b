// Error of a collision as a function of the time step, for each law, up to the critical step.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/mapped.hpp"
#include "support/order.hpp"
#include "support/scene.hpp"

namespace grit::test::convergence_tests {
namespace {

constexpr double radius = 1e-3, density = 2500, speed = 0.1;

struct Law {
  std::string name, law;
  Description material;
  double order, error;  ///< minimum order from 0.2 to 0.0125 of the critical step; maximum error at the latter
  double predicted;     ///< predicted order in the straight part of the line
  double straight;      ///< the straight part, from this fraction of the critical step down to an eighth of it
};

// Second order if only springs act and sliding limits the shear force at first contact, which removes the error of the
// first partial step. Otherwise first order: a spring that sticks from first contact on is stretched for a whole step,
// dashpots use velocities that are half a step old, and Mindlin's spring has the stiffness of the end of the step. For
// κ = 2/7, where the shear spring oscillates with the duration of the contact, the excess elongation cancels: for κ =
// 0.3 little is left, which shows only at small steps.
const std::vector<Law>& laws() {
  static const std::vector<Law> all{
      {"linear-frictional",
       "linear-frictional",
       {{"contact_modulus", 1e7}, {"friction_angle", 0.4}},
       1.4,
       4e-4,
       1,
       0.0125},
      {"linear-frictional, slides at first",
       "linear-frictional",
       {{"contact_modulus", 1e7}, {"friction_angle", 0.06}},
       1.4,
       4e-4,
       2,
       0.1},
      {"linear-frictional, restitution 0.5",
       "linear-frictional",
       {{"contact_modulus", 1e7}, {"friction_angle", 0.4}, {"restitution", 0.5}},
       1.0,
       5e-3,
       1,
       0.05},
      {"linear-rolling", "linear-rolling", {{"contact_modulus", 1e7}, {"friction_angle", 0.4}}, 1.1, 4e-3, 1, 0.05},
      {"hertz-mindlin", "hertz-mindlin", {{"young_modulus", 1e8}, {"friction_angle", 0.4}}, 0.92, 6e-3, 1, 0.05},
      {"hertz-mindlin, restitution 0.5",
       "hertz-mindlin",
       {{"young_modulus", 1e8}, {"friction_angle", 0.4}, {"restitution", 0.5}},
       1.0,
       3e-3,
       1,
       0.05}};
  return all;
}

/// Velocities (over the speed) and spins (over speed per radius) after an oblique collision that slips and then sticks.
std::array<double, 12> after(const Law& law, double dt) {
  Description material = law.material;
  material["density"] = density;
  Description d =
      description(law.law, material,
                  {{Vec3::Zero(), radius, {speed, 0, 0}},
                   {{2.5001 * radius, 0.4 * radius, 0.3 * radius}, 1.5 * radius, {-speed, 0.2 * speed, 0}}});
  d["time_step"] = {{"value", dt}, {"allow_unstable", true}};
  d["guards"] = {{"energy", 1e9}, {"travel", 1}, {"overlap", 1}};
  Trial t(d);
  bool touched = false;
  for (int step = 0; step < 10000000; ++step) {
    t.step();
    const bool contacts = !t.world().contacts().empty();
    if (touched && !contacts) break;
    touched |= contacts;
  }
  std::array<double, 12> result{};
  for (int body = 0; body < 2; ++body)
    for (int k = 0; k < 3; ++k) {
      result[static_cast<std::size_t>(6 * body + k)] = t.velocity(static_cast<std::uint32_t>(body))[k] / speed;
      result[static_cast<std::size_t>(6 * body + 3 + k)] = t.spin(static_cast<std::uint32_t>(body))[k] * radius / speed;
    }
  return result;
}

double distance(const std::array<double, 12>& a, const std::array<double, 12>& b) {
  double square = 0;
  for (std::size_t k = 0; k < a.size(); ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(square);
}

class Convergence : public testing::TestWithParam<std::size_t> {};

TEST_P(Convergence, OfAnObliqueCollisionInTheTimeStep) {
  const Law& law = laws()[GetParam()];
  // Duration with the linear spring of this modulus; the Hertzian contact with the larger modulus takes about as long.
  const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius;
  const double critical = 2 / std::sqrt(1e7 * 1.2 * radius / mass * (1 + 1 / 3.375));
  const auto exact = after(law, critical / 20000);
  // The phase of first contact within a step is random: mean over several slightly different steps.
  const auto error = [&](double share) {
    double sum = 0;
    const int trials = 8;
    for (int i = 0; i < trials; ++i) sum += distance(after(law, share * (1 + 0.02 * i) * critical), exact);
    return sum / trials;
  };
  const auto& map = "error of an oblique collision over its speed|time step over the critical one";
  double coarse = 0, fine = 0;
  for (const double share : {0.8, 0.4, 0.2, 0.1, 0.05, 0.025, 0.0125}) {
    const double found = error(share);
    map_point(map, law.name, share, found);
    map_point(map, "predicted first order", share, share);
    map_point(map, "predicted second order", share, share * share);
    if (share == 0.2) coarse = found;
    if (share == 0.1) figure("error of an oblique collision at a tenth of the critical step, of its speed", found);
    fine = found;
  }
  const double least = std::log(coarse / fine) / std::log(0.2 / 0.0125);
  testing::Test::RecordProperty("order", std::to_string(least));
  EXPECT_GT(least, law.order);
  EXPECT_LT(fine, law.error);
  std::vector<double> shares, errors;
  for (const double part : {1.0, 0.5, 0.25, 0.125})
    shares.push_back(part * law.straight), errors.push_back(error(shares.back()));
  const double straight = order(shares, errors);
  for (std::size_t i = 0; i < errors.size(); ++i) map_point(map, law.name, shares[i], errors[i]);
  EXPECT_NEAR(straight, law.predicted, 0.2) << "by least squares";
  figure("order, " + law.name, straight);
}

INSTANTIATE_TEST_SUITE_P(All, Convergence, testing::Range(std::size_t{0}, laws().size()));

}  // namespace
}  // namespace grit::test::convergence_tests
