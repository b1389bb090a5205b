#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "components.hpp"
#include "description/current_scene.hpp"
#include "folder.hpp"
#include "input/scene.hpp"
#include "plugins/parameter_values.hpp"

using namespace grit;
using testing::HasSubstr;

namespace {

class SceneTest : public testing::Test {
 protected:
  SceneTest() : registry_({}) { add_components(registry_); }

  Scene good(const std::string& name, const std::vector<std::string>& sets = {}) const {
    return load_scene(std::string(GRIT_SOURCE_DIR) + "/tests/input/good/" + name + ".json", sets, registry_);
  }
  std::string problems_of(const std::string& name, const std::vector<std::string>& sets) const {
    try {
      good(name, sets);
    } catch (const DescriptionError& error) {
      return error.what();
    }
    return {};
  }
  static Description at(const SceneDescription& scene, const std::string& pointer) {
    return resolved(scene).value(Description::json_pointer(pointer), Description());
  }

  Registry registry_;
};

}  // namespace

TEST_F(SceneTest, ReadsIntoTypes) {
  const Scene scene = good("everything");
  const auto& s = *scene.description;
  EXPECT_EQ(s.seed, 7);
  EXPECT_EQ(s.contacts.type(), "spring");
  EXPECT_EQ(s.materials.at("sand").density, 2600);
  EXPECT_EQ(s.units_of("interfaces"), (std::vector<std::string>{"sand+steel", "sand+sand"}));
  EXPECT_EQ(s.domain.strain_rate, Vec3(0.01, 0, 0));
  EXPECT_EQ(std::get<ListSource>(s.bodies.at("wanderers").source.value()).bodies.at(0).radius, 1e-3);
  EXPECT_EQ(std::get<FileSource>(s.bodies.at("saved").source.value()).path,
            std::string(GRIT_SOURCE_DIR) + "/tests/input/good/grains.txt");
  EXPECT_EQ(s.walls.at("lid").motion.servo->pressure, 2e5);
  const OscillationDescription& shaken = *s.walls.at("cup").motion.oscillation;
  EXPECT_EQ(shaken.amplitude, Vec3(1e-4, 0, 0));
  EXPECT_EQ(shaken.angle, Vec3(0, 0, 0.5));
  EXPECT_EQ(shaken.frequency, 2000);
  EXPECT_EQ(shaken.phase, -0.25);
  EXPECT_EQ(shaken.phases_of_displacement(), Vec3(90 * 0.017453292519943295 - 0.25, -0.25, -0.25));
  EXPECT_EQ(shaken.phases_of_rotation(), Vec3(-0.25, -0.25, 0.25));
  const MotionDescription& turned = s.walls.at("floor").motion;
  EXPECT_EQ(turned.surface_velocity, Vec3(2, 0, 0));
  EXPECT_NEAR(turned.surface_spin.z(), 10 * 2 * std::numbers::pi / 60, 1e-15);
  EXPECT_EQ(turned.free_rotation->axis, Vec3(0, 1, 0));
  EXPECT_EQ(turned.free_rotation->inertia, 0.1);
  EXPECT_EQ(turned.free_rotation->moment, 2);
  EXPECT_EQ(s.walls.at("cup").geometry.type(), "mesh");
  EXPECT_EQ(s.engines.at("damping").engine.type(), "damping");
  EXPECT_EQ(s.probes.at("curve").cadence.every_time, 1e-3);
  EXPECT_EQ(s.stages.size(), 2u);
  EXPECT_EQ(s.output.picture->view, "xy");
  EXPECT_EQ(s.output.references.at("laboratory").curve->file,
            std::string(GRIT_SOURCE_DIR) + "/tests/input/good/laboratory.csv");
  EXPECT_EQ(s.output.references.at("slope").value, 0.6);
}

TEST_F(SceneTest, ChangesAndRampsStay) {
  const Scene scene = good("everything");
  ASSERT_EQ(scene.stages.size(), 2u);
  CurrentScene current(*scene.description, scene.stages);
  const SceneDescription& now = current.now();
  EXPECT_EQ(at(now, "/materials/sand/friction_angle"), 18 * 0.017453292519943295);
  current.begin_stage();
  EXPECT_EQ(scene.stages[0].increments(), 0u);
  EXPECT_EQ(resolved(now), resolved(*scene.description));
  EXPECT_TRUE(now.engines.contains("damping"));

  current.begin_stage();
  EXPECT_EQ(at(now, "/materials/sand/friction_angle"), 10 * 0.017453292519943295);
  EXPECT_FALSE(now.engines.contains("damping"));
  EXPECT_EQ(now.domain.strain_rate, Vec3::Zero());
  const auto pressure = [&] { return now.walls.at("lid").motion.servo->pressure; };
  EXPECT_EQ(pressure(), 200e3);
  ASSERT_EQ(scene.stages[1].increments(), 3u);
  EXPECT_TRUE(current.advance_ramps(1).replaced);
  EXPECT_EQ(pressure(), 150e3);
  EXPECT_FALSE(current.advance_ramps(2).replaced) << "only the number is set";
  EXPECT_EQ(pressure(), 100e3);
  EXPECT_EQ(current.advance_ramps(2).ramp, nullptr) << "done already";
  current.advance_ramps(3);
  EXPECT_EQ(pressure(), 50e3);
  EXPECT_EQ(at(now, "/materials/sand/friction_angle"), 10 * 0.017453292519943295);
}

TEST_F(SceneTest, RampsFollowEachOtherAndReachIntoLists) {
  const Scene scene = good(
      "plain",
      {R"(/stages/0/ramps=[{"pointer": "/walls/floor/motion/velocity/0", "from": 0, "to": "1 mm/s", "duration": 1, "increments": 2},
                           {"pointer": "/guards/overlap", "from": "20 %", "to": 0.3, "duration": 1, "increments": 1}])",
       R"(/stages/-={"name": "after", "until": {"type": "time", "value": 1}, "limit": 2})"});
  ASSERT_EQ(scene.stages.at(0).increments(), 3u);
  CurrentScene current(*scene.description, scene.stages), hurried(*scene.description, scene.stages),
      early(*scene.description, scene.stages);
  const SceneDescription& now = current.now();
  const auto velocity = [](const SceneDescription& one) { return one.walls.at("floor").motion.velocity; };
  current.begin_stage();
  current.advance_ramps(1);
  EXPECT_EQ(velocity(now), Vec3(0.5e-3, 0, 0));
  current.advance_ramps(2);
  EXPECT_EQ(velocity(now), Vec3(1e-3, 0, 0));
  EXPECT_EQ(now.guards.overlap, GuardsDescription().overlap);
  current.advance_ramps(3);
  EXPECT_EQ(now.guards.overlap, 0.3);
  EXPECT_EQ(velocity(now), Vec3(1e-3, 0, 0));
  current.begin_stage();
  EXPECT_EQ(now.guards.overlap, 0.3);
  EXPECT_EQ(velocity(now), Vec3(1e-3, 0, 0));
  EXPECT_EQ(scene.description->guards.overlap, GuardsDescription().overlap);

  hurried.begin_stage();
  hurried.advance_ramps(3);
  EXPECT_EQ(resolved(hurried.now()), resolved(now)) << "all increments at once";
  early.begin_stage();
  early.begin_stage();
  EXPECT_EQ(resolved(early.now()), resolved(now)) << "a stage that ends before its ramps do";
}

// A description is a value: a copy is independent.
TEST_F(SceneTest, CopiesAreIndependent) {
  const Scene scene = good("everything");
  SceneDescription copy = *scene.description;
  const Description before = resolved(copy);
  EXPECT_EQ(before, resolved(*scene.description));
  Parameters parameters;
  copy.declare_unit("materials", "sand", nullptr, parameters);
  const std::vector<std::string> keys{"friction_angle"};
  find_number(parameters, keys)->set(0.25);
  copy.walls.at("lid").motion.servo->pressure = 1;
  EXPECT_EQ(at(copy, "/materials/sand/friction_angle"), 0.25);
  EXPECT_EQ(resolved(*scene.description), before);
}

TEST_F(SceneTest, ExtendingFilesAndSets) {
  const Scene scene = good("extending", {"/seed=5", "/walls/lid/motion/servo/gain=20 %"});
  EXPECT_EQ(scene.description->title, "a lighter lid");
  EXPECT_EQ(scene.description->seed, 5);
  EXPECT_EQ(scene.description->walls.at("lid").motion.servo->pressure, 1e5);
  EXPECT_EQ(scene.description->walls.at("lid").motion.servo->gain, 0.2);
  EXPECT_FALSE(scene.description->walls.contains("floor"));
  EXPECT_EQ(problems_of("plain", {"/sed=5"}).find("--set: /sed: unknown key \"sed\"; did you mean \"seed\"?"), 0u);
}

TEST_F(SceneTest, AScenarioBecomesAPlainDescription) {
  const Scene scene = good("scenario", {"/probes/p={\"type\": \"curve\", \"wall\": \"floor\"}"});
  EXPECT_FALSE(scene.document.json().contains("scenario"));
  EXPECT_EQ(scene.description->title, "my pile");
  EXPECT_EQ(scene.description->seed, 3);
  EXPECT_EQ(scene.description->guards.overlap, 0.3);
  const auto& cloud = std::get<CloudSource>(scene.description->bodies.at("grains").source.value());
  EXPECT_EQ(cloud.count, 100);
  EXPECT_EQ(cloud.high, Vec3(0.2, 0.2, 0.2));
  EXPECT_TRUE(scene.description->probes.contains("p"));
  EXPECT_EQ(std::get<CloudSource>(good("extended_scenario").description->bodies.at("grains").source.value()).count, 50);
}

TEST_F(SceneTest, StagesOfAScenarioAreSetByIndex) {
  const Scene before = good("scenario"), after = good("scenario", {"/stages/0/limit=7.5"});
  ASSERT_EQ(after.description->stages.size(), before.description->stages.size());
  EXPECT_EQ(after.description->stages.at(0).limit, 7.5);
  EXPECT_EQ(after.description->stages.at(0).name, before.description->stages.at(0).name);
}

TEST_F(SceneTest, NullRemovesKeysOfAScenario) {
  const Folder folder;
  const auto write = [&](const char* name, const char* text) { return folder.write(name, text); };
  const auto walls = [&](const std::filesystem::path& path, const std::vector<std::string>& sets = {}) {
    return load_document(path, sets, registry_).json().at("walls").dump();
  };
  const auto pile = write("pile.json", R"({"scenario": {"type": "pile"}})");
  EXPECT_THAT(walls(pile), HasSubstr("floor"));
  EXPECT_EQ(walls(write("beside.json", R"({"scenario": {"type": "pile"}, "walls": {"floor": null}})")), "{}");
  write("without.json", R"({"extends": "pile.json", "walls": {"floor": null}})");
  EXPECT_EQ(walls(folder.path() / "without.json"), "{}") << "the file that it extends lacks the key";
  EXPECT_EQ(walls(write("further.json", R"({"extends": "without.json", "seed": 4})")), "{}");
  EXPECT_EQ(walls(pile, {"/walls/floor=null"}), "{}");
  // A key that is written again after its removal has no old content.
  const char* const lid = R"({"lid":{"material":"sand"}})";
  EXPECT_EQ(walls(write("again.json", R"({"extends": "without.json", "walls": {"lid": {"material": "sand"}}})")), lid);
  write("none.json", R"({"scenario": {"type": "pile"}, "walls": null})");
  EXPECT_EQ(walls(write("other.json", R"({"extends": "none.json", "walls": {"lid": {"material": "sand"}}})")), lid);
}

TEST_F(SceneTest, WhatIsResolvedReadsTheSame) {
  for (const char* name : {"plain", "units", "glue", "everything", "scenario"}) {
    const Description first = resolved(*good(name).description);
    const Scene again = read_scene(Document(first, "resolved"), registry_);
    EXPECT_EQ(resolved(*again.description).dump(), first.dump()) << name;
  }
}

TEST_F(SceneTest, ManyProblemsInOneGo) {
  const Folder folder;
  const auto path = folder.write("many.json", R"({
  "contacts": {"type": "spring"},
  "materials": {
    "sand": {"density": "2600",
      "frictoin_angle": 0.3}
  },
  "bodies": {"grains": {"type": "cube", "material": "snad", "source": {"type": "cloud"}}},
  "walls": {
    "floor": {"type": "plane", "position": [0, 0], "material": "wood"}, "side": {"type": "plane", "position": [0, 0, 1]},
    "lid": {"type": "plane", "position": [0, 0, 1], "material": "sand",
      "motion": {"follow": {"wall": "roof"}}}
  },
  "stages": [
    {"name": "a", "until": {"type": "time", "value": -1}, "limit": 1,
      "change": {"guards": {
        "overlap": 0}}}
  ],
  "seed": 1.5,
  "colour": "red"
})");
  const std::string file = path.string();
  try {
    load_scene(path, {}, registry_);
    FAIL() << "nothing was refused";
  } catch (const DescriptionError& error) {
    std::vector<std::string> found;
    for (const auto& p : error.problems()) {
      EXPECT_EQ(p.file, file);
      found.push_back(std::to_string(p.line) + ' ' + p.pointer);
    }
    EXPECT_THAT(found, testing::UnorderedElementsAre(
                           "19 /colour", "18 /seed", "4 /materials/sand/density", "5 /materials/sand/frictoin_angle",
                           "7 /bodies/grains/type", "7 /bodies/grains/source", "7 /bodies/grains/source",
                           "7 /bodies/grains/source", "9 /walls/floor/position", "14 /stages/0/until/value",
                           "16 /stages/0/change/guards/overlap", "9 /walls/floor/material", "9 /walls/side",
                           "11 /walls/lid/motion/follow/wall", "7 /bodies/grains/material"))
        << error.what();
  }
}

TEST_F(SceneTest, ABrokenPluginIsNoDescriptionProblem) {
  PluginInfo broken;
  broken.kind = "engine", broken.name = "broken", broken.version = "1.0.0";
  broken.make_engine = []() -> Engine* { throw std::runtime_error("out of order"); };
  registry_.add(broken);
  EXPECT_THROW(good("plain", {R"(/engines/x={"type": "broken"})"}), PluginError);
}
