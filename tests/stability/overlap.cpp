// Two grains with an initial overlap: limits of refusal, of guards and of survival, and the energy released.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grit/error.hpp"
#include "support/mapped.hpp"
#include "support/scene.hpp"

namespace grit::test::overlap_tests {
namespace {

constexpr double radius = 1e-3, density = 2500, modulus = 1e7;
const double mass = density * 4 / 3 * std::numbers::pi * radius * radius * radius;

/// At rest, with an overlap of `overlap` radii.
Description inside(const std::string& law, double overlap, double safety) {
  Description m{{"density", density}, {"friction_angle", 0}};
  m[law == "hertz-mindlin" ? "young_modulus" : "contact_modulus"] = modulus;
  Description d = description(law, m, {{Vec3::Zero(), radius}, {Vec3((2 - overlap) * radius, 0, 0), radius}});
  d["time_step"] = {{"safety", safety}, {"steps_per_impact", 0}, {"max_displacement", 1}};
  return d;
}

/// The error before separation; empty if there was none.
std::string stopped(const Description& d) {
  try {
    Trial t(d);
    for (int i = 0; i < 1000000 && !t.world().contacts().empty(); ++i) t.step();
  } catch (const NumericsError& error) {
    return error.what();
  }
  return "";
}

/// The largest initial overlap, in radii, that a guard allows.
double deepest(const std::string& law, double safety) {
  double low = 1e-4, high = 1;
  while (high > 1.0002 * low) {
    const double middle = std::sqrt(low * high);
    (stopped(inside(law, middle, safety)).empty() ? low : high) = middle;
  }
  return low;
}

/// The same for a linear spring: in its fastest step each grain moves half of the change of overlap by leap-frog, of
/// which the travel guard allows 0.05 radii; the overlap guard allows 0.2.
double predicted_deepest(double safety) {
  const double square = 4 * safety * safety;  // (ω dt)²; the critical step is exact for two grains
  double overlap = 1, way = 0, fastest = 0;
  for (bool first = true; overlap > 0; first = false) {
    way += (first ? 0.5 : 1) * square * overlap;
    overlap -= way, fastest = std::max(fastest, 0.5 * way);
  }
  return std::min(0.2, 0.05 / fastest);
}

TEST(Overlap, DeepestStartThatSurvivesIsWhereTheGuardsSay) {
  const auto& map = "deepest overlap at the start that survives, in radii|time step over the critical one";
  for (const double safety : {0.8, 0.6, 0.4, 0.3, 0.25, 0.2, 0.1, 0.05}) {
    const double found = deepest("linear-frictional", safety), predicted = predicted_deepest(safety);
    EXPECT_NEAR(found / predicted, 1, 5e-4) << safety;
    map_point(map, "two grains, linear", safety, found);
    if (safety == 0.8) figure("deepest start that survives at 0.8 of the critical step, in radii", found);
    if (safety <= 0.25) figure("deepest start that survives at most, in radii", found);
    map_point(map, "predicted, linear", safety, predicted);
    map_point(map, "two grains, Hertz", safety, deepest("hertz-mindlin", safety));
  }
}

TEST(Overlap, BeyondTheGuardsLimitIsStoppedAtTheStart) {
  EXPECT_EQ(stopped(inside("linear-frictional", 0.1999, 0.05)), "");
  for (const double overlap : {0.2001, 1.0, 1.9, 2.0}) {
    const std::string said = stopped(inside("linear-frictional", overlap, 0.05));
    EXPECT_THAT(said, testing::StartsWith("step 0, time 0 s: body 0 at (0, 0, 0) m overlaps body 1 by ")) << overlap;
    EXPECT_THAT(said, testing::HasSubstr("place the bodies apart"));
  }
  EXPECT_THAT(stopped(inside("linear-frictional", 0.15, 0.8)), testing::HasSubstr("moves 0."));
}

TEST(Overlap, EnergyThatAppearsIsThatOfTheSpring) {
  const auto& map = "energy of flight after starting inside each other, of the largest spring energy|overlap, in radii";
  for (const std::string law : {"linear-frictional", "hertz-mindlin"})
    for (const double overlap : {1e-3, 1e-2, 0.05, 0.1, 0.2, 0.5, 1.0, 1.9}) {
      Description d = inside(law, overlap, 0.01);
      d["guards"] = {{"overlap", 1e9}, {"travel", 1e9}};
      Trial t(d);
      while (!t.world().contacts().empty()) t.step();
      const double flight = mass * t.velocity(1).squaredNorm(), way = overlap * radius;
      const double curved = 4.0 / 3 * modulus / (1 - 0.3 * 0.3) / 2 * std::sqrt(0.5 * radius);
      const bool hertz = law == "hertz-mindlin";
      const double spring = hertz ? 0.4 * curved * std::pow(way, 2.5) : 0.5 * modulus * radius * way * way;
      EXPECT_NEAR(flight / spring, 1, 2e-3) << law << ' ' << overlap;
      const double largest = hertz ? 0.4 * curved * std::pow(2 * radius, 2.5) : 2 * modulus * std::pow(radius, 3);
      map_point(map, law, overlap, flight / largest);
      map_point(map, "predicted, " + law, overlap, spring / largest);
    }
}

}  // namespace
}  // namespace grit::test::overlap_tests
