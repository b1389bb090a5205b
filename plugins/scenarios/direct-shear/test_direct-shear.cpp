#include "direct-shear.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/testing/scenario.hpp"

namespace grit {
namespace {

INSTANTIATE_TEST_SUITE_P(DirectShear, ScenarioContract,
                         testing::Values(ScenarioCase{"defaults", make_scenario<DirectShear>}), scenario_case_name);

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::unique_ptr<DirectShear> made(const Description& keys = Description::object()) {
  return made_scenario<DirectShear>(keys);
}

TEST(DirectShear, ExpandsToTheGoldenDescription) { expect_golden(made()->expand(), "direct-shear"); }

TEST(DirectShear, RefusesVoidRatiosOutOfRangeAndReportsTheRange) {
  const VoidRatioRange range = made()->reachable();
  for (const double wish : {range.densest - 0.001, range.loosest + 0.001}) {
    const std::string text = refusal<DirectShear>({{"void_ratio", wish}, {"normal_stress", "100 kPa"}});
    EXPECT_THAT(text, StartsWith("void_ratio: found 0."));
    EXPECT_THAT(text, HasSubstr("between 0.534 "));
    EXPECT_THAT(text, HasSubstr("and 0.79"));
    EXPECT_THAT(text, HasSubstr("100 kPa"));
  }
  EXPECT_EQ(refusal<DirectShear>({{"void_ratio", range.densest}}), "");
  EXPECT_EQ(refusal<DirectShear>({{"void_ratio", range.loosest}}), "");
}

TEST(DirectShear, IsDenserInALargerBox) {
  const Description small = {{"width", "15 mm"}, {"height", "10 mm"}, {"depth", "3 mm"}};
  EXPECT_NEAR(made(small)->reachable().densest, 0.560, 0.005) << "mean of two such specimens";
  Description periodic = small;
  periodic["depth_boundary"] = "periodic";
  EXPECT_NEAR(made(periodic)->reachable().densest, 0.528, 0.005);
  EXPECT_NEAR(made({{"width", "1 m"}, {"height", "1 m"}, {"depth", "1 m"}})->reachable().densest, 0.519, 0.001);
}

TEST(DirectShear, RefusesABoxTooSmallForItsGrains) {
  const auto problem = problems_of<DirectShear>;
  EXPECT_THAT(problem({{"depth", "2.9 mm"}, {"width", "1 mm"}}),
              AllOf(HasSubstr("/width found 0.001 m; allowed is at least 4 of the largest grains, 0.003 m"),
                    HasSubstr("/depth found 0.0029 m")));
  EXPECT_EQ(problem({{"depth", "3 mm"}}), "");
}

TEST(DirectShear, RefusesASmallestGrainAboveTheLargest) {
  const auto result = read_scenario<DirectShear>({{"smallest_diameter", "1 mm"}});
  ASSERT_EQ(result.problems.size(), 1u);
  EXPECT_EQ(result.problems[0].pointer, "/smallest_diameter");
}

TEST(DirectShear, ShearsAtTheInertialNumberUnlessGivenAVelocity) {
  // I = (v / h) d sqrt(rho / sigma)
  const auto quasi_static = made({{"inertial_number", 1e-4}, {"normal_stress", "80 kPa"}});
  EXPECT_NEAR(quasi_static->shear_velocity() / 25e-3 * 0.5e-3 * std::sqrt(2600 / 80e3), 1e-4, 1e-16);
  EXPECT_EQ(made({{"velocity", "3 mm/s"}})->shear_velocity(), 3e-3);
}

TEST(DirectShear, FillsTheBoxAtTheTargetVoidRatio) {
  double volume = 0;  // mean volume of a grain, diameters uniform by number
  const int parts = 100000;
  for (int i = 0; i < parts; ++i) {
    const double d = 0.25e-3 + 0.5e-3 * (i + 0.5) / parts;
    volume += std::numbers::pi / 6 * d * d * d / parts;
  }
  const double solids = 60e-3 * 25e-3 * 5e-3 / 1.7;
  EXPECT_NEAR(made({{"void_ratio", 0.7}})->expand()["bodies"]["sand"]["source"]["count"].get<double>(), solids / volume,
              1);
}

TEST(DirectShear, LeavesAGapOfTheLargestGrainAtMidHeight) {
  const Description d = made()->expand();
  for (const char* side : {"left", "right"}) {
    const double low = d["walls"]["lower-" + std::string(side)]["high"][2],
                 high = d["walls"]["upper-" + std::string(side)]["low"][2];
    EXPECT_NEAR(high - low, 0.75e-3, 1e-15);
    EXPECT_NEAR(0.5 * (high + low), 12.5e-3, 1e-15);
  }
}

TEST(DirectShear, MovesTheUpperFrameVerticallyWithThePlaten) {
  const auto scenario = made();
  const Description stages = scenario->expand()["stages"];
  const Description& walls = stages.back()["change"]["walls"];
  EXPECT_EQ(walls.size(), 4u);
  for (const auto& [name, wall] : walls.items()) {
    EXPECT_DOUBLE_EQ(wall["motion"]["velocity"][0], scenario->shear_velocity()) << name;
    EXPECT_EQ(wall["motion"].contains("follow"), name != "platen") << name;
  }
}

TEST(DirectShear, RaisesTheSpeedLimitOfThePlatenForFastShear) {
  const Description keys = {{"inertial_number", 1e-2}, {"preparation_inertial_number", 1e-3}};
  const auto scenario = made(keys);
  const Description platen = scenario->expand()["stages"].back()["change"]["walls"]["platen"];
  EXPECT_DOUBLE_EQ(platen["motion"]["servo"]["max_velocity"], 2 * scenario->shear_velocity());
  EXPECT_FALSE(made()->expand()["stages"].back()["change"]["walls"]["platen"]["motion"].contains("servo"));
}

TEST(DirectShear, HasNoFrontAndBackIfPeriodic) {
  const Description d = made({{"depth_boundary", "periodic"}})->expand();
  EXPECT_FALSE(d["walls"].contains("front") || d["walls"].contains("back"));
  EXPECT_EQ(d["domain"]["periodic"], Description({false, true, false}));
  EXPECT_EQ(d["domain"]["high"][1].get<double>() - d["domain"]["low"][1].get<double>(), 5e-3);
  EXPECT_EQ(d["specimen"]["low"][1], "");
}

}  // namespace
}  // namespace grit
