#include "interface-shear.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/testing/scenario.hpp"

namespace grit {
namespace {

INSTANTIATE_TEST_SUITE_P(InterfaceShear, ScenarioContract,
                         testing::Values(ScenarioCase{"defaults", make_scenario<InterfaceShear>}), scenario_case_name);

using testing::HasSubstr;

std::unique_ptr<InterfaceShear> made(const Description& keys = Description::object()) {
  return made_scenario<InterfaceShear>(keys);
}
Description surface(const Description& keys) { return made(keys)->expand()["walls"]["surface"]; }
double count(const Description& keys) { return made(keys)->expand()["bodies"]["sand"]["source"]["count"]; }

TEST(InterfaceShear, ExpandsToTheGoldenDescription) { expect_golden(made()->expand(), "interface-shear"); }

TEST(InterfaceShear, HasGroovesOfTheDepthGivenByTheRoughness) {
  const Description d = surface({{"roughness", 0.25}});
  EXPECT_EQ(d["type"], "saw-tooth");
  EXPECT_DOUBLE_EQ(d["depth"], 0.25 * 0.5e-3);
  EXPECT_FALSE(d.contains("spacing"));
  EXPECT_DOUBLE_EQ(d["inclination"], 45 * degree);
}

TEST(InterfaceShear, FitsGroovesToTheirSpacingOrLeavesFlatsBetweenSteeperOnes) {
  const Description beside = surface({{"roughness", 0.25}, {"groove_spacing", "1 mm"}});
  EXPECT_NEAR(beside["inclination"], std::atan(0.25), 1e-15);
  EXPECT_FALSE(beside.contains("spacing"));
  const Description apart =
      surface({{"roughness", 0.25}, {"groove_spacing", "2 mm"}, {"groove_inclination", "45 deg"}});
  EXPECT_DOUBLE_EQ(apart["inclination"], 45 * degree);
  EXPECT_DOUBLE_EQ(apart["spacing"], 2e-3);
}

TEST(InterfaceShear, HasWavesOfTheDepthGivenByTheirLength) {
  const Description d = surface({{"surface", "sinusoidal"}, {"depth_over_wavelength", 0.147}, {"wavelength", "15 mm"}});
  EXPECT_EQ(d["type"], "sinusoidal");
  EXPECT_DOUBLE_EQ(d["depth"], 0.147 * 15e-3);
  EXPECT_DOUBLE_EQ(d["wavelength"], 15e-3);
}

TEST(InterfaceShear, AcceptsWavesWithoutDepth) {
  const Description flat = {{"surface", "sinusoidal"}, {"depth_over_wavelength", 0}};
  EXPECT_EQ(surface(flat)["depth"], 0.0);
  EXPECT_EQ(count(flat), count({{"surface", "flat"}}));
}

TEST(InterfaceShear, UsesARectangleForAFlatSurface) {
  const Description d = surface({{"surface", "flat"}});
  EXPECT_EQ(d["type"], "rectangle");
  EXPECT_FALSE(d.contains("depth"));
}

TEST(InterfaceShear, StartsTheBoxAtATipOfALongEnoughSurface) {
  for (const char* form : {"flat", "saw-tooth", "sinusoidal"}) {
    const Description d = made({{"surface", form}, {"wavelength", "15 mm"}})->expand();
    const Description& s = d["walls"]["surface"];
    const double begin = s["corner"][0], end = begin + s["edge_a"][0].get<double>();
    const double spacing = std::string(form) == "saw-tooth" ? 2 * 0.5e-3 : 15e-3;
    if (std::string(form) != "flat") EXPECT_NEAR(std::remainder(begin, spacing), 0, 1e-12) << form;
    EXPECT_LT(begin, d["walls"]["left"]["low"][0].get<double>()) << form;
    EXPECT_GT(end, d["walls"]["right"]["high"][0].get<double>() + 7e-3) << form;
  }
}

TEST(InterfaceShear, FillsTheGroovesToo) {
  // Grooves side by side take half of the volume down to their depth; so do waves.
  const double flat = count({{"surface", "flat"}}), height = 20e-3;
  EXPECT_NEAR(count({{"roughness", 2}}) / flat, (height + 0.5 * 1e-3) / height, 1e-4);
  EXPECT_NEAR(count({{"surface", "sinusoidal"}, {"depth_over_wavelength", 0.4}}) / flat, (height + 3e-3) / height,
              1e-4);
  // One groove of 45 degrees, 1 mm deep, per 4 mm.
  EXPECT_NEAR(count({{"roughness", 2}, {"groove_spacing", "4 mm"}, {"groove_inclination", "45 deg"}}) / flat,
              (height + 0.25e-3) / height, 1e-4);
}

TEST(InterfaceShear, StandsOnTheTipsDuringPreparationAndIsLiftedByTheLargestGrain) {
  const Description d = made()->expand();
  for (const char* side : {"left", "right"}) EXPECT_EQ(d["walls"][side]["low"][2], 0.0);
  const Description& lift = d["stages"][3];
  EXPECT_EQ(lift["until"]["value"], 0.75e-3);
  EXPECT_EQ(made({{"gap", "0.4 mm"}})->expand()["stages"][3]["until"]["value"], 0.4e-3);
}

TEST(InterfaceShear, DrivesTheBoxAsOneAtTheInertialNumber) {
  const auto scenario = made({{"inertial_number", 1e-4}});
  // I = (v / h) d sqrt(rho / sigma)
  EXPECT_NEAR(scenario->shear_velocity() / 20e-3 * 0.5e-3 * std::sqrt(2600 / 100e3), 1e-4, 1e-16);
  const Description stages = scenario->expand()["stages"];
  const Description& walls = stages.back()["change"]["walls"];
  ASSERT_EQ(walls.size(), 3u);
  for (const auto& [name, wall] : walls.items())
    EXPECT_DOUBLE_EQ(wall["motion"]["velocity"][0], scenario->shear_velocity()) << name;
}

TEST(InterfaceShear, RaisesTheSpeedLimitOfTheLidForFastShear) {
  const auto fastest = [](double inertial_number) {
    const auto scenario = made({{"inertial_number", inertial_number}, {"preparation_inertial_number", 1e-3}});
    const Description d = scenario->expand();
    const Description& shear = d["stages"].back()["change"]["walls"]["lid"]["motion"];
    const Description& servo = shear.contains("servo") ? shear["servo"] : d["walls"]["lid"]["motion"]["servo"];
    return servo["max_velocity"].get<double>() / scenario->shear_velocity();
  };
  EXPECT_NEAR(fastest(1e-2), 2, 1e-12);
  EXPECT_NEAR(fastest(1e-4), 10, 1e-12) << "its speed during compaction";
}

TEST(InterfaceShear, AddsWallFrictionOfEN1991AsReference) {
  EXPECT_FALSE(made()->expand()["output"].contains("references"));
  const auto value = [](const Description& keys, const char* name, const char* of) -> double {
    Description all = {{"internal_friction_angle", "44 deg"}, {"surface_friction_angle", "16 deg"}};
    all.update(keys);
    const Description reference = made(all)->expand()["output"]["references"][name];
    EXPECT_EQ(reference["of"], of);
    return reference["value"];
  };
  const Description waves = {{"surface", "sinusoidal"}}, even = {{"surface", "flat"}};
  const double friction = 0.2 * std::tan(16 * degree) + 0.8 * std::tan(44 * degree);
  EXPECT_NEAR(value(waves, "EN_1991-4_effective_wall_friction", "test/stress_ratio"), friction, 1e-12);
  EXPECT_NEAR(value(waves, "EN_1991-4_effective_wall_friction_angle", "test/friction_angle"),
              std::atan(friction) / degree, 1e-12);
  EXPECT_EQ(value(waves, "EN_1991-4_wall_contact_factor", "test/wall_contact_factor"), 0.2);
  EXPECT_NEAR(value(even, "EN_1991-4_effective_wall_friction", "test/stress_ratio"), std::tan(16 * degree), 1e-12);
  EXPECT_EQ(value(even, "EN_1991-4_wall_contact_factor", "test/wall_contact_factor"), 1);
}

TEST(InterfaceShear, ReportsInvalidParameters) {
  const auto problem = problems_of<InterfaceShear>;
  const auto spaced = [](const char* spacing, const char* form = "saw-tooth") {
    return Description{{"groove_spacing", spacing}, {"groove_inclination", "45 deg"}, {"surface", form}};
  };
  EXPECT_THAT(problem(spaced("0.9 mm")), HasSubstr("/groove_spacing"));
  EXPECT_EQ(problem(spaced("1 mm")), "") << "as wide as the groove, within rounding";
  const std::string narrow = problem(spaced("0.9999999 mm"));
  EXPECT_THAT(narrow, HasSubstr("0.0009999999 m"));
  EXPECT_THAT(narrow, HasSubstr("at least the width of a groove, 0.001 m"));
  EXPECT_EQ(problem(spaced("0.9 mm", "sinusoidal")), "");
  EXPECT_THAT(problem({{"groove_spacing", 0}}), HasSubstr("/groove_spacing"));
  EXPECT_THAT(problem({{"roughness", 0}}), HasSubstr("/roughness"));
  EXPECT_THAT(
      problem(spaced("0.11 m")),
      HasSubstr("/groove_spacing found grooves 0.11 m apart; allowed is at most the length of the wall, 0.1 m"));
  EXPECT_THAT(problem({{"roughness", 101}}), HasSubstr("/roughness found grooves 0.101 m apart"));
  EXPECT_EQ(problem({{"roughness", 100}, {"groove_spacing", "100 mm"}}), "");
  EXPECT_EQ(problem({{"roughness", 101}, {"surface", "flat"}}), "");
  EXPECT_THAT(problem({{"surface_friction_angle", "19 deg"}}),
              HasSubstr("/surface_friction_angle found 19 deg; allowed is at most friction_angle, 18 deg"));
  EXPECT_EQ(problem({{"surface_friction_angle", "19 deg"}, {"friction_angle", "19 deg"}}), "");
  EXPECT_THAT(problem({{"gap", "20 mm"}}), HasSubstr("/gap found 0.02 m"));
  EXPECT_EQ(problem({{"gap", "19 mm"}}), "");
  EXPECT_THAT(problem({{"void_ratio", 0.1}, {"grain_shape", "clump"}}), HasSubstr("/void_ratio"));
  EXPECT_THAT(problem({{"surface", "sawtooth"}}), HasSubstr("saw-tooth"));
  EXPECT_THAT(refusal<InterfaceShear>({{"void_ratio", 0.9}}), HasSubstr("void_ratio: found 0.9; allowed is between "));
  EXPECT_THAT(problem({{"depth", "2.9 mm"}}), HasSubstr("/depth found 0.0029 m; allowed is at least 4 of the largest"));
}

}  // namespace
}  // namespace grit
