#include "force-field.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "grit/testing/engine.hpp"

namespace grit {
namespace {

std::shared_ptr<ForceField> field(const std::string& x, const std::string& per = "mass") {
  auto made = std::make_shared<ForceField>();
  made->formulas[0] = x, made->per = per;
  return made;
}

INSTANTIATE_TEST_SUITE_P(ForceField, EngineContract,
                         testing::Values(EngineCase{"of_position", [] { return field("-3 * x + vy"); }},
                                         EngineCase{"per_body", [] { return field("radius * time", "body"); }}),
                         engine_case_name);

TEST(ForceField, FollowsItsFormula) {
  FakeWorld world;
  world.add({0.3, 0.2, 0.1}, 2e-3, {0.5, 0, -1});
  const double mass = 1 / world.velocities()[0].w;
  auto engine = field("2 * x + vz * y");
  engine->formulas[2] = "g";
  engine->constants["g"].value = -9.81;
  const auto numbers = acted(*engine, world);
  EXPECT_DOUBLE_EQ(numbers[0], mass * (0.6 - 0.2));
  EXPECT_EQ(numbers[1], 0);
  EXPECT_DOUBLE_EQ(numbers[2], -9.81 * mass);
  engine->constants["g"].value = 1;  // as a ramp does
  EXPECT_DOUBLE_EQ(acted(*engine, world)[2], mass);
  engine->per = "body";
  EXPECT_DOUBLE_EQ(acted(*engine, world)[2], 1);
  engine->formulas[2] = "mass * 3";  // as a stage does
  EXPECT_DOUBLE_EQ(acted(*engine, world)[2], 3 * mass);
}

TEST(ForceField, StatesItsStiffnessAndDamping) {
  FakeWorld world;
  world.add({0.3, 0.2, 0.1}, 2e-3, {0.5, 0, -1});
  const double mass = 1 / world.velocities()[0].w;
  const EngineRates spring = field("-400 * x")->rates(world);
  EXPECT_NEAR(spring.stiffness, 400, 1e-6);
  EXPECT_NEAR(spring.damping, 0, 1e-9);
  EXPECT_NEAR(field("-400 * x", "body")->rates(world).stiffness, 400 / mass, 1e-6 / mass);
  EXPECT_NEAR(field("-7 * vx * abs(vx)")->rates(world).damping, 7, 1e-6) << "2 c |v|";
}

/// What the engine reports of a formula, and of one with a constant of this name.
std::string fault(const std::string& x, const std::string& constant = "k") {
  ForceField engine;
  engine.formulas[0] = x;
  engine.constants[constant].value = 1;
  Parameters parameters;
  engine.declare(parameters);
  std::string text;
  for (const auto& check : parameters.checks())
    check.run([&](std::string_view key, std::string_view found, std::string_view allowed) {
      text += std::string(key) + ": found " + std::string(found) + ", allowed " + std::string(allowed);
    });
  return text;
}

/// An assignment would change what the other formulas see.
TEST(ForceField, AssignsNothing) {
  EXPECT_EQ(fault("x = 5"),
            "x: found \"x = 5\": \"=\" at character 3, allowed an expression without assignments; \"==\" compares");
  EXPECT_THAT(fault("radius=1"), testing::HasSubstr("\"=\" at character 7"));
  EXPECT_THAT(fault("x > 0 ? k = 2 : 0"), testing::HasSubstr("\"=\" at character 11"));
  EXPECT_EQ(fault("x >= 0 && y <= 1 && z != 2 && time == 3 ? k : 0"), "");
}

TEST(ForceField, RefusesConstantsThatMeanTwoThings) {
  EXPECT_EQ(fault("x", "x"), "constants/x: found the name of a variable, allowed a name that is not a variable");
  EXPECT_THAT(fault("time", "time"), testing::HasSubstr("constants/time: found the name of a variable"));
  EXPECT_EQ(fault("x", "2k"),
            "constants/2k: found the name \"2k\", allowed letters, digits and _, not starting with a digit");
}

TEST(ForceField, ReportsWhatItCannotRead) {
  EXPECT_EQ(fault("-3 * x"), "");
  EXPECT_THAT(fault("3 * w"), testing::AllOf(testing::HasSubstr("x: found"), testing::HasSubstr("unknown name \"w\"")));
  EXPECT_THAT(fault("3 *"), testing::HasSubstr("muParser's syntax"));
  EXPECT_THAT(fault("x, y"), testing::HasSubstr("one result"));
}

}  // namespace
}  // namespace grit
