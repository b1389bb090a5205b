#include "silo-discharge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grit/testing/scenario.hpp"

namespace grit {
namespace {

INSTANTIATE_TEST_SUITE_P(SiloDischarge, ScenarioContract,
                         testing::Values(ScenarioCase{"defaults", make_scenario<SiloDischarge>}), scenario_case_name);

using testing::ElementsAre;
using testing::HasSubstr;

Description expanded(const Description& keys = Description::object()) {
  return made_scenario<SiloDischarge>(keys)->expand();
}

std::string problem(const Description& keys) { return problems_of<SiloDischarge>(keys); }

using Reach = std::pair<long, long>;

/// Range along x, within the silo's 200 mm, of each wall with this prefix; in mm.
std::vector<Reach> reach(const Description& walls, const std::string& begin) {
  std::vector<Reach> all;
  for (const auto& [name, wall] : walls.items())
    if (name.starts_with(begin)) {
      const double low = wall["corner"][0], high = low + wall["edge_a"][0].get<double>();
      const auto rounded = [](double x) { return std::lround(1e3 * std::clamp(x, 0.0, 0.2)); };
      all.emplace_back(rounded(low), rounded(high));
    }
  return all;
}

TEST(SiloDischarge, ExpandsToTheGoldenDescription) { expect_golden(expanded(), "silo-discharge"); }

TEST(SiloDischarge, ClosesEachOutletWithAGate) {
  Description walls = expanded()["walls"];
  EXPECT_THAT(reach(walls, "gate"), ElementsAre(Reach(85, 115)));
  EXPECT_THAT(reach(walls, "bottom"), ElementsAre(Reach(0, 85), Reach(115, 200)));
  walls = expanded({{"outlet_positions", {0.16, 0.04, 0.1}}, {"outlet_widths", {0.02, 0.04, 0.01}}})["walls"];
  EXPECT_THAT(reach(walls, "gate"), ElementsAre(Reach(20, 60), Reach(95, 105), Reach(150, 170)));
  EXPECT_THAT(reach(walls, "bottom"), ElementsAre(Reach(0, 20), Reach(60, 95), Reach(105, 150), Reach(170, 200)));
}

TEST(SiloDischarge, LetsAnOutletExtendToAWall) {
  const Description walls = expanded({{"outlet_positions", {"185 mm"}}, {"outlet_widths", {"30 mm"}}})["walls"];
  EXPECT_THAT(reach(walls, "gate"), ElementsAre(Reach(170, 200)));
  EXPECT_THAT(reach(walls, "bottom"), ElementsAre(Reach(0, 170)));
  const Description open = expanded({{"outlet_widths", {"200 mm"}}})["walls"];
  EXPECT_THAT(reach(open, "gate"), ElementsAre(Reach(0, 200)));
  EXPECT_TRUE(reach(open, "bottom").empty());
}

TEST(SiloDischarge, OpensGatesBelowTheDomain) {
  const Description d = expanded({{"outlet_positions", {0.05, 0.15}}, {"outlet_widths", {0.02, 0.02}}});
  EXPECT_EQ(d["domain"]["open_sides"], Description({"-z"}));
  const Description& opened = d["stages"][2]["change"]["walls"];
  EXPECT_EQ(opened.size(), 2u);
  for (const auto& [name, wall] : opened.items()) {
    EXPECT_LT(wall["corner"][2], d["domain"]["low"][2]) << name;
    EXPECT_EQ(wall["corner"][0], d["walls"][name]["corner"][0]) << name;
  }
}

TEST(SiloDischarge, HasAStageForEachFraction) {
  const Description stages = expanded({{"discharged_fractions", {0.2, 0.6}}})["stages"];
  ASSERT_EQ(stages.size(), 4u);
  EXPECT_EQ(stages[2]["name"], "discharge-20");
  EXPECT_EQ(stages[3]["name"], "discharge-60");
  EXPECT_EQ(stages[3]["until"]["of"][0]["fraction"], 0.6);
  EXPECT_FALSE(stages[3].contains("change"));
}

TEST(SiloDischarge, DistinguishesSmallFractions) {
  const auto names = [](const Description& fractions) {
    std::vector<std::string> all;
    const Description stages = expanded({{"discharged_fractions", fractions}})["stages"];
    for (std::size_t i = 2; i < stages.size(); ++i) all.push_back(stages[i]["name"]);
    return all;
  };
  EXPECT_THAT(names({0.001, 0.002}), ElementsAre("discharge-0.1", "discharge-0.2"));
  EXPECT_THAT(names({0.101, 0.104, 0.29}), ElementsAre("discharge-10.1", "discharge-10.4", "discharge-29"));
  EXPECT_THAT(problem({{"discharged_fractions", {0.5, 0.50000001}}}),
              HasSubstr("two fractions with the same first six digits"));
}

TEST(SiloDischarge, LimitsIncludeTheTimeToComeToRest) {
  for (const Description& fractions : {Description({0.1, 0.101}), Description({0.2, 0.9, 1})}) {
    const Description stages = expanded({{"discharged_fractions", fractions}})["stages"];
    EXPECT_GE(stages.back()["limit"].get<double>(), stages[1]["limit"].get<double>()) << "the limit of settle";
  }
}

TEST(SiloDischarge, AddsAnalyticalSolutionsAsReferences) {
  const Description d = expanded({{"outlet_positions", {0.05, 0.15}}, {"outlet_widths", {0.03, 0.03}}});
  const Description references = d["output"]["references"];
  EXPECT_EQ(references["Beverloo"]["of"], "flow/discharge_rate");
  EXPECT_NEAR(references["Beverloo"]["value"].get<double>(),
              2 * 1.03 * 1625 * std::sqrt(9.81) * 7.5e-3 * std::pow(30e-3 - 1.4 * 1.5e-3, 1.5), 1e-12);
  EXPECT_EQ(references["Janssen_P_over_G"]["of"], "test/bottom_fraction");
  EXPECT_TRUE(d["probes"].contains("flow"));
}

TEST(SiloDischarge, OpensWhenTheLastLayerIsAtRest) {
  const Description d = expanded({{"layers", 2}, {"filling", "layers"}, {"discharged_fractions", {0.5}}});
  std::vector<std::string> names;
  for (const Description& stage : d["stages"]) names.push_back(stage["name"]);
  EXPECT_THAT(names, ElementsAre("fill-1", "fill-2", "settle", "discharge-50"));
  EXPECT_TRUE(d["stages"][3]["change"]["walls"].contains("gate-1"));
  EXPECT_EQ(d["probes"]["test"]["stages"], Description({"settle", "discharge-50"}));
}

TEST(SiloDischarge, ExpectsTheRateOfBeverlooForSlots) {
  const double d50 = 1.5e-3, width = 30e-3, depth = 7.5e-3, bulk = 2600 / 1.6;
  const double one = 1.03 * bulk * std::sqrt(9.81) * depth * std::pow(width - 1.4 * d50, 1.5);
  EXPECT_NEAR(made_scenario<SiloDischarge>()->expected_rate(), one, 1e-12);
  EXPECT_NEAR(made_scenario<SiloDischarge>({{"outlet_positions", {0.05, 0.15}}, {"outlet_widths", {0.03, 0.03}}})
                  ->expected_rate(),
              2 * one, 1e-12);
}

TEST(SiloDischarge, AssignsGrainsToOutlets) {
  EXPECT_FALSE(expanded()["probes"]["flow"].contains("outlets"));
  const Description flow =
      expanded({{"outlet_positions", {0.05, 0.15}}, {"outlet_widths", {0.02, 0.04}}})["probes"]["flow"]["outlets"];
  EXPECT_DOUBLE_EQ(flow["outlet_1"]["high"], 0.095);
  EXPECT_EQ(flow["outlet_1"]["high"], flow["outlet_2"]["low"]);
  EXPECT_LT(flow["outlet_1"]["low"], 0);
  EXPECT_GT(flow["outlet_2"]["high"], 0.2);
}

TEST(SiloDischarge, ReportsInvalidParameters) {
  EXPECT_THAT(problem({{"outlet_widths", {"210 mm"}}}), HasSubstr("outlets inside the bottom, 0 to 0.2"));
  EXPECT_THAT(problem({{"outlet_positions", {"10 mm"}}}), HasSubstr("an outlet from -0.005"));
  EXPECT_THAT(problem({{"outlet_widths", {"7 mm"}}}), HasSubstr("three of the largest grains"));
  EXPECT_EQ(problem({{"width", "36 mm"}, {"largest_diameter", "2 mm"}, {"outlet_widths", {"6 mm"}}}), "") << "rounding";
  EXPECT_THAT(problem({{"outlet_positions", {0.05, 0.07}}, {"outlet_widths", {0.03, 0.03}}}),
              HasSubstr("overlaps or touches"));
  EXPECT_THAT(problem({{"outlet_positions", {0.05, 0.08}}, {"outlet_widths", {0.03, 0.03}}}),
              HasSubstr("some bottom in between"));
  EXPECT_THAT(problem({{"outlet_positions", {0.05, 0.1}}}), HasSubstr("as many as outlet_positions, 2"));
  EXPECT_THAT(problem({{"discharged_fractions", {0.5, 0.2}}}), HasSubstr("ascending fractions"));
  EXPECT_THAT(problem({{"discharged_fractions", {1.2}}}), HasSubstr("/discharged_fractions"));
  EXPECT_THAT(problem({{"roughness", -1}}), HasSubstr("/roughness"));
  for (const std::string form : {"drescher", "en_1991_4"})
    EXPECT_THAT(
        problem({{"analytical_solutions", {{form, Description::object()}}}}),
        HasSubstr("/analytical_solutions/" + form + " found a solution for the force on a bottom without outlets"));
}

}  // namespace
}  // namespace grit
