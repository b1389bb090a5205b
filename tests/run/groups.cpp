// Groups of bodies: held, moved, and acted on by some engines, walls and probes only.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies/regions.hpp"
#include "grit/testing/fake_world.hpp"
#include "kernel/body_groups.hpp"
#include "kernel/group_view.hpp"
#include "support/clump.hpp"
#include "support/notes.hpp"
#include "support/scene.hpp"

namespace grit::test::groups_tests {
namespace {

using testing::HasSubstr;

constexpr double radius = 1e-3, g = 9.81;
const Description material = {{"density", 2600}, {"contact_modulus", 1e6}, {"friction_angle", 0.4}};

/// The grains of the groups "grains" and "others"; those of the latter have higher ids.
Description two_groups(const std::vector<Grain>& grains, const std::vector<Grain>& others) {
  Description d = description("linear-frictional", material, grains);
  d["bodies"]["others"] = description("linear-frictional", material, others)["bodies"]["grains"];
  return d;
}
Description gravity() { return {{"type", "gravity"}, {"acceleration", {0, 0, -g}}}; }

TEST(Groups, AreRefusedBeyondTheirIndices) {
  constexpr std::size_t most = 65536;
  std::vector<std::string> names;
  for (std::size_t i = 0; i <= most; ++i) names.push_back("g" + std::to_string(i));
  Bodies bodies;
  bodies.groups.push_back({names[most - 1], 0});
  bodies.add(Vec3::Zero(), radius, 1, 1, 0);
  EXPECT_EQ(groups_of(bodies, names), std::vector<std::uint16_t>{most - 1});
  bodies.groups.front().name = names[most];
  EXPECT_THAT([&] { groups_of(bodies, names); },
              testing::ThrowsMessage<Error>(
                  HasSubstr("found groups of bodies with the index 65536; allowed are up to 65536 of them")));
}

TEST(Groups, AreCountedBeforeARun) {
  SceneDescription scene(installed());
  for (std::size_t i = 0; i < 65536; ++i) scene.bodies.try_emplace("g" + std::to_string(i), installed());
  Parameters parameters;
  scene.declare(parameters);
  const auto complaints = [&] {
    std::vector<std::string> all;
    for (const Check& check : parameters.checks())
      check.run([&](std::string_view key, std::string_view found, std::string_view allowed) {
        if (key == "bodies") all.push_back(fault_text(std::string(found), std::string(allowed)));
      });
    return all;
  };
  EXPECT_THAT(complaints(), testing::ElementsAre("found 65536 groups; allowed is 65535 or fewer"));
  scene.bodies.erase("g0");
  EXPECT_THAT(complaints(), testing::IsEmpty());
}

TEST(Groups, FixedBodiesCarryOthers) {
  // Three fixed spheres, a ball on top of them.
  const double side = 2.02 * radius, damping = 0.7, safety = 0.01;
  const std::vector<Grain> base{
      {{0, 0, 0}, radius}, {{side, 0, 0}, radius}, {{side / 2, side * std::sqrt(0.75), 0}, radius}};
  const Vec3 middle(side / 2, side * std::sqrt(0.75) / 3, 0);
  Description d = two_groups(base, {{middle + Vec3(0, 0, 1.8 * radius), radius}});
  d["engines"] = {{"gravity", gravity()},
                  {"fixed", {{"type", "prescribed-motion"}, {"groups", {"grains"}}}},
                  {"damping", {{"type", "local-damping"}, {"coefficient", damping}}}};
  d["time_step"]["safety"] = safety;
  Trial t(d, 1, BodyState::energy);
  t.world().energies();
  while (t.world().time() < 0.1) t.step();
  for (std::uint32_t id = 0; id < 3; ++id) {
    EXPECT_EQ(t.position(id), base[id].position);
    EXPECT_EQ(t.velocity(id), Vec3::Zero());
    EXPECT_EQ(xyz(t.world().forces()[index_of(t.world(), id)]), Vec3::Zero()) << "no net force accelerates it";
  }
  EXPECT_EQ(t.world().contacts().size(), 3u);
  EXPECT_LT(t.velocity(3).norm(), 1e-9);
  // The fixed ones would fall if their weight counted.
  EXPECT_LT(equilibrium(t.world()).unbalanced_force, 1e-6);
  EXPECT_TRUE(support(t.world()).at_rest(1e-6));
  // The energy of an impact has an error of (ω dt)²/4 at most (docs/method.md), and ω dt ≤ 2 safety. A rebound keeps
  // (1 − α)/(1 + α) of it, so that all impacts have (1 + α)/(2 α) of what is dissipated.
  const double of_impacts = (1 + damping) / (2 * damping) * t.world().energies().dissipated();
  EXPECT_LT(std::abs(t.world().energies().closure_error), safety * safety * of_impacts);
}

TEST(Groups, MoveAsPrescribedAgainstAnyForce) {
  const Vec3 velocity(0.3, 0, 0.1);
  Description d = two_groups({{{0, 0, 0}, radius}}, {{{2.1 * radius, 0, 0}, radius}});
  d["engines"]["push"] = {{"type", "prescribed-motion"}, {"groups", {"grains"}}, {"velocity", vector(velocity)}};
  d["guards"] = {{"overlap", 0.5}};
  Trial t(d, 1, BodyState::energy);
  const Energies start = t.world().energies();
  EXPECT_DOUBLE_EQ(start.kinetic, 0.5 * t.mass(0) * velocity.squaredNorm()) << "moves from the first instant";
  t.step(3000);
  EXPECT_LT((t.position(0) - t.world().time() * velocity).norm(), 1e-12);
  EXPECT_EQ(t.velocity(0), velocity);
  EXPECT_GT(t.velocity(1).x(), 0.5) << "an elastic impact with an infinite mass: twice 0.3 m/s";
  const Energies now = t.world().energies();
  EXPECT_GT(now.engines, 0);
  EXPECT_LT(std::abs(now.closure_error), 1e-3 * now.engines);
}

TEST(Groups, TurnAsOneRigidBody) {
  for (const bool clumped : {false, true}) {
    const double arm = 5 * radius, rate = 20;
    Description d = two_groups({{{arm, 0, 0}, radius}, {{0, arm, 0.5 * radius}, radius}}, {{{1, 1, 1}, radius}});
    if (clumped) make_clumps(d, boomerang());
    d["engines"]["turn"] = {
        {"type", "prescribed-motion"}, {"groups", {"grains"}}, {"spin", {0, 0, rate}}, {"about", {0, 0, 0}}};
    d["time_step"]["value"] = 2 * std::numbers::pi / rate / 20000;
    Trial t(d);
    std::vector<Vec3> before;
    for (const Row& x : t.world().positions()) before.push_back(xyz(x));
    const std::vector<std::uint32_t> ids(t.world().ids().begin(), t.world().ids().end());
    t.step(5000);  // a quarter turn
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const Vec3& x = before[i];
      const Vec3 turned = t.world().group_of(ids[i]) == "grains" ? Vec3(-x.y(), x.x(), x.z()) : x;
      EXPECT_LT((t.position(ids[i]) - turned).norm(), 1e-11 * arm) << ids[i];
    }
    EXPECT_NEAR(xyz(t.world().spins()[index_of(t.world(), 0)]).z(), rate, 1e-9 * rate);
  }
}

TEST(Groups, PrescribedMotionMayChangeInTime) {
  Description d = two_groups({{{0, 0, 0}, radius}}, {{{1, 0, 0}, radius}});
  d["engines"]["push"] = {{"type", "prescribed-motion"}, {"groups", {"grains"}}};
  d["stages"] = {{{"name", "accelerate"},
                  {"until", {{"type", "time"}, {"value", 0.01}}},
                  {"limit", 1},
                  {"ramps", {{{"pointer", "/engines/push/velocity/0"}, {"from", 0}, {"to", 1}, {"duration", 0.01}}}}},
                 {{"name", "fix"},
                  {"until", {{"type", "time"}, {"value", 0.01}}},
                  {"limit", 1},
                  {"change", {{"engines", {{"push", {{"velocity", {0, 0, 0}}}}}}}}}};
  d["probes"]["watch"] = {{"type", "watch"}, {"every_time", 1e-3}};
  watched() = [](const World& world) { return world.positions()[index_of(world, 0)].x; };
  const Done done = run(d);
  ASSERT_EQ(done.summary().status, "done") << done.summary().message;
  EXPECT_NEAR(done.notes.samples.back().values[0], 0.5 * 0.01, 2e-4) << "50 increments";
  EXPECT_NEAR(done.notes.samples.back().values[0], done.notes.samples[done.notes.samples.size() - 5].values[0], 1e-15);
}

TEST(Groups, HoldSomeAxesOnly) {
  Description d = two_groups({{{0, 0, 0}, radius, {0.1, 0.2, 0}, {1, 2, 3}}}, {{{1, 0, 0}, radius}});
  d["engines"] = {{"gravity", {{"type", "gravity"}, {"acceleration", {1, 2, 3}}}},
                  {"rail", {{"type", "hold"}, {"groups", {"grains"}}, {"translation", "xz"}, {"rotation", "none"}}}};
  Trial t(d);
  t.step(500);
  const double time = t.world().time();
  EXPECT_LT((t.velocity(0) - Vec3(0.1, 0.2 + 2 * time, 0)).norm(), 1e-12);
  EXPECT_LT((t.velocity(1) - time * Vec3(1, 2, 3)).norm(), 1e-12);
}

TEST(Groups, EnginesActOnTheirGroups) {
  Description d = two_groups({{{0, 0, 0}, radius, {1, 0, 0}}}, {{{0.1, 0, 0}, radius, {1, 0, 0}}});
  Description fall = gravity();
  fall["groups"] = {"others"};
  d["engines"] = {{"gravity", fall},
                  {"drag", {{"type", "drag"}, {"viscosity", 1}, {"law", "stokes"}, {"groups", {"grains"}}}}};
  d["time_step"]["value"] = 1e-7;
  Trial t(d, 1, BodyState::energy);
  t.world().energies();
  t.step(10000);
  const double time = t.world().time(), rate = 6 * std::numbers::pi * radius / t.mass(0);
  EXPECT_NEAR(t.velocity(0).x(), std::exp(-rate * time), 1e-4);
  EXPECT_EQ(t.velocity(0).z(), 0);
  EXPECT_EQ(t.velocity(1).x(), 1);
  EXPECT_NEAR(t.velocity(1).z(), -g * time, 1e-12);
  EXPECT_LT(std::abs(t.world().energies().closure_error), 1e-6 * std::abs(t.world().energies().engines));
}

TEST(Groups, ForcesOfPluginsOnOthersAreDiscarded) {
  for (const bool clumped : {false, true}) {
    Description d = two_groups({{{0, 0, 0}, radius}}, {{{0.1, 0, 0}, radius}});
    if (clumped) make_clumps(d, boomerang());
    d["engines"]["field"] = {{"type", "force-field"}, {"z", "5"}, {"groups", {"others"}}};
    d["time_step"]["value"] = 1e-6;
    Trial t(d, 1, BodyState::energy);
    t.world().energies();
    t.step(1000);
    const double speed = 5 * t.world().time();
    for (const std::uint32_t id : t.world().ids()) {
      const double expected = t.world().group_of(id) == "others" ? speed : 0;
      EXPECT_LT((t.velocity(id) - Vec3(0, 0, expected)).norm(), 1e-12) << id;
    }
    const Energies now = t.world().energies();
    EXPECT_NEAR(now.engines, now.kinetic, 1e-9 * now.kinetic);
  }
}

TEST(Groups, WallsActOnTheirGroups) {
  Description d = two_groups({{{0, 0, 1.5 * radius}, radius}}, {{{0.1, 0, 1.5 * radius}, radius}});
  d["engines"]["gravity"] = gravity();
  d["walls"]["sieve"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["sieve"]["groups"] = {"grains"};
  Trial t(d);
  while (t.world().time() < 0.05) t.step();
  EXPECT_GT(t.position(0).z(), 0.9 * radius);
  EXPECT_NEAR(t.position(1).z(), 1.5 * radius - 0.5 * g * std::pow(t.world().time(), 2), 1e-6);
}

TEST(Groups, AServoPressesOnItsGroups) {
  // The lid reaches the lower ball through the higher one, on which it does not act.
  Description d = two_groups({{{0, 0, radius}, radius}}, {{{0.01, 0, 3 * radius}, radius}});
  d["engines"]["hold"] = {{"type", "prescribed-motion"}, {"groups", {"others"}}};
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  d["walls"]["lid"] = plane({0, 0, 5 * radius}, -Vec3::UnitZ());
  d["walls"]["lid"]["groups"] = {"grains"};
  d["walls"]["lid"]["motion"]["servo"] = {{"force", -1e-3}, {"axis", "z"}, {"max_velocity", 0.1}};
  d["engines"]["damping"] = {{"type", "local-damping"}, {"coefficient", 0.5}, {"groups", {"grains"}}};
  Trial t(d);
  while (t.world().time() < 0.1) t.step();
  const WallView& lid = t.world().walls()[1];
  EXPECT_NEAR(lid.force.z(), 1e-3, 1e-5);
  EXPECT_EQ(lid.contacts, 1u);
}

TEST(Groups, ProbesSeeTheirGroups) {
  Description d = two_groups({{{0, 0, 0.99 * radius}, radius}, {{1.98 * radius, 0, 0.99 * radius}, radius}},
                             {{{-1.98 * radius, 0, 0.98 * radius}, 0.99 * radius}});
  d["walls"]["floor"] = plane(Vec3::Zero(), Vec3::UnitZ());
  Trial t(d);
  ASSERT_EQ(t.world().contacts().size(), 5u) << "two between bodies, three with the floor";
  GroupView seen({"grains"});
  seen.update(t.world());
  ASSERT_EQ(seen.ids().size(), 2u);
  EXPECT_EQ(seen.contacts().size(), 3u) << "one between bodies, two with the floor";
  EXPECT_EQ(seen.walls()[0].contacts, 2u);
  double force = 0;
  for (const Contact& contact : seen.contacts_with_walls()) force += contact.force.z();
  EXPECT_DOUBLE_EQ(seen.walls()[0].force.z(), force);
  EXPECT_LT(std::abs(force), std::abs(t.world().walls()[0].force.z()));
  EXPECT_DOUBLE_EQ(seen.mean_diameter(), 2 * radius);
  EXPECT_NEAR(seen.solid_density(), 2600, 1e-9);
  // All groups: everything as in the whole world, also the moment of a wall about its reference point.
  GroupView all({"grains", "others"});
  all.update(t.world());
  EXPECT_EQ(all.contacts().size(), 5u);
  EXPECT_LT((all.walls()[0].moment - t.world().walls()[0].moment).norm(), 1e-12 * t.world().walls()[0].moment.norm());
  EXPECT_DOUBLE_EQ(all.walls()[0].force.z(), t.world().walls()[0].force.z());
}

/// A world that counts what is read of it.
class Counting final : public FakeWorld {
 public:
  std::span<const std::uint32_t> ids() const override { return ++of_ids, FakeWorld::ids(); }
  std::span<const Row> velocities() const override { return ++of_velocities, FakeWorld::velocities(); }
  std::span<const Contact> contacts() const override { return ++of_contacts, FakeWorld::contacts(); }
  std::span<const BodyGroup> groups() const override { return all; }
  std::vector<BodyGroup> all{{"grains", 0}, {"others", 2}, {"grains", 3}};
  mutable int of_ids = 0, of_velocities = 0, of_contacts = 0;
};

TEST(Groups, NothingIsCopiedThatNoProbeAsksFor) {
  Counting world;
  for (int i = 0; i < 4; ++i) world.add({0.0019 * i, 0, 0}, 1e-3);
  for (std::uint32_t i = 0; i < 3; ++i) world.add_contact(i, i + 1, {0.0019, 0, 0}, {1.0 + i, 0, 0});
  GroupView grains({"grains"});
  grains.update(world);
  EXPECT_THAT(grains.ids(), testing::ElementsAre(0, 1, 3));
  EXPECT_EQ(grains.positions().size(), 3u);
  EXPECT_EQ(world.of_velocities, 0);
  EXPECT_EQ(world.of_contacts, 0);
  ASSERT_EQ(grains.contacts().size(), 1u) << "of bodies 0 and 1; 3 touches only the other group";
  EXPECT_EQ(grains.contacts()[0].force.x(), 1);
  EXPECT_EQ(world.of_contacts, 1) << "kept until the next update";
  world.contact[0].force.x() = 5;
  grains.update(world);
  EXPECT_EQ(grains.contacts()[0].force.x(), 5);
  EXPECT_EQ(world.of_contacts, 2);
}

/// A conical heap beside a pillar of another group, which is higher.
TEST(Groups, AHeapBesideOtherBodies) {
  FakeWorld sand;
  constexpr double slope = 0.5, height = 0.01;
  for (int i = -20; i < 20; ++i)
    for (int j = -20; j < 20; ++j) {
      const double x = (i + 0.5) * 1e-3, y = (j + 0.5) * 1e-3, top = height - slope * std::hypot(x, y);
      if (top > 0) sand.add({x, y, top - 0.5e-3}, 0.5e-3);
    }
  const auto heap_end = static_cast<std::uint32_t>(sand.id.size());
  for (std::uint32_t i = 0; i + 1 < heap_end; ++i) sand.add_contact(i, i + 1, {1e-3, 0, 0}, {1, 0, 0});
  Counting all;
  static_cast<FakeWorld&>(all) = sand;
  all.all = {{"sand", 0}, {"pillar", heap_end}};
  for (int i = 0; i < 20; ++i) all.add({0.03, 0, 2e-3 * i}, 1e-3);
  for (std::uint32_t i = heap_end; i + 1 < all.id.size(); ++i) all.add_contact(i, i + 1, {0, 0, 2e-3}, {0, 0, 1});
  GroupView seen({"sand"});
  seen.update(all);
  const auto heap = installed().make<Probe>("heap");
  const auto channel_value = [&](const World& world, const std::string& name) {
    ChannelValues values("the heap", heap->channels());
    heap->sample(world, values);
    return values.list(name)[0];
  };
  EXPECT_NEAR(channel_value(seen, "angle"), std::atan(slope), 1e-9);
  for (const char* channel : {"angle", "angle_deviation", "height", "radius"})
    EXPECT_EQ(channel_value(seen, channel), channel_value(sand, channel)) << channel;
  EXPECT_NE(channel_value(all, "height"), channel_value(sand, "height"));
}

TEST(Groups, AProbeOfAGroupInARun) {
  Description d = two_groups({{{0, 0, 0}, radius}, {{0.1, 0, 0}, radius}}, {{{0.2, 0, 0}, radius}});
  d["probes"]["one"] = {{"type", "watch"}, {"every_steps", 1}, {"groups", {"others"}}};
  d["probes"]["all"] = {{"type", "watch"}, {"every_steps", 1}};
  watched() = [](const World& world) { return static_cast<double>(world.ids().size()); };
  const Done done = run(d);
  for (const auto& sample : done.notes.samples) EXPECT_EQ(sample.values[0], sample.probe == "one" ? 1 : 3);
  d["probes"]["energy"] = {{"type", "energy"}, {"every_steps", 1}, {"groups", {"others"}}};
  try {
    run(d);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the energy balance is that of all bodies"));
  }
}

TEST(Groups, ThatDoNotExistAreReported) {
  for (const std::string where : {"/engines/gravity/groups/0", "/walls/floor/groups/0", "/probes/all/groups/0"}) {
    Description d = two_groups({{{0, 0, 0}, radius}}, {{{1, 0, 0}, radius}});
    d["engines"]["gravity"] = gravity();
    d["walls"]["floor"] = plane({0, 0, -1}, Vec3::UnitZ());
    d["probes"]["all"] = {{"type", "packing"}, {"every_steps", 1}};
    d[Description::json_pointer(where.substr(0, where.size() - 2))] = {"other"};
    try {
      scene_of(d);
      FAIL() << where;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(where));
      EXPECT_THAT(error.what(), HasSubstr("did you mean \"others\""));
    }
  }
}

/// What is wrong with the engines of two groups, or with their change in a stage.
std::string fault_of(const Description& engines, const Description& change = Description::object()) {
  Description d = two_groups({{{0, 0, 0}, radius}}, {{{1, 0, 0}, radius}});
  d["engines"] = engines;
  if (!change.empty()) d["stages"][0]["change"] = {{"engines", change}};
  try {
    scene_of(d);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "";
}
Description moving(const Vec3& velocity, const Vec3& spin = Vec3::Zero()) {
  return {{"type", "prescribed-motion"}, {"velocity", vector(velocity)}, {"spin", vector(spin)}};
}
Description of_group(Description engine, const std::string& group) {
  engine["groups"] = {group};
  return engine;
}

TEST(Groups, EnginesThatContradictEachOtherAreReported) {
  const Description along_x = moving({0.1, 0, 0}), along_y = moving({0, 0.2, 0});
  EXPECT_EQ(fault_of({{"p1", along_x}, {"p2", along_y}}),
            "test: /engines/p2: found a prescribed motion of the group \"grains\", which the engine \"p1\" sets "
            "differently; allowed is one of them for each group; limit them to different groups, or remove one");
  EXPECT_EQ(fault_of({{"p1", of_group(along_x, "grains")}, {"p2", of_group(along_y, "others")}}), "");
  EXPECT_THAT(fault_of({{"p1", of_group(along_x, "others")}, {"p2", along_y}}), HasSubstr("group \"others\""));
  EXPECT_EQ(fault_of({{"p1", along_x}, {"p2", along_x}}), "");
  EXPECT_THAT(fault_of({{"p1", along_x}, {"p2", along_x}}, {{"p1", {{"velocity", {0, 0, 1}}}}}),
              HasSubstr("/engines/p2: found a prescribed motion"))
      << "after a change";
  EXPECT_THAT(fault_of({{"a", {{"type", "planar"}, {"normal", "y"}}}, {"b", {{"type", "planar"}, {"normal", "z"}}}}),
              HasSubstr("/engines/b: found a plane of motion of the group"));
  EXPECT_THAT(fault_of({{"a", {{"type", "local-damping"}, {"coefficient", 0.7}}},
                        {"b", {{"type", "local-damping"}, {"coefficient", 0}}}}),
              HasSubstr("/engines/b: found a local damping of the group"));
  EXPECT_EQ(fault_of({{"a", gravity()}, {"b", {{"type", "gravity"}, {"acceleration", {1, 0, 0}}}}}), "") << "a sum";
}

TEST(Groups, MotionsAlongHeldAxesAreReported) {
  const auto holding = [](const std::string& translation, const std::string& rotation) {
    return Description{{"type", "hold"}, {"translation", translation}, {"rotation", rotation}};
  };
  EXPECT_EQ(fault_of({{"hold", holding("xz", "none")}, {"push", moving({0.1, 0, 0})}}),
            "test: /engines/push: found a prescribed motion of the group \"grains\" along x, which the engine \"hold\" "
            "holds; allowed is another axis, or an engine \"hold\" for other groups");
  EXPECT_EQ(fault_of({{"hold", holding("xz", "xyz")}, {"push", moving({0, 0.1, 0})}}), "");
  EXPECT_EQ(fault_of({{"hold", holding("xyz", "xyz")}, {"fixed", moving(Vec3::Zero())}}), "");
  EXPECT_THAT(fault_of({{"hold", holding("none", "y")}, {"turn", moving(Vec3::Zero(), {0, 3, 0})}}),
              HasSubstr("/engines/turn: found a prescribed motion of the group \"grains\" about y"));
  EXPECT_THAT(fault_of({{"hold", holding("z", "none")}, {"turn", moving(Vec3::Zero(), {0, 3, 0})}}),
              HasSubstr("along z"))
      << "a rotation about y moves along x and z";
  EXPECT_EQ(fault_of({{"hold", holding("y", "x")}, {"turn", moving(Vec3::Zero(), {0, 3, 0})}}), "");
}

TEST(Groups, MotionsOutOfTheirPlaneAreReported) {
  const auto in_plane = [](const Description& motion) {
    return fault_of({{"flat", {{"type", "planar"}, {"normal", "y"}}}, {"move", motion}});
  };
  EXPECT_EQ(in_plane(moving({0, 1, 0})),
            "test: /engines/move: found a prescribed motion of the group \"grains\" out of the plane of the engine "
            "\"flat\"; allowed is a velocity across y and a spin about it, or other groups");
  EXPECT_THAT(in_plane(moving(Vec3::Zero(), {1, 0, 0})), HasSubstr("out of the plane"));
  EXPECT_EQ(in_plane(moving({1, 0, 2}, {0, 5, 0})), "");
}

// ---- sinks

TEST(Sink, RemovesWhatEntersItsRegion) {
  Description d = two_groups({{{0, 0, 0.02}, radius, {0, 0, -0.5}}, {{0.1, 0, 0.02}, radius, {0, 0, -0.5}}},
                             {{{0, 0, 0.03}, radius, {0, 0, -0.5}}});
  d["engines"]["sink"] = {{"type", "sink"},
                          {"groups", {"grains"}},
                          {"region", {{"type", "box"}, {"low", {-0.01, -0.01, 0}}, {"high", {0.01, 0.01, 0.01}}}}};
  Trial t(d, 1, BodyState::energy);
  t.world().energies();
  double entered = 0;
  while (t.world().time() < 0.06) {
    t.step();
    if (t.world().departures().empty()) entered = t.world().time();
  }
  ASSERT_EQ(t.world().departures().size(), 1u);
  EXPECT_EQ(t.world().departures()[0].id, 0u);
  EXPECT_NEAR(entered, 0.02, 2e-3) << "after 1 cm at 0.5 m/s, within less than a radius";
  EXPECT_LE(t.world().departures()[0].position.z(), 0.01);
  EXPECT_EQ(t.world().ids().size(), 2u);
  EXPECT_NEAR(t.kernel().state().discharged_fraction(), 1.0 / 3, 1e-9);
  EXPECT_NEAR(t.world().energies().closure_error, 0, 1e-9 * t.world().energies().kinetic);
}

TEST(Sink, TakesAClumpAsAWhole) {
  Description d = two_groups({{{0, 0, 0.01}, radius, {0, 0, -0.5}}}, {{{0.1, 0, 0.03}, radius}});
  make_clumps(d, boomerang());
  d["engines"]["sink"] = {{"type", "sink"}, {"region", {{"type", "half-space"}, {"point", {0, 0, 0}}}}};
  Trial t(d);
  ASSERT_EQ(t.world().ids().size(), 4u);
  while (t.world().time() < 0.03) t.step();
  EXPECT_EQ(t.world().ids().size(), 1u);
  EXPECT_TRUE(t.world().clumps().empty());
  ASSERT_EQ(t.world().departures().size(), 1u);
}

TEST(Sink, RegionsContainTheirPoints) {
  const CylinderRegion pipe{.start = {0, 0, 1}, .end = {0, 0, 3}, .radius = 0.5};
  EXPECT_TRUE(contains(pipe, {0.3, 0.4, 1}));
  EXPECT_TRUE(contains(pipe, {0, 0.5, 3}));
  EXPECT_FALSE(contains(pipe, {0.4, 0.4, 2}));
  EXPECT_FALSE(contains(pipe, {0, 0, 0.99}));
  EXPECT_FALSE(contains(pipe, {0, 0, 3.01}));
  const SphereRegion ball{.centre = {1, 0, 0}, .radius = 1};
  EXPECT_TRUE(contains(ball, {0, 0, 0}));
  EXPECT_FALSE(contains(ball, {-0.01, 0, 0}));
  const HalfSpaceRegion below{.point = {0, 0, 1}, .normal = {1, 0, 1}};
  EXPECT_TRUE(contains(below, {-5, 0, 5}));
  EXPECT_FALSE(contains(below, {1, 0, 1}));
  const BoxRegion box{.low = {0, 0, 0}, .high = {1, 2, 3}};
  EXPECT_TRUE(contains(box, {1, 2, 3}));
  EXPECT_FALSE(contains(box, {1, 2, 3.01}));
}

}  // namespace
}  // namespace grit::test::groups_tests
