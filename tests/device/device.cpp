// Runs on a device, emulated on the CPU, beside those of the CPU engine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "grit/error.hpp"
#include "grit/simulation.hpp"
#include "support/clump.hpp"
#include "support/packing.hpp"

namespace grit::test::device_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double spacing = 1e-3, side = 7 * spacing;

SimulationOptions on(DeviceKind device, unsigned threads = 1) {
  return {.threads = threads,
          .device = device,
          .plugin_path = {GRIT_PLUGIN_DIR},
          .state = BodyState::rotation | BodyState::displacement};
}

/// A dense periodic box of grains that move at random, in two chunks.
Description box(const std::string& law = "linear-rolling") {
  Description d = description(law, {{"density", 2600}, {"contact_modulus", 1e7}, {"friction_angle", 0.4}},
                              jumble({7, 7, 7}, spacing, 0.05, 3));
  d["domain"] = {{"low", {0, 0, 0}}, {"high", {side, side, side}}, {"periodic", {true, true, true}}};
  d["guards"]["overlap"] = 0.5;
  d["stages"][0]["until"]["value"] = 400;
  return d;
}
Description sheared() {
  Description d = box();
  d["domain"]["strain_rate"] = {-2, 1, 0.5};
  d["domain"]["shear_rate"] = {{"xy", 20}, {"xz", -10}, {"yz", 5}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.3}};
  return d;
}
Description of_two_materials() {
  Description d = box();
  d["materials"]["other"] = {{"density", 1500}, {"contact_modulus", 3e6}, {"restitution", 0.6}};
  d["bodies"]["more"] = d["bodies"]["grains"];
  auto &first = d["bodies"]["grains"]["source"]["bodies"], &second = d["bodies"]["more"]["source"]["bodies"];
  d["bodies"]["more"]["material"] = "other";
  for (std::size_t i = 0; i < 100; ++i) first.erase(first.begin());
  second.erase(second.begin() + 100, second.end());
  return d;
}
/// Grains that fall without walls, in a cell that is periodic along x only.
Description falling() {
  Description d = box("hertz-mindlin");
  d["materials"]["grain"].erase("contact_modulus");
  d["materials"]["grain"]["young_modulus"] = 1e7;
  d["domain"]["low"][2] = d["domain"]["low"][1] = -1, d["domain"]["high"][2] = d["domain"]["high"][1] = 1;
  d["domain"]["periodic"] = {true, false, false};
  d["engines"]["gravity"] = {{"type", "gravity"}};
  d["time_step"] = {{"value", 2e-6}};
  return d;
}
/// Contacts stiffen, and the time step follows from the overlaps: its rounding errors are those of small differences.
Description stiffening() {
  Description d = falling();
  d.erase("time_step");
  return d;
}
Description cohesive() {
  Description d = box("jkr");
  d["materials"]["grain"] = {{"density", 2600}, {"young_modulus", 1e7}, {"surface_energy", 0.05}};
  return d;
}

struct Difference {
  double position = 0, velocity = 0, rotation = 0;  ///< largest, in spacings, m/s and rad
};
Difference difference(const World& a, const World& b) {
  Difference most;
  EXPECT_EQ(a.positions().size(), b.positions().size());
  for (std::size_t i = 0; i < a.positions().size(); ++i) {
    const std::size_t j = index_of(b, a.ids()[i]);
    const auto further = [](double& largest, double found) { largest = std::max(largest, found); };
    further(most.position, (a.displacements()[i] - b.displacements()[j]).norm() / spacing);
    further(most.velocity, (xyz(a.velocities()[i]) - xyz(b.velocities()[j])).norm());
    further(most.rotation, (a.rotations()[i] - b.rotations()[j]).norm());
  }
  return most;
}
double furthest(const World& world) {
  double most = 0;
  for (const Vec3& way : world.displacements()) most = std::max(most, way.norm() / spacing);
  return most;
}

struct Named {
  const char* name;
  Description (*scene)();
  double within = 1e-9;  ///< of what the CPU finds
};
void PrintTo(const Named& one, std::ostream* out) { *out << one.name; }

class OnDevice : public testing::TestWithParam<Named> {};

TEST_P(OnDevice, StepsAsTheCpuDoes) {
  const Description scene = GetParam().scene();
  Simulation cpu(scene, on(DeviceKind::none)), device(scene, on(DeviceKind::emulated));
  for (const std::size_t steps : {1u, 99u, 200u}) {
    cpu.step(steps), device.step(steps);
    ASSERT_NEAR(device.world().time(), cpu.world().time(), GetParam().within * cpu.world().time());
    const Difference found = difference(cpu.world(), device.world());
    EXPECT_LT(found.position, GetParam().within) << steps;
    EXPECT_LT(found.velocity, GetParam().within) << steps;
    EXPECT_LT(found.rotation, GetParam().within) << steps;
  }
  EXPECT_GT(furthest(cpu.world()), 0.1) << "so that neighbours are searched again";
  EXPECT_GT(cpu.world().contacts().size(), 5u);
  EXPECT_EQ(cpu.world().contacts().size(), device.world().contacts().size());
}

TEST_P(OnDevice, ThreadsChangeNoBit) {
  const Description scene = GetParam().scene();
  Simulation one(scene, on(DeviceKind::emulated, 1)), three(scene, on(DeviceKind::emulated, 3));
  one.step(300), three.step(300);
  EXPECT_EQ(difference(one.world(), three.world()).velocity, 0);
}

TEST_P(OnDevice, SamplingChangesNoBit) {
  const Description scene = GetParam().scene();
  Simulation plain(scene, on(DeviceKind::emulated)), sampled(scene, on(DeviceKind::emulated));
  std::size_t contacts = 0;
  double pushed = 0;
  sampled.every_steps(
      7, [&](const World& world) { contacts += world.contacts().size(), pushed += std::abs(world.forces()[0].x); });
  for (int k = 0; k < 30; ++k) sampled.step(10), sampled.save();
  plain.step(300);
  EXPECT_GT(contacts, 0u);
  EXPECT_GT(pushed, 0);
  const Difference found = difference(plain.world(), sampled.world());
  EXPECT_EQ(found.position, 0);
  EXPECT_EQ(found.velocity, 0);
  EXPECT_EQ(found.rotation, 0);
}

TEST_P(OnDevice, ResumesWithTheSameBits) {
  const Description scene = GetParam().scene();
  Simulation whole(scene, on(DeviceKind::emulated)), first(scene, on(DeviceKind::emulated));
  whole.step(313), first.step(113);
  SimulationOptions options = on(DeviceKind::emulated);
  options.checkpoint = first.save();
  Simulation second(scene, options);
  second.step(200);
  const Difference found = difference(whole.world(), second.world());
  EXPECT_EQ(found.position, 0);
  EXPECT_EQ(found.velocity, 0);
}

TEST_P(OnDevice, TheOtherEngineContinues) {
  const Description scene = GetParam().scene();
  Simulation cpu(scene, on(DeviceKind::none));
  cpu.step(150);
  const Checkpoint half = cpu.save();
  cpu.step(100);
  for (const auto& [before, after] :
       {std::pair(DeviceKind::none, DeviceKind::emulated), std::pair(DeviceKind::emulated, DeviceKind::none)}) {
    Simulation first(scene, on(before));
    first.step(150);
    SimulationOptions options = on(after);
    options.checkpoint = first.save();
    Simulation second(scene, options);
    second.step(100);
    const Difference found = difference(cpu.world(), second.world());
    EXPECT_LT(found.position, GetParam().within);
    EXPECT_LT(found.velocity, GetParam().within);
  }
}

TEST_P(OnDevice, ConservesMomentum) {
  Description scene = GetParam().scene();
  scene.erase("engines");
  scene["domain"].erase("strain_rate"), scene["domain"].erase("shear_rate");
  Simulation device(scene, on(DeviceKind::emulated));
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    double size = 0;
    for (const Row& v : device.world().velocities()) sum += xyz(v) / v.w, size += xyz(v).norm() / v.w;
    return std::pair(sum, size);
  };
  const Vec3 before = momentum().first;
  device.step(300);
  const auto [after, size] = momentum();
  EXPECT_LT((after - before).norm(), 1e-13 * size);
}

INSTANTIATE_TEST_SUITE_P(Scenes, OnDevice,
                         testing::Values(Named{"Box", [] { return box(); }}, Named{"Sheared", &sheared},
                                         Named{"TwoMaterials", &of_two_materials}, Named{"Falling", &falling},
                                         Named{"Stiffening", &stiffening, 1e-4}, Named{"Cohesive", &cohesive}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Device, TakesStagesThatChangeTheScene) {
  Description scene = box();
  scene["stages"][0]["until"]["value"] = 100;
  scene["stages"].push_back(scene["stages"][0]);
  scene["stages"][1]["name"] = "other";
  scene["stages"][1]["change"] = {{"materials", {{"grain", {{"friction_angle", 0.1}, {"contact_modulus", 2e7}}}}}};
  Simulation cpu(scene, on(DeviceKind::none)), device(scene, on(DeviceKind::emulated));
  cpu.run(), device.run();
  EXPECT_LT(difference(cpu.world(), device.world()).position, 1e-9);
  EXPECT_TRUE(device.done());
}

TEST(Device, TakesBodiesThatAppear) {
  Description scene = box();
  scene["bodies"]["late"] = scene["bodies"]["grains"];
  auto& grains = scene["bodies"]["grains"]["source"]["bodies"];
  scene["bodies"]["late"]["stage"] = "other";
  scene["bodies"]["late"]["source"]["bodies"] = Description::array({grains.back()});
  grains.erase(grains.size() - 1);
  for (auto& grain : grains) grain["velocity"] = {0, 0, 0}, grain["radius"] = 0.4 * spacing;
  scene["bodies"]["late"]["source"]["bodies"][0]["radius"] = 0.4 * spacing;
  scene["stages"][0]["until"]["value"] = 100;
  scene["stages"].push_back(scene["stages"][0]);
  scene["stages"][1]["name"] = "other";
  Simulation cpu(scene, on(DeviceKind::none)), device(scene, on(DeviceKind::emulated));
  cpu.run(), device.run();
  EXPECT_EQ(device.world().positions().size(), 343u);
  EXPECT_LT(difference(cpu.world(), device.world()).position, 1e-9);
}

TEST(Device, ReportsTheBodyThatTrippedAGuard) {
  Description scene = box();
  scene["guards"]["overlap"] = 0.25;
  scene["bodies"]["grains"]["source"]["bodies"][0]["velocity"] = {20, 0, 0};
  Simulation device(scene, on(DeviceKind::emulated));
  EXPECT_THAT([&] { device.step(400); },
              testing::ThrowsMessage<NumericsError>(AllOf(HasSubstr("overlaps body "), HasSubstr("/guards/overlap"))));
  double largest = 0;
  for (const Contact& one : device.world().contacts()) largest = std::max(largest, one.overlap);
  EXPECT_GT(largest, 0.2 * 0.4 * spacing) << "the world is that of the failure";
}

/// Has one obstacle for a device.
struct Obstacle {
  const char* name;
  const char* pointer;
  void (*put)(Description&);
  const char* message;
};
void PrintTo(const Obstacle& one, std::ostream* out) { *out << one.name; }

class DeviceObstacles : public testing::TestWithParam<Obstacle> {};

TEST_P(DeviceObstacles, AreRefusedByName) {
  Description scene = box();
  GetParam().put(scene);
  EXPECT_THAT([&] { Simulation(scene, on(DeviceKind::emulated)); },
              testing::ThrowsMessage<DescriptionError>(AllOf(HasSubstr(std::string("/") + GetParam().pointer + ": "),
                                                             HasSubstr(GetParam().message),
                                                             HasSubstr("run it without --device"))));
  EXPECT_NO_THROW(Simulation(scene, on(DeviceKind::none)));
}

void put_wall(Description& d) {
  d["domain"]["periodic"][2] = false;
  d["walls"]["floor"] = plane({0, 0, -spacing}, {0, 0, 1});
}
void put_clump(Description& d) {
  make_clumps(d, boomerang());
  auto& list = d["bodies"]["grains"]["source"]["bodies"];
  list.erase(list.begin() + 1, list.end());
}
void put_groups(Description& d) {
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.1}, {"groups", {"grains"}}};
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, DeviceObstacles,
    testing::Values(Obstacle{"SinglePrecision", "contacts/precision",
                             [](Description& d) { d["contacts"]["precision"] = "single"; }, "double precision only"},
                    Obstacle{"Walls", "walls/floor", &put_wall, "no walls yet"},
                    Obstacle{"Clumps", "bodies", &put_clump, "no clumps yet"},
                    Obstacle{"ForceField", "engines/field",
                             [](Description& d) {
                               d["engines"]["field"] = {{"type", "force-field"}, {"x", "1e-6"}};
                             },
                             "no engines yet"},
                    Obstacle{"Motion", "engines",
                             [](Description& d) {
                               d["engines"]["drive"] = {{"type", "prescribed-motion"}};
                             },
                             "cannot prescribe the motion"},
                    Obstacle{"Groups", "engines", &put_groups, "all groups of bodies alike"},
                    Obstacle{"Servo", "domain/servo",
                             [](Description& d) {
                               d["domain"]["servo"] = {{"stress", {{"xx", 1e3}}}, {"max_strain_rate", 1}};
                             },
                             "no servo of the cell"},
                    Obstacle{
                        "OpenSides", "domain/open_sides",
                        [](Description& d) { d["domain"]["periodic"][2] = false, d["domain"]["open_sides"] = {"-z"}; },
                        "no open sides"},
                    Obstacle{"Energy", "probes",
                             [](Description& d) {
                               d["probes"]["energy"] = {{"type", "energy"}, {"every_steps", 10}};
                             },
                             "no energy balance"}),
    [](const auto& one) { return std::string(one.param.name); });

TEST(Device, RefusesALaterStageWhenItBegins) {
  Description scene = box();
  scene["stages"][0]["until"]["value"] = 10;
  scene["stages"].push_back(scene["stages"][0]);
  scene["stages"][1]["name"] = "other";
  scene["stages"][1]["growth"] = {{"rate", 0.1}};
  Simulation device(scene, on(DeviceKind::emulated));
  EXPECT_THAT([&] { device.run(); },
              testing::ThrowsMessage<DescriptionError>(HasSubstr("/stages: devices cannot let bodies grow yet")));
}

}  // namespace
}  // namespace grit::test::device_tests
