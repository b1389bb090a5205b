// Two materials, one far stiffer or heavier than the other: the largest stable step, found from both sides, compared
// with the critical step of grit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/growth.hpp"
#include "support/mapped.hpp"

namespace grit::test::ratios_tests {
namespace {

constexpr double radius = 1e-3, density = 2500, modulus = 1e8, shear_ratio = 0.3;
constexpr double squeeze = 1e-3, trembling = 1e-9;  // of the radius; of the squeeze
const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius;

Description material(double stiffer, double heavier) {
  return {{"density", density * heavier},
          {"contact_modulus", modulus * stiffer},
          {"friction_angle", "60 deg"},
          {"shear_to_normal_stiffness", shear_ratio}};
}

/// A simple cubic lattice of two alternating materials; each grain moves against all of its neighbours along x, as in
/// the fastest mode.
Description chequered(double stiffer, double heavier) {
  constexpr int sides = 4;
  constexpr double spacing = 2 * radius * (1 - squeeze);
  const double speed = trembling * squeeze * radius * std::sqrt(modulus * radius / mass);
  std::vector<Grain> grains[2];
  for (int x = 0; x < sides; ++x)
    for (int y = 0; y < sides; ++y)
      for (int z = 0; z < sides; ++z) {
        const int odd = (x + y + z) % 2;
        grains[odd].push_back(
            {spacing * Vec3(x + 0.5, y + 0.5, z + 0.5), radius, {odd == 0 ? speed : -speed / heavier, 0, 0}});
      }
  Description d = description("linear-frictional", material(1, 1), grains[0]);
  Description others = description("linear-frictional", {}, grains[1])["bodies"]["grains"];
  others["material"] = "other";
  d["bodies"]["others"] = others;
  d["materials"]["other"] = material(stiffer, heavier);
  d["domain"] = {
      {"low", {0, 0, 0}}, {"high", vector(Vec3::Constant(sides * spacing))}, {"periodic", {true, true, true}}};
  return d;
}

/// Two of the six contacts are compressed, four sheared; springs in series.
double limit_of_chequered(double stiffer, double heavier) {
  const double stiffness = 2 * modulus * radius * stiffer / (1 + stiffer);
  return 2 / std::sqrt((2 + 4 * shear_ratio) * stiffness / mass * (1 + 1 / heavier));
}

const std::vector<double>& ratios() {
  static const std::vector<double> all{1, 10, 100, 1e3, 1e4, 1e5, 1e6};
  return all;
}

/// Finds the limit at `ratio` and records it with the prediction and the critical step of grit; no step that grit
/// allows is unstable. Returns the critical step of grit over the limit found.
double expect_bound(const std::string& name, double ratio, const Description& d, double predicted) {
  SCOPED_TRACE(name + " 1 : " + std::to_string(ratio));
  const double found = found_limit(d, predicted), said = critical(d);
  EXPECT_NEAR(found / predicted, 1, 5e-3);
  EXPECT_LE(said, 1.002 * found);
  EXPECT_LT(growth(d, 0.99 * said, 4000), 20);
  const auto& map = "critical step over the longest stable one|ratio of the two materials";
  map_point(map, name, ratio, said / found);
  return said / found;
}

TEST(Ratios, HeavierGrainsAmongLightOnes) {
  double least = 1;
  for (const double ratio : ratios())
    least = std::min(least, expect_bound("heavier", ratio, chequered(1, ratio), limit_of_chequered(1, ratio)));
  EXPECT_GT(least, 0.7) << "not much shorter than necessary";
  figure("bound over the longest stable step, of heavier grains among light ones, at least", least);
}

TEST(Ratios, StifferGrainsAmongSoftOnes) {
  // Two stiff grains may meet: the step is also stable for them.
  for (const double ratio : ratios()) {
    const Description d = chequered(ratio, 1);
    const double share = expect_bound("stiffer", ratio, d, limit_of_chequered(ratio, 1));
    if (ratio == 1e4) figure("bound over the longest stable step, of grains 1e4 times as stiff among others", share);
    const double meeting = 2 / std::sqrt(2 * std::max(1.0, 3.5 * shear_ratio) * ratio * modulus * radius / mass);
    EXPECT_GE(critical(d), 0.99 * std::min(meeting, 0.7 * limit_of_chequered(ratio, 1)));
  }
}

TEST(Ratios, StifferAndHeavierGrainsAmongOthers) {
  for (const double ratio : ratios())
    expect_bound("stiffer and heavier", ratio, chequered(ratio, ratio), limit_of_chequered(ratio, ratio));
}

/// A grain between two plates of a stiffer material.
Description between_plates(const std::string& law, double ratio) {
  const bool hertz = law == "hertz-mindlin";
  const auto solid = [&](double stiffer) {
    Description m = material(stiffer, 1);
    m["friction_angle"] = 0;
    if (!hertz) return m;
    m.erase("contact_modulus"), m.erase("shear_to_normal_stiffness");
    m["young_modulus"] = modulus * stiffer, m["poisson_ratio"] = 0.25;
    return m;
  };
  const double speed = trembling * squeeze * radius * std::sqrt(modulus * radius / mass);
  Description d = description(law, solid(1), {{Vec3::Zero(), radius, {0, 0, speed}}});
  d["materials"]["plate"] = solid(ratio);
  for (const double side : {-1.0, 1.0})
    d["walls"][side < 0 ? "low" : "high"] =
        plane({0, 0, side * (1 - squeeze) * radius}, -side * Vec3::UnitZ(), "plate");
  return d;
}

TEST(Ratios, SoftGrainBetweenStiffPlates) {
  double least = 1;
  for (const std::string law : {"linear-frictional", "hertz-mindlin"})
    for (const double ratio : ratios()) {
      // Linear springs have the stiffness of the grain for any plate; for Hertz, compliances add up.
      const double reduced = modulus / (1 - 0.25 * 0.25) / (1 + 1 / ratio);
      const double spring =
          law == "hertz-mindlin" ? 2 * reduced * std::sqrt(radius * squeeze * radius) : modulus * radius;
      const Description d = between_plates(law, ratio);
      const double limit = 2 / std::sqrt(2 * spring / mass);
      least = std::min(least, expect_bound("grain between stiffer plates, " + law, ratio, d, limit));
    }
  EXPECT_GT(least, 0.99) << "not much shorter than necessary";
  figure("bound over the longest stable step, of a grain between stiffer plates, at least", least);
}

}  // namespace
}  // namespace grit::test::ratios_tests
