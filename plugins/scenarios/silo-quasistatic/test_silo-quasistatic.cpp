#include "silo-quasistatic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/testing/scenario.hpp"

namespace grit {
namespace {

INSTANTIATE_TEST_SUITE_P(SiloQuasistatic, ScenarioContract,
                         testing::Values(ScenarioCase{"defaults", make_scenario<SiloQuasistatic>}), scenario_case_name);

using testing::HasSubstr;

Description expanded(const Description& keys = Description::object()) {
  return made_scenario<SiloQuasistatic>(keys)->expand();
}

std::string problem(const Description& keys) { return problems_of<SiloQuasistatic>(keys); }

TEST(SiloQuasistatic, ExpandsToTheGoldenDescription) { expect_golden(expanded(), "silo-quasistatic"); }

TEST(SiloQuasistatic, CutsWallsIntoContinuousSegments) {
  for (const char* surface : {"saw-tooth", "sinusoidal"}) {
    const Description walls =
        expanded({{"wall_segments", 3}, {"wall_surface", surface}, {"wavelength", "7 mm"}})["walls"];
    for (const std::string side : {"left", "right"}) {
      double end = -(30e-3 + 2 * 2.5e-3);
      for (const char* piece : {"-below", "-1", "-2", "-3", "-above"}) {
        const Description& wall = walls[side + piece];
        const double low = wall["corner"][2];
        const double spacing = wall[std::string(surface) == "sinusoidal" ? "wavelength" : "spacing"];
        EXPECT_NEAR(low, end, 1e-12) << side << piece;
        // Grooves start as on a single wall from z = 0.
        EXPECT_NEAR(std::remainder(low + wall["offset"].get<double>(), spacing), 0, 1e-12) << side << piece;
        end = low + wall["edge_a"][2].get<double>();
      }
      EXPECT_GT(end, 0.5);
    }
  }
}

TEST(SiloQuasistatic, AllowsTheSpeedOfFallingGrains) {
  const auto travel = [](const char* height) {
    return expanded({{"height", height}})["guards"]["travel"].get<double>();
  };
  EXPECT_NEAR(travel("800 mm") / travel("400 mm"), std::sqrt(2), 1e-12) << "in proportion to the speed of fall";
  EXPECT_EQ(travel("40 mm"), 0.05);
}

TEST(SiloQuasistatic, HasWallsOfTheGivenRoughness) {
  const Description rough = expanded({{"roughness", 0.25}})["walls"]["left-1"];
  EXPECT_EQ(rough["type"], "saw-tooth");
  EXPECT_DOUBLE_EQ(rough["depth"], 0.25 * 1.5e-3);
  EXPECT_DOUBLE_EQ(rough["spacing"], 1.5e-3) << "d50, as in the reference at R_n = 0.25";
  EXPECT_DOUBLE_EQ(expanded({{"groove_spacing", "20 mm"}})["walls"]["left-1"]["spacing"], 20e-3);
  const Description flat = expanded({{"wall_surface", "flat"}})["walls"]["left-1"];
  EXPECT_EQ(flat["type"], "rectangle");
  EXPECT_FALSE(flat.contains("depth"));
}

TEST(SiloQuasistatic, HasSinusoidalWallsOfTheGivenDepth) {
  const Description wavy =
      expanded({{"wall_surface", "sinusoidal"}, {"depth_over_wavelength", 0.1}, {"wavelength", "20 mm"}});
  for (const char* name : {"left-below", "left-1", "right-10", "right-above"}) {
    const Description& wall = wavy["walls"][name];
    EXPECT_EQ(wall["type"], "sinusoidal") << name;
    EXPECT_DOUBLE_EQ(wall["depth"], 2e-3) << name;
    EXPECT_DOUBLE_EQ(wall["wavelength"], 20e-3) << name;
    EXPECT_FALSE(wall.contains("inclination") || wall.contains("spacing") || wall.contains("two_sided")) << name;
  }
  EXPECT_LT(wavy["walls"]["bottom"]["corner"][0].get<double>(), -2e-3) << "the bottom closes the troughs";
  const Description still = {{"wall_surface", "sinusoidal"}, {"depth_over_wavelength", 0}};
  EXPECT_EQ(problem(still), "");
  EXPECT_EQ(expanded(still)["walls"]["left-1"]["depth"], 0.0);
}

TEST(SiloQuasistatic, FillsGroovesToo) {
  const auto count = [](const Description& keys) {
    double sum = 0;
    const Description d = expanded(keys);
    for (const auto& [name, layer] : d["bodies"].items()) sum += layer["source"]["count"].get<double>();
    return sum;
  };
  // The mean of d³ is 4.875 mm³ for diameters uniform by number from 0.5 to 2.5 mm.
  const double flat = count({{"wall_surface", "flat"}, {"layers", 1}, {"void_ratio", 0.6}});
  EXPECT_NEAR(flat, 200 * 500 * 7.5 / 1.6 / (std::numbers::pi / 6 * 4.875), 1);
  // Grooves of 45 degrees at four times their depth R_n d50 have the volume of a layer of a quarter of that depth.
  EXPECT_NEAR(count({{"roughness", 1}, {"layers", 7}}) / flat, (200 + 2 * 1.5 / 4) / 200, 1e-4);
  // Waves have the volume of a layer of half their depth.
  EXPECT_NEAR(count({{"wall_surface", "sinusoidal"}, {"depth_over_wavelength", 0.1}, {"wavelength", "20 mm"}}) / flat,
              (200 + 2 * 1.) / 200, 1e-4);
}

TEST(SiloQuasistatic, AlternatesMaterialsThatDifferOnlyInName) {
  const Description d = expanded({{"layers", 3}});
  EXPECT_EQ(d["bodies"].size(), 3u);
  EXPECT_EQ(d["bodies"]["layer-1"]["material"], "sand");
  EXPECT_EQ(d["bodies"]["layer-2"]["material"], "dyed");
  EXPECT_EQ(d["bodies"]["layer-3"]["material"], "sand");
  EXPECT_EQ(d["materials"]["sand"], d["materials"]["dyed"]);
  EXPECT_EQ(d["interfaces"]["sand+wall"], d["interfaces"]["dyed+wall"]);
  EXPECT_EQ(d["bodies"]["layer-2"]["source"]["low"][2], d["bodies"]["layer-1"]["source"]["high"][2]);
  EXPECT_FALSE(expanded({{"layers", 1}})["materials"].contains("dyed"));
}

TEST(SiloQuasistatic, FillsWithAnotherFriction) {
  const Description d = expanded({{"filling_friction_angle", 0.1}, {"friction_angle", 0.4}, {"local_damping", 0.02}});
  EXPECT_EQ(d["materials"]["sand"]["friction_angle"], 0.1);
  EXPECT_EQ(d["stages"][2]["change"]["materials"]["dyed"]["friction_angle"], 0.4);
  EXPECT_DOUBLE_EQ(d["interfaces"]["sand+wall"]["friction_angle"], 18 * degree);
  EXPECT_EQ(d["stages"][3]["change"]["engines"]["damping"]["coefficient"], 0.02);
}

TEST(SiloQuasistatic, ReducesGravityBeforeFrictionChanges) {
  const auto stages = [](Description keys) {
    keys["filling_friction_angle"] = 0.1;
    return expanded(keys)["stages"];
  };
  const Description all = stages({{"reduced_gravity", 0.2}});
  ASSERT_EQ(all.size(), 4u);
  const Description &relieve = all[1], &settle = all[2];
  EXPECT_EQ(relieve["name"], "relieve");
  EXPECT_FALSE(relieve.contains("change")) << "friction during filling";
  const Description &down = relieve["ramps"][0], &up = settle["ramps"][0];
  EXPECT_EQ(down["pointer"], "/engines/gravity/acceleration/2");
  EXPECT_EQ(up["pointer"], down["pointer"]);
  EXPECT_DOUBLE_EQ(down["from"], -9.81);
  EXPECT_DOUBLE_EQ(down["to"], -0.2 * 9.81);
  EXPECT_EQ(up["from"], down["to"]);
  EXPECT_EQ(up["to"], down["from"]);
  // 2 600 kg/m³ and 10 MPa: 62 m/s, 8.1 ms for 0.5 m.
  EXPECT_NEAR(down["duration"], 20 * 0.5 / 62.017, 1e-5);
  EXPECT_EQ(relieve["until"]["value"], down["duration"]);
  EXPECT_GT(settle["until"]["of"][0]["value"], up["duration"]) << "additional time to come to rest";
  EXPECT_TRUE(settle["change"]["materials"].contains("sand"));

  const Description kept = stages({{"reduced_gravity", 1}});
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_FALSE(kept[1].contains("ramps"));
  EXPECT_EQ(expanded({{"reduced_gravity", 0.2}})["stages"], expanded()["stages"]) << "constant friction";
  EXPECT_EQ(stages({{"filling", "layers"}, {"layers", 3}})[3]["name"], "relieve") << "after the last layer is at rest";
}

TEST(SiloQuasistatic, FillsLayerAfterLayer) {
  const Description at_once = expanded({{"layers", 3}}), d = expanded({{"layers", 3}, {"filling", "layers"}});
  ASSERT_EQ(d["stages"].size(), 5u);
  double before = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string number = std::to_string(k + 1);
    const Description& stage = d["stages"][k];
    EXPECT_EQ(stage["name"], "fill-" + number);
    EXPECT_EQ(d["bodies"]["layer-" + number].value("stage", ""), k == 0 ? "" : "fill-" + number);
    EXPECT_EQ(d["bodies"]["layer-" + number]["source"], at_once["bodies"]["layer-" + number]["source"]);
    const double falls = stage["until"]["of"][0]["value"];
    EXPECT_GT(falls, before) << "later layers fall from higher up";
    before = falls;
  }
  EXPECT_EQ(d["stages"][2]["until"], at_once["stages"][0]["until"]) << "the last falls like the cloud";
  EXPECT_EQ(d["stages"][3], at_once["stages"][1]);
  EXPECT_EQ(d["stages"][4], at_once["stages"][2]);
}

TEST(SiloQuasistatic, LowersTheBottomBetweenTheWallsBelow) {
  const Description d = expanded({{"settlement", "12 mm"}, {"velocity", "3 mm/s"}});
  const Description& lower = d["stages"][2];
  EXPECT_EQ(lower["until"]["value"], -12e-3);
  EXPECT_EQ(lower["change"]["walls"]["bottom"]["motion"]["velocity"][2], -3e-3);
  EXPECT_LT(d["walls"]["left-below"]["corner"][2].get<double>(), -12e-3);
  EXPECT_LT(d["domain"]["low"][2].get<double>(), -12e-3);
}

TEST(SiloQuasistatic, AddsAnalyticalSolutionsAsReferences) {
  const auto value = [](const Description& keys, const char* name) -> double {
    return expanded(keys)["output"]["references"][name]["value"];
  };
  const Description d = expanded();
  for (const auto& [name, reference] : d["output"]["references"].items())
    EXPECT_TRUE(d["probes"]["test"]["curves"].contains(reference["of"].get<std::string>().substr(5))) << name;

  // b = 0.2 m, h = 0.5 m; EN 1991-4's K and friction of corrugated walls.
  const Description none = Description::object();
  const double k = 0.45343622, mu = 0.2 * 0.32491970 + 0.8 * 0.72654253, a = 2 * k * mu * 0.5 / 0.2,
               p = (1 - std::exp(-a)) / a;
  EXPECT_NEAR(value(none, "Janssen_K"), k, 1e-8);
  EXPECT_NEAR(value(none, "Janssen_P_over_G"), p, 1e-7);
  EXPECT_NEAR(value(none, "Janssen_T_over_G"), (1 - p) / 2, 1e-7);
  EXPECT_NEAR(value(none, "Janssen_N_over_G"), (1 - p) / 2 / mu, 1e-7);
  EXPECT_NEAR(value(none, "Janssen_wall_friction"), std::atan(mu) / degree, 1e-5);
  EXPECT_NEAR(value(none, "Rankine_active"), 0.25961618, 1e-8);
  EXPECT_NEAR(value(none, "Rankine_passive"), 1 / 0.25961618, 1e-6);
  EXPECT_NEAR(value({{"wall_surface", "flat"}}, "Janssen_wall_friction"), 18, 1e-9);
  EXPECT_NEAR(value({{"roughness", 0.01}}, "Janssen_wall_friction"), 18, 1e-9) << "sand slides on shallow grooves";
  EXPECT_NEAR(value({{"analytical_solutions", {{"wall_friction_angle", "27 deg"}}}}, "Janssen_wall_friction"), 27,
              1e-9);
  EXPECT_EQ(value({{"analytical_solutions", {{"stress_ratio", 0.6}}}}, "Janssen_K"), 0.6);
  EXPECT_NEAR(value({{"analytical_solutions", {{"internal_friction_angle", "30 deg"}}}}, "Janssen_K"), 0.55, 1e-12);
  EXPECT_NEAR(value({{"analytical_solutions", {{"internal_friction_angle", "30 deg"}}}}, "Rankine_passive"), 3, 1e-12);

  // For a depth of 7.5 mm; 0.6 m in the source.
  const double depth = 0.6 / 7.5e-3;
  const auto force = [&](const char* form, const char* name, double ratio, const char* angle, const char* weight) {
    return depth *
           value({{"analytical_solutions",
                   {{form, {{"stress_ratio", ratio}, {"wall_friction_angle", angle}, {"unit_weight", weight}}}}}},
                 name);
  };
  EXPECT_NEAR(force("drescher", "Drescher", 0.83, "32 deg", "16 kN/m^3"), 537, 0.01 * 537);
  EXPECT_NEAR(force("en_1991_4", "EN_1991-4", 0.63, "32 deg", "17 kN/m^3"), 446, 0.01 * 446);
  EXPECT_FALSE(expanded()["output"]["references"].contains("Drescher"));
  // By default EN 1991-4 equals Janssen's formula for this filling.
  EXPECT_NEAR(value({{"analytical_solutions", {{"en_1991_4", Description::object()}}}}, "EN_1991-4"),
              p * 2600 / 1.6 * 9.81 * 0.2 * 0.5 * 7.5e-3, 1e-6);
}

TEST(SiloQuasistatic, ReportsInvalidParameters) {
  EXPECT_THAT(problem({{"roughness", -0.1}}), HasSubstr("/roughness"));
  EXPECT_THAT(problem({{"settlement", "501 mm"}}), HasSubstr("less than the height of the filling, 0.5 m"));
  EXPECT_THAT(problem({{"groove_spacing", "2.9 mm"}}), HasSubstr("at least the width of a groove, 0.003"));
  EXPECT_EQ(problem({{"groove_spacing", "3 mm"}}), "") << "as wide as the groove, within rounding";
  EXPECT_EQ(problem({{"groove_spacing", "2.9 mm"}, {"wall_surface", "sinusoidal"}}), "");
  EXPECT_THAT(problem({{"depth_over_wavelength", -0.1}}), HasSubstr("/depth_over_wavelength"));
  EXPECT_THAT(problem({{"analytical_solutions", {{"en_1991_4", {{"stress_ratio", 0}}}}}}),
              HasSubstr("/analytical_solutions/en_1991_4/stress_ratio"));
  EXPECT_EQ(problem({{"groove_spacing", "2.9 mm"}, {"wall_surface", "flat"}}), "");
  EXPECT_THAT(problem({{"groove_spacing", "501 mm"}}), HasSubstr("found grooves 0.501 m apart"));
  EXPECT_THAT(problem({{"void_ratio", 0.3}}), HasSubstr("/void_ratio"));
  EXPECT_THAT(problem({{"width", "9 mm"}}), HasSubstr("at least 4 of the largest grains"));
  EXPECT_THAT(problem({{"depth", "4 mm"}}), HasSubstr("at least 2 of the largest grains"));
  EXPECT_THAT(problem({{"smallest_diameter", "3 mm"}}), HasSubstr("at most largest_diameter"));
  EXPECT_THAT(problem({{"velocity", 0}}), HasSubstr("/velocity"));
  EXPECT_THAT(problem({{"reduced_gravity", 0}}), HasSubstr("/reduced_gravity"));
  EXPECT_THAT(problem({{"reduced_gravity", 1.1}}), HasSubstr("to 1"));
  EXPECT_THAT(problem({{"filling", "rain"}}), HasSubstr("one of cloud, layers"));
}

}  // namespace
}  // namespace grit
