#include "triaxial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/testing/scenario.hpp"

namespace grit {
namespace {

INSTANTIATE_TEST_SUITE_P(Triaxial, ScenarioContract, testing::Values(ScenarioCase{"defaults", make_scenario<Triaxial>}),
                         scenario_case_name);

using testing::HasSubstr;

std::unique_ptr<Triaxial> made(const Description& keys = Description::object()) {
  return made_scenario<Triaxial>(keys);
}

/// Problems of these parameters, in one line.
std::string problem(const Description& keys) { return problems_of<Triaxial>(keys); }

TEST(Triaxial, ExpandsToTheGoldenDescription) { expect_golden(made()->expand(), "triaxial"); }

TEST(Triaxial, CompressesIsotropicallyOnThePresentCrossSection) {
  const Description walls = made({{"confining_stress", "50 kPa"}})->expand()["walls"];
  ASSERT_EQ(walls.size(), 6u);
  for (const auto& [name, wall] : walls.items()) {
    EXPECT_EQ(wall["motion"]["servo"]["pressure"], 50e3) << name;
    EXPECT_EQ(wall["motion"]["servo"]["area"], "specimen") << name;
    for (std::size_t axis = 0; axis < 3; ++axis) {  // each faces the centre
      const double point = wall["point"][axis], normal = wall["normal"][axis];
      EXPECT_EQ(normal, point > 0 ? -1 : point < 0 ? 1 : 0) << name;
    }
  }
}

TEST(Triaxial, ClosesTopAndBottomEquallyAtTheInertialNumber) {
  const auto scenario = made({{"inertial_number", 5e-4}, {"size", {"50 mm", "60 mm", "80 mm"}}});
  // I = (d eps_1 / dt) d50 sqrt(rho / sigma_c)
  EXPECT_NEAR(scenario->strain_rate() * 5e-3 * std::sqrt(2600 / 200e3), 5e-4, 1e-15);
  const Description stages = scenario->expand()["stages"];
  const Description& walls = stages.back()["change"]["walls"];
  EXPECT_DOUBLE_EQ(walls["top"]["motion"]["velocity"][2], -0.5 * scenario->strain_rate() * 80e-3);
  EXPECT_DOUBLE_EQ(walls["bottom"]["motion"]["velocity"][2], 0.5 * scenario->strain_rate() * 80e-3);
  EXPECT_EQ(walls.size(), 2u) << "lateral walls keep their stress";
}

TEST(Triaxial, AddsRankinesStrengthAsReference) {
  EXPECT_FALSE(made()->expand()["output"].contains("references"));
  const Description references =
      made({{"internal_friction_angle", "30 deg"}, {"confining_stress", "50 kPa"}})->expand()["output"]["references"];
  EXPECT_EQ(references["Rankine_strength"]["of"], "test/sigma_1");
  EXPECT_NEAR(references["Rankine_strength"]["value"].get<double>(), 3 * 50e3, 1e-6);
  EXPECT_EQ(references["Rankine_friction_angle"]["of"], "test/friction_angle");
  EXPECT_NEAR(references["Rankine_friction_angle"]["value"].get<double>(), 30, 1e-12);
}

TEST(Triaxial, HoldsFrontAndBackInPlaneStrain) {
  const Description stages = made({{"front_and_back", "held"}})->expand()["stages"];
  for (const char* wall : {"front", "back"}) EXPECT_TRUE(stages.back()["change"]["walls"][wall]["motion"].is_null());
}

TEST(Triaxial, AppliesTheIntermediateStressBeforeCompression) {
  const Description stages =
      made({{"front_and_back", "intermediate-stress"}, {"intermediate_stress", "300 kPa"}})->expand()["stages"];
  ASSERT_EQ(stages.size(), 5u);
  const Description& load = stages[3];
  EXPECT_EQ(load["ramps"][0]["pointer"], "/walls/back/motion/servo/pressure");
  EXPECT_EQ(load["ramps"][0]["from"], 200e3);
  EXPECT_EQ(load["ramps"][0]["to"], 300e3);
  EXPECT_TRUE(load["change"]["walls"]["front"]["motion"].is_null()) << "it carries the load of the back";
  EXPECT_LE(load["ramps"][0]["duration"].get<double>(), load["until"]["value"].get<double>());
}

TEST(Triaxial, RaisesTheSpeedLimitOfServosForASpecimenThatWidens) {
  const auto faster = [](Description keys) {
    keys["inertial_number"] = 1e-3, keys["preparation_inertial_number"] = 1e-3;
    const Description d = made(keys)->expand();
    std::vector<std::pair<std::string, double>> walls;
    for (const auto& [name, wall] : d["stages"].back()["change"]["walls"].items()) {
      const Description& motion = wall["motion"];
      if (motion.is_null() || motion["servo"].is_null()) continue;
      walls.emplace_back(name, motion["servo"]["max_velocity"].get<double>() /
                                   d["walls"][name]["motion"]["servo"]["max_velocity"].get<double>());
    }
    return walls;
  };
  using testing::Pair, testing::UnorderedElementsAre;
  const auto times = [](double value) { return testing::DoubleNear(value, 1e-12); };
  EXPECT_THAT(faster({{"axial_strain", 0.5}}), UnorderedElementsAre(Pair("left", times(8)), Pair("right", times(8)),
                                                                    Pair("front", times(8)), Pair("back", times(8))));
  EXPECT_THAT(faster({{"axial_strain", 0.5}, {"front_and_back", "held"}}),
              UnorderedElementsAre(Pair("left", times(8)), Pair("right", times(8))));
  EXPECT_THAT(
      faster({{"axial_strain", 0.5}, {"front_and_back", "intermediate-stress"}, {"intermediate_stress", "300 kPa"}}),
      UnorderedElementsAre(Pair("left", times(8)), Pair("right", times(8)), Pair("back", times(16))))
      << "the front is held";
}

TEST(Triaxial, HasADomainForASpecimenThatWidens) {
  const auto high = [](double strain) {
    return made({{"axial_strain", strain}})->expand()["domain"]["high"][0].get<double>();
  };
  EXPECT_EQ(high(0.3), high(0.1)) << "the cloud is wider";
  EXPECT_GT(high(0.8), 0.5 * 100e-3 / (1 - 0.8));
}

TEST(Triaxial, ReportsInvalidParameters) {
  EXPECT_THAT(problem({{"front_and_back", "intermediate-stress"}}), HasSubstr("/intermediate_stress"));
  EXPECT_THAT(problem({{"intermediate_stress", "300 kPa"}}),
              HasSubstr("a stress with front_and_back \"intermediate-stress\" only"));
  const Description between = {{"front_and_back", "intermediate-stress"}, {"intermediate_stress", "199 kPa"}};
  EXPECT_THAT(problem(between),
              HasSubstr("/intermediate_stress found 199000 Pa; allowed is at least confining_stress, 200000 Pa"));
  EXPECT_THAT(problem({{"axial_strain", 1}}), HasSubstr("/axial_strain"));
  EXPECT_THAT(problem({{"front_and_back", "free"}}), HasSubstr("confining-stress"));
  EXPECT_THAT(refusal<Triaxial>({{"void_ratio", 0.5}}), HasSubstr("void_ratio: found 0.5; allowed is between "));
  EXPECT_EQ(refusal<Triaxial>({{"void_ratio", 0.5}, {"compaction_friction_angle", "0 deg"}}), "")
      << "no range is checked for a given friction of compaction";
  EXPECT_THAT(problem({{"size", {"100 mm", "29 mm", "100 mm"}}}),
              HasSubstr("/size/1 found 0.029 m; allowed is at least 4 of the largest grains, 0.03 m"));
}

// Growth, common to all scenarios with a preparation.

TEST(GrowthOfGrains, FillsTheBoxOfAVoidRatioAboveTheTarget) {
  const Description keys = {{"preparation", "growth"}, {"void_ratio", 0.65}};
  const Description d = made(keys)->expand(), sand = d["bodies"]["sand"]["source"];
  // At their final radii grains have a void ratio of 0.68 between the fixed walls.
  const double box = std::cbrt(1.68 / 1.65) * 100e-3;
  EXPECT_NEAR(sand["high"][0].get<double>() - sand["low"][0].get<double>(), box, 1e-12);
  EXPECT_EQ(sand["count"], made({{"void_ratio", 0.65}})->expand()["bodies"]["sand"]["source"]["count"]);
  const double size = std::cbrt(0.3 * 1.68);
  EXPECT_NEAR(sand["sizes"]["smallest"].get<double>(), size * 2.5e-3, 1e-12);
  EXPECT_NEAR(sand["sizes"]["largest"].get<double>(), size * 7.5e-3, 1e-12);
  for (const auto& [name, wall] : d["walls"].items()) EXPECT_FALSE(wall.contains("motion")) << name;
}

TEST(GrowthOfGrains, PrecedesServosAndSettling) {
  const Description stages = made({{"preparation", "growth"}})->expand()["stages"];
  ASSERT_EQ(stages.size(), 5u);
  for (std::size_t i = 0; const char* name : {"grow", "press", "densify", "settle", "shear"})
    EXPECT_EQ(stages[i++]["name"], name);
  // I = rate d50 sqrt(rho / sigma_c)
  EXPECT_NEAR(stages[0]["growth"]["rate"].get<double>() * 5e-3 * std::sqrt(2600 / 200e3), 3e-3, 1e-15);
  EXPECT_LT(stages[1]["growth"]["rate"].get<double>(), stages[0]["growth"]["rate"].get<double>());
  EXPECT_EQ(stages[1]["until"], Description({{"type", "mean-stress"}, {"above", 200e3}}));
  EXPECT_FALSE(stages[2].contains("growth"));
  EXPECT_EQ(stages[2]["change"]["walls"].size(), 6u);
  for (const auto& [name, wall] : stages[2]["change"]["walls"].items())
    EXPECT_EQ(wall["motion"]["servo"]["pressure"], 200e3) << name;
}

TEST(GrowthOfGrains, HasItsOwnRange) {
  EXPECT_THAT(refusal<Triaxial>({{"preparation", "growth"}, {"void_ratio", 0.79}}),
              HasSubstr("between 0.537 (prepared without friction) and 0.76 ("));
  EXPECT_EQ(refusal<Triaxial>({{"void_ratio", 0.79}}), "");
}

TEST(GrowthOfGrains, AlsoScalesSieves) {
  const Description d = made({{"sieve_diameters", {"2.5 mm", "7.5 mm"}},
                              {"sieve_passing", {0, 1}},
                              {"preparation", "growth"},
                              {"void_ratio", 0.67}})
                            ->expand();
  const Description diameters = d["bodies"]["sand"]["source"]["sizes"]["diameters"];
  EXPECT_NEAR(diameters[0].get<double>(), std::cbrt(0.3 * 1.70) * 2.5e-3, 1e-12);
  EXPECT_NEAR(diameters[1].get<double>(), std::cbrt(0.3 * 1.70) * 7.5e-3, 1e-12);
}

// Sieves, common to all scenarios with a preparation.

TEST(Sieves, FillTheSpecimenByTheMeanVolumeOfTheirGrains) {
  // 10 % of the mass between 0.25 and 0.5 mm, 90 % between 0.5 and 1 mm, uniform by mass in between: number of grains
  // by summation.
  double grains = 0, diameters = 0;  // per volume of solids
  const int parts = 100000;
  for (int i = 0; i < parts; ++i)
    for (const auto& [low, width, share] : {std::tuple{2.5e-3, 2.5e-3, 0.1}, std::tuple{5e-3, 5e-3, 0.9}}) {
      const double d = low + width * (i + 0.5) / parts;
      const double number = share / parts / (std::numbers::pi / 6 * d * d * d);
      grains += number, diameters += number * d;
    }
  const Description sieved = {{"smallest_diameter", "2.5 mm"},
                              {"largest_diameter", "10 mm"},
                              {"sieve_diameters", {"2.5 mm", "5 mm", "10 mm"}},
                              {"sieve_passing", {0, 0.1, 1}},
                              {"void_ratio", 0.65}};
  const auto scenario = made(sieved);
  const Description d = scenario->expand(), sand = d["bodies"]["sand"]["source"];
  EXPECT_NEAR(sand["count"].get<double>(), 1e-3 / 1.65 * grains, 1);
  EXPECT_EQ(sand["sizes"]["type"], "sieve");
  EXPECT_EQ(sand["sizes"]["passing"], Description({0.0, 0.1, 1.0}));
  EXPECT_NEAR(scenario->strain_rate() * diameters / grains * std::sqrt(2600 / 200e3), 1e-4, 1e-12);
}

TEST(Sieves, AreRefusedUnlessTheyFormACurve) {
  const auto sieves = [](const Description& diameters, const Description& passing) {
    return problem({{"sieve_diameters", diameters}, {"sieve_passing", passing}});
  };
  EXPECT_EQ(sieves({"2.5 mm", "7.5 mm"}, {0, 1}), "");
  EXPECT_THAT(sieves({"2.5 mm", "7.5 mm"}, {0, 0.5, 1}), HasSubstr("/sieve_passing"));
  EXPECT_THAT(sieves({"2.5 mm", "5 mm", "5 mm", "7.5 mm"}, {0, 0.1, 0.2, 1}), HasSubstr("above the one before"));
  EXPECT_THAT(sieves({"2.5 mm", "7 mm"}, {0, 1}), HasSubstr("from smallest_diameter to largest_diameter"));
  EXPECT_THAT(sieves({"2.5 mm", "7.5 mm"}, {0.1, 1}), HasSubstr("rise from 0 to 1"));
}

}  // namespace
}  // namespace grit
