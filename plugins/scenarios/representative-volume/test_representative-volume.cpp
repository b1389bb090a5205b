#include "representative-volume.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/testing/scenario.hpp"

namespace grit {
namespace {

using testing::HasSubstr;

INSTANTIATE_TEST_SUITE_P(
    RepresentativeVolume, ScenarioContract,
    testing::Values(ScenarioCase{"defaults", make_scenario<RepresentativeVolume>},
                    ScenarioCase{"simple_shear", make_scenario<RepresentativeVolume>, {{"test", "simple-shear"}}}),
    scenario_case_name);

std::unique_ptr<RepresentativeVolume> made(const Description& keys = Description::object()) {
  return made_scenario<RepresentativeVolume>(keys);
}
std::string problem(const Description& keys) { return problems_of<RepresentativeVolume>(keys); }

TEST(RepresentativeVolume, ExpandsToTheGoldenDescription) { expect_golden(made()->expand(), "representative-volume"); }

TEST(RepresentativeVolume, CompressesACloudIsotropically) {
  const Description d = made({{"grains", 500}, {"confining_stress", "50 kPa"}})->expand();
  EXPECT_EQ(d["bodies"]["sand"]["source"]["count"], 500);
  for (const char* component : {"xx", "yy", "zz"}) EXPECT_EQ(d["domain"]["servo"]["stress"][component], 50e3);
  // Grains fill 0.3 of the cell. The mean of d³ of a uniform distribution: (a + b)(a² + b²) / 4.
  const double cube = 0.25 * 10e-3 * (2.5e-3 * 2.5e-3 + 7.5e-3 * 7.5e-3), side = d["domain"]["high"][0].get<double>();
  EXPECT_NEAR(500 * std::numbers::pi / 6 * cube / (side * side * side), 0.3, 1e-6);
  EXPECT_FALSE(d.contains("walls"));
}

TEST(RepresentativeVolume, TestsAtTheInertialNumber) {
  const Description keys = {{"inertial_number", 5e-4}, {"strain", 0.2}};
  const auto triaxial = made(keys);
  EXPECT_NEAR(triaxial->strain_rate() * 5e-3 * std::sqrt(2600 / 200e3), 5e-4, 1e-15);
  Description stage = triaxial->expand()["stages"].back();
  EXPECT_EQ(stage["change"]["domain"]["strain_rate"][2], -triaxial->strain_rate());
  EXPECT_EQ(stage["change"]["domain"]["servo"]["stress"], Description({{"zz", nullptr}})) << "lateral stress is kept";
  const double time = stage["until"]["value"];
  EXPECT_NEAR(1 - std::exp(-triaxial->strain_rate() * time), 0.2, 1e-12);

  Description sheared_keys = keys;
  sheared_keys["test"] = "simple-shear";
  const auto sheared = made(sheared_keys);
  stage = sheared->expand()["stages"].back();
  EXPECT_EQ(stage["change"]["domain"]["shear_rate"]["xz"], sheared->strain_rate());
  EXPECT_EQ(stage["change"]["domain"]["servo"]["stress"], Description({{"xx", nullptr}, {"yy", nullptr}}));
  EXPECT_NEAR(stage["until"]["value"].get<double>() * sheared->strain_rate(), 0.2, 1e-12);
}

TEST(RepresentativeVolume, ReportsInvalidParameters) {
  EXPECT_THAT(problem({{"grains", 99}}), HasSubstr("/grains"));
  EXPECT_THAT(problem({{"strain", 1.5}}), HasSubstr("/strain found 1.5"));
  EXPECT_EQ(problem({{"strain", 1.5}, {"test", "simple-shear"}}), "");
  EXPECT_THAT(problem({{"test", "torsion"}}), HasSubstr("simple-shear"));
}

}  // namespace
}  // namespace grit
