// A servo with a target force moves walls without area and normal.
#include <gtest/gtest.h>

#include "support/scene.hpp"
#include "support/verified.hpp"

namespace grit::test::force_servo_tests {
namespace {

TEST(ForceServo, PressesABallByAnyGeometry) {
  constexpr double radius = 1e-3, force = 0.5;
  const Vec3 axis(0, 0.1, 0);
  const std::vector<std::pair<std::string, Description>> tools{
      {"cylinder",
       {{"start", vector(Vec3(0, 0, 7e-3) - axis)}, {"end", vector(Vec3(0, 0, 7e-3) + axis)}, {"radius", 5e-3}}},
      {"cone", {{"start", {0, 0, 2e-3}}, {"end", {0, 0, 0.1}}, {"start_radius", 0}, {"end_radius", 0.01}}},
      {"box", {{"low", {-0.01, -0.01, 2e-3}}, {"high", {0.01, 0.01, 0.02}}}}};
  for (const auto& [name, shape] : tools) {
    Description d =
        description("linear-frictional", {{"density", 2500}, {"contact_modulus", 1e7}, {"restitution", 0.3}},
                    {{{0, 0, radius}, radius}});
    d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
    d["walls"]["tool"] = shape;
    d["walls"]["tool"].update({{"type", name}, {"inside", false}, {"material", "grain"}});
    d["walls"]["tool"]["motion"]["servo"] = {{"axis", "z"}, {"force", -force}, {"max_velocity", 1}, {"gain", 0.05}};
    Trial press(d);
    press.step(20000);
    const auto walls = press.world().walls();
    const WallView& tool = walls[1];
    ASSERT_EQ(tool.name, "tool");
    verify("force of a " + name + " that a servo presses on a ball [N]", tool.force.z(), force, 1e-6);
    verify("force below the ball that a " + name + " presses [N]", -walls[0].force.z(), force, 1e-6);
  }
}

}  // namespace
}  // namespace grit::test::force_servo_tests
