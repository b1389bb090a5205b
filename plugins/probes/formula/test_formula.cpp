#include "formula.hpp"

#include <gmock/gmock.h>

#include "grit/testing/probe.hpp"

namespace grit {
namespace {

using testing::HasSubstr;

/// Counts who looks at the grains.
struct WatchedWorld : FakeWorld {
  mutable int looks = 0;
  std::span<const Row> positions() const override { return ++looks, FakeWorld::positions(); }
};

WatchedWorld shear_box() {
  WatchedWorld world;
  world.now = 0.5, world.steps = 1000;
  world.wall = {still_wall("upper-left"), still_wall("top")};
  auto& left = world.wall[0];
  left.position = {6e-3, 1e-3, 2e-3}, left.stage_position = {5e-3, 0.1, 0.2}, left.velocity = {0.1, 0.2, 0.3};
  left.force = {-120, 3, 4};
  auto& top = world.wall[1];
  top.position = {0, 0, 3e-4}, top.stage_position = {0, 0, 2e-4}, top.velocity = {0, 0, 1e-5};
  top.force = {0, 0, 200}, top.area = 4e-4, top.pressure = 5e5;
  world.add({0.5, 0.5, 0.5}, 0.1);
  return world;
}

double value_of(const std::string& formula, const World& world = shear_box()) {
  FormulaProbe probe;
  probe.curves["curve"].formula = formula;
  probe.constants["length"].value = 0.06;
  probe.prepare(world);
  return channel_value(probe, world, "curve");
}

std::string error_of(const std::string& formula, const World& world = shear_box()) {
  try {
    value_of(formula, world);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Formula, KnowsTheWorld) {
  EXPECT_DOUBLE_EQ(value_of("time"), 0.5);
  EXPECT_DOUBLE_EQ(value_of("step"), 1000);
  EXPECT_DOUBLE_EQ(value_of("mean_diameter"), 0.2);
  EXPECT_DOUBLE_EQ(value_of("upper_left_force_x"), -120);
  EXPECT_DOUBLE_EQ(value_of("upper_left_force_y"), 3);
  EXPECT_DOUBLE_EQ(value_of("upper_left_force_z"), 4);
  EXPECT_DOUBLE_EQ(value_of("upper_left_travel_x"), 6e-3);
  EXPECT_DOUBLE_EQ(value_of("upper_left_stage_travel_z"), 0.2);
  EXPECT_DOUBLE_EQ(value_of("upper_left_velocity_y"), 0.2);
  EXPECT_DOUBLE_EQ(value_of("top_pressure"), 5e5);
  EXPECT_DOUBLE_EQ(value_of("top_area"), 4e-4);
  EXPECT_DOUBLE_EQ(value_of("length"), 0.06);
}

TEST(Formula, TakesVoidRatioOfTheInterior) {
  const double inner = 0.6 * 0.6 * 0.6, solid = 4.0 / 3 * std::numbers::pi * 1e-3;  // one diameter, 0.2, off the walls
  EXPECT_NEAR(value_of("void_ratio"), (inner - solid) / solid, 1e-12);
}

TEST(Formula, WeighsGrainsAndSaysWhereTheirCentreIs) {
  WatchedWorld world = shear_box();
  world.add({0.2, 0.8, 0.5}, 0.2);  // eight times as heavy
  world.departure = {{7, 0, 0.1, 3, {0, 0, 0}}, {8, 0, 0.2, 4, {0, 0, 0}}};
  EXPECT_NEAR(value_of("mass", world), 9 * 2600 * 4.0 / 3 * std::numbers::pi * 1e-3, 1e-9);
  EXPECT_NEAR(value_of("centre_x", world), (0.5 + 8 * 0.2) / 9, 1e-12);
  EXPECT_NEAR(value_of("centre_y", world), (0.5 + 8 * 0.8) / 9, 1e-12);
  EXPECT_NEAR(value_of("centre_z", world), 0.5, 1e-12);
  // Masses of 1 and 8: the mean square distance from the centre of mass is 8/81 of the squared distance.
  EXPECT_NEAR(value_of("spread_x", world), 0.3 * std::sqrt(8.0) / 9, 1e-12);
  EXPECT_NEAR(value_of("spread_z", world), 0, 1e-12);
  EXPECT_EQ(value_of("departed_mass", world), 7);
}

TEST(Formula, WeighsAClumpOnce) {
  struct : FakeWorld {
    std::vector<std::uint32_t> of{0, 0, no_clump};
    std::vector<ClumpView> clump{1};
    std::span<const std::uint32_t> clump_of() const override { return of; }
    std::span<const ClumpView> clumps() const override { return clump; }
  } world;
  world.add({0, 0, 0}, 0.1), world.add({0.1, 0, 0}, 0.1);
  const auto alone = world.add({3, 0, 0}, 0.1);
  world.velocity[alone].w = 1.0 / 2;
  world.clump[0].centre = {0, 0, 0}, world.clump[0].mass = 5, world.clump[0].unscaled_mass = 4;
  EXPECT_DOUBLE_EQ(value_of("mass", world), 6);
  EXPECT_DOUBLE_EQ(value_of("centre_x", world), 1);
}

TEST(Formula, ComputesTestCurves) {
  EXPECT_DOUBLE_EQ(value_of("-upper_left_force_x / top_force_z"), 0.6);
  EXPECT_DOUBLE_EQ(value_of("upper_left_stage_travel_x / length"), 5e-3 / 0.06);
  EXPECT_DOUBLE_EQ(value_of("top_pressure > 1e6 ? 1 : 2"), 2);
  EXPECT_DOUBLE_EQ(value_of("time == 0.5 && step >= 1000 && step <= 1000 && step != 3"), 1);
  EXPECT_DOUBLE_EQ(value_of("ln(exp(2)) + log10(100) + max(1, 3) + sqrt(4) + 2^3"), 17);
  EXPECT_TRUE(std::isinf(value_of("1 / top_force_x")));
}

TEST(Formula, AddsTheForcesOfSeveralWalls) {
  WatchedWorld world = shear_box();
  world.wall.push_back(still_wall("upper-right"));
  world.wall.back().force = {70, 0, 16};
  EXPECT_DOUBLE_EQ(value_of("upper_left_force_x + upper_right_force_x", world), -50);
  EXPECT_DOUBLE_EQ(value_of("sum(upper_left_force_z, upper_right_force_z, top_force_z)", world), 220);
  EXPECT_DOUBLE_EQ(value_of("max(abs(upper_left_force_x), abs(upper_right_force_x))", world), 120);
}

TEST(Formula, FollowsTheWorld) {
  WatchedWorld world = shear_box();
  FormulaProbe probe;
  probe.curves["b"].formula = "time", probe.curves["a"].formula = "2 * time + top_force_z";
  probe.prepare(world);
  world.now = 7, world.wall[1].force.z() = 1;
  EXPECT_EQ(channel_value(probe, world, "a"), 15);
  EXPECT_EQ(channel_value(probe, world, "b"), 7);
}

TEST(Formula, LooksAtGrainsOnlyForVoidRatio) {
  const WatchedWorld world = shear_box();
  FormulaProbe probe;
  probe.curves["curve"].formula = "time + top_force_x";
  probe.prepare(world);
  channel_value(probe, world, "curve");
  EXPECT_EQ(world.looks, 0);
  probe.curves["curve"].formula = "void_ratio";
  probe.prepare(world);
  channel_value(probe, world, "curve");
  EXPECT_GT(world.looks, 0);
}

TEST(Formula, DescribesItsCurves) {
  FormulaProbe probe;
  probe.curves["ratio"] = {"time / 2", "s", ""};
  probe.curves["stress"] = {"top_pressure", "Pa", "vertical stress, positive in compression"};
  const auto channels = probe.channels();
  EXPECT_EQ(channels[0].name, "ratio");
  EXPECT_EQ(channels[0].unit, "s");
  EXPECT_EQ(channels[0].doc, "time / 2");
  EXPECT_EQ(channels[1].doc, "vertical stress, positive in compression");
}

TEST(Formula, NamesTheNearestVariable) {
  EXPECT_EQ(error_of("2 * top_presure"),
            "curves/curve/formula: found \"2 * top_presure\": the unknown name \"top_presure\" at character 5; did you "
            "mean \"top_pressure\"? Allowed is one of the names time, step, mean_diameter, void_ratio, mass, "
            "departed_mass, centre_x/_y/_z, spread_x/_y/_z, length; of each wall "
            "(upper_left, top): <wall>_force_x/_y/_z, <wall>_travel_x/_y/_z, <wall>_stage_travel_x/_y/_z, "
            "<wall>_velocity_x/_y/_z, <wall>_pressure, <wall>_area");
}

TEST(Formula, SaysWhereItCannotBeRead) {
  EXPECT_EQ(
      error_of("2 + "),
      "curves/curve/formula: found \"2 + \": unexpected end of expression at character 5; allowed is an expression in "
      "muParser's syntax");
  EXPECT_EQ(
      error_of("(time + 1"),
      "curves/curve/formula: found \"(time + 1\": missing parenthesis at character 10; allowed is an expression in "
      "muParser's syntax");
  EXPECT_THAT(error_of("time time"), HasSubstr("at character 6"));
  EXPECT_THAT(error_of("time $ 2"), HasSubstr("at character 6"));
  EXPECT_THAT(error_of(""), HasSubstr("curves/curve/formula: found \"\": "));
  EXPECT_THAT(error_of("sinn(2)"), HasSubstr("the unknown name \"sinn\""));
}

TEST(Formula, NeitherAssignsNorLists) {
  EXPECT_THAT(
      error_of("time = 3"),
      HasSubstr(
          "found \"time = 3\": \"=\" at character 6; allowed is an expression without assignments; \"==\" compares"));
  EXPECT_THAT(error_of("time, step"),
              HasSubstr("found \"time, step\": \",\" at character 5; allowed is an expression with one result"));
}

TEST(Formula, KnowsWallsOfAnyName) {
  WatchedWorld world = shear_box();
  world.wall[0].name = "left.upper+1";
  EXPECT_DOUBLE_EQ(value_of("left_upper_1_force_x", world), -120);
  EXPECT_DOUBLE_EQ(value_of("top_area", world), 4e-4) << "which does not depend on the names of others";
}

TEST(Formula, RefusesNamesThatMeanTwoThings) {
  WatchedWorld world = shear_box();
  world.wall.push_back(world.wall[0]);
  world.wall.back().name = "upper_left";
  EXPECT_EQ(
      error_of("time", world),
      "found two walls that both define the variable \"upper_left_force_x\"; allowed is a variable of one wall; rename "
      "one of the walls upper-left, top, upper_left");

  FormulaProbe probe;
  probe.curves["curve"].formula = "time";
  probe.constants["step"].value = 1;
  EXPECT_THAT([&] { probe.prepare(shear_box()); },
              testing::ThrowsMessage<ParameterError>(
                  "constants/step: found the name of a variable; allowed is a name that is not a variable"));
}

TEST(Formula, ChecksNames) {
  FormulaProbe probe;
  EXPECT_EQ(complaints(probe), "curves: found no curve, allowed: at least one\n");
  probe.curves["Stress Ratio"].formula = "time";
  probe.curves["time"].formula = "step";
  probe.constants["1st"].value = 1;
  EXPECT_EQ(
      complaints(probe),
      "curves: found the name \"Stress Ratio\", allowed: lower-case letters, digits and _, starting with a letter\n"
      "curves: found the name \"time\", allowed: another name: every probe has a series of this one\n"
      "constants: found the name \"1st\", allowed: letters, digits and _, not starting with a digit\n");
}

INSTANTIATE_TEST_SUITE_P(
    Formula, ProbeContract,
    testing::Values(ProbeCase{
        "curves",
        [] {
          auto probe = std::make_shared<FormulaProbe>();
          probe->curves["stress_ratio"].formula = "bottom_force_x / bottom_force_z";
          probe->curves["void_ratio"] = {"void_ratio", "1", "of the interior; infinite without solids"};
          probe->curves["settlement"] = {"-top_wall_travel_z", "m", ""};
          return probe;
        }}),
    probe_case_name);

}  // namespace
}  // namespace grit
