// Bodies that nothing moves or stops, of which `check` warns.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Descriptions, CheckWarnsWhereNothingMovesTheBodies) {
  const OwnFolder folder;
  auto cloud = json::parse(two_grains);
  cloud["bodies"]["grains"]["source"] = {{"type", "cloud"},
                                         {"low", {0, 0, 0}},
                                         {"high", {0.02, 0.02, 0.02}},
                                         {"count", 20},
                                         {"sizes", {{"type", "uniform"}, {"smallest", 1e-3}, {"largest", 2e-3}}}};
  cloud["walls"]["floor"] = {{"type", "plane"}, {"material", "sand"}, {"point", {0, 0, -0.01}}};
  folder.write("cloud.json", cloud.dump());
  folder.write("two.json", two_grains);
  const auto check = [&](std::vector<std::string> sets, const std::string& file = "cloud.json") {
    std::vector<std::string> words{"check", file};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string warning =
      "\nwarning\n  /engines: nothing moves the bodies: they are at rest without contacts that push "
      "them, no wall moves, and there is neither gravity nor another force; add \"gravity\": ";
  EXPECT_THAT(check({}), HasSubstr(warning));
  EXPECT_THAT(check({R"(/engines={"damping": {"type": "local-damping"}})"}), HasSubstr(warning));
  EXPECT_THAT(check({R"(/engines={"gravity": {"type": "gravity", "acceleration": [0, 0, 0]}})"}), HasSubstr(warning));
  const auto none = testing::Not(HasSubstr("nothing moves the bodies"));
  EXPECT_THAT(check({}, "two.json"), none) << "they push each other apart";
  EXPECT_THAT(check({R"(/engines={"gravity": {"type": "gravity"}})"}), none);
  EXPECT_THAT(check({R"(/stages/0/change={"engines": {"gravity": {"type": "gravity"}}})"}), none) << "in a stage";
  EXPECT_THAT(check({R"(/bodies/grains/velocity=[0, 0, "-1 m/s"])"}), none);
  EXPECT_THAT(check({R"(/walls/floor/motion={"velocity": [0, 0, "1 mm/s"]})"}), none);
  EXPECT_THAT(check({R"(/walls/floor/motion={"servo": {"force": 1, "max_velocity": 1}})"}), none);
  EXPECT_THAT(check({R"(/stages/0/change={"walls": {"floor": {"point": [0, 0, 0.001]}}})"}), none);
  EXPECT_THAT(check({R"(/stages/0/growth={"rate": 1})"}), none);
  // Glued grains that touch each other do not move the others.
  const std::string glued = R"(/bodies/glued={"type": "sphere", "material": "sand", "source": {"type": "lattice",
      "kind": "simple-cubic", "low": [0, 0, -0.008], "high": [0.02, 0.02, -0.004], "diameter": 0.002}})";
  const std::string held = R"(/engines/glue={"type": "prescribed-motion", "groups": ["glued"]})";
  EXPECT_THAT(check({glued, held}), HasSubstr(warning));
  EXPECT_THAT(check({glued}), none) << "they may push each other apart";
  EXPECT_THAT(check({glued, held, R"(/engines/gravity={"type": "gravity"})"}), none);
  EXPECT_THAT(check({glued, held, R"(/stages/0/change={"engines": {"glue": null}})"}), none) << "released in a stage";
}

TEST(Descriptions, CheckWarnsWhereGravityIsForgotten) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["bodies"]["grains"]["source"]["bodies"][1]["position"] = {0.003, 0, 0};
  scene["bodies"]["grains"]["velocity"] = {0, 0, -0.5};
  scene["walls"]["floor"] = {{"type", "plane"}, {"material", "sand"}, {"point", {0, 0, -0.01}}};
  folder.write("moving.json", scene.dump());
  scene["stages"][0]["until"] = {{"type", "at-rest"}};
  folder.write("settling.json", scene.dump());
  scene = json::parse(two_grains);
  scene["bodies"]["poured"] = {{"type", "sphere"}, {"material", "sand"}, {"velocity", {0, 0, -0.5}}};
  scene["bodies"]["poured"]["source"] = {{"type", "stream"},
                                         {"number_rate", 100},
                                         {"region", {{"type", "disc"}, {"centre", {0, 0, 0.05}}, {"radius", 0.01}}},
                                         {"sizes", {{"type", "list"}, {"diameters", {0.001}}}}};
  folder.write("poured.json", scene.dump());
  const auto check = [&](const std::string& file, const std::string& set = "/seed=1") {
    const auto outcome = grit_in(folder.path(), {"check", file, "--set", set});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string gravity = R"(/engines/gravity={"type": "gravity"})";
  const std::string warning =
      "\nwarning\n  /engines: no force acts on the bodies: there is neither gravity nor another force, and no wall "
      "moves; ";
  EXPECT_THAT(check("settling.json"), HasSubstr(warning + "a stage waits for contacts that carry them; if they should "
                                                          "fall, add \"gravity\": {\"type\": \"gravity\"}\n"));
  EXPECT_THAT(check("poured.json"), HasSubstr(warning + "those of a stream keep their velocity until they hit "));
  const auto none = testing::Not(HasSubstr("no force acts"));
  EXPECT_THAT(check("moving.json"), none) << "a collision needs none";
  EXPECT_THAT(check("settling.json", R"(/stages/0/until={"type": "any", "of": [{"type": "at-rest"}, {"type": "time",
                                        "value": 1}]})"),
              none)
      << "time ends it";
  for (const char* file : {"settling.json", "poured.json"}) {
    EXPECT_THAT(check(file, gravity), none);
    EXPECT_THAT(check(file, R"(/engines/drag={"type": "drag", "viscosity": 1e-3})"), none);
    EXPECT_THAT(check(file, R"(/stages/0/change={"engines": {"gravity": {"type": "gravity"}}})"), none);
    EXPECT_THAT(check(file, R"(/stages/0/growth={"rate": 1})"), none);
  }
  EXPECT_THAT(check("settling.json", R"(/walls/floor/motion={"velocity": [0, 0, "1 mm/s"]})"), none);
}

TEST(Descriptions, CheckReportsBodiesThatFallForEver) {
  const OwnFolder folder;
  auto cell = json::parse(two_grains);
  cell["walls"] = json::object();
  cell["domain"] = {{"low", {-0.1, -0.1, -0.1}}, {"high", {0.1, 0.1, 0.1}}, {"periodic", {true, true, true}}};
  cell["engines"]["gravity"] = {{"type", "gravity"}};
  folder.write("cell.json", cell.dump());
  const auto check = [&](const std::string& set) {
    const auto outcome = grit_in(folder.path(), {"check", "cell.json", "--set", set});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string warning = "\nwarning\n  /engines: gravity acts in a domain that is periodic along all axes";
  EXPECT_THAT(check("/seed=2"), HasSubstr(warning));
  EXPECT_THAT(check("/domain/periodic=[true, true, false]"), testing::Not(HasSubstr(warning)));
  EXPECT_THAT(check(R"(/engines/gravity/acceleration=[0, 0, 0])"), testing::Not(HasSubstr(warning)));
  EXPECT_THAT(check(R"(/engines/hold={"type": "hold", "translation": "z"})"), testing::Not(HasSubstr(warning)));
}

TEST(Descriptions, CheckWarnsWhereGravityPointsToNoWall) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["engines"]["gravity"] = {{"type", "gravity"}};
  scene["walls"]["pit"] = {{"type", "box"},
                           {"material", "sand"},
                           {"low", {-0.01, -0.01, -0.01}},
                           {"high", {0.01, 0.01, 0.01}},
                           {"open", {"z_high"}}};
  scene["stages"][0]["until"] = {{"type", "at-rest"}, {"below", 0.01}};
  folder.write("scene.json", scene.dump());
  const auto check = [&](const std::vector<std::string>& sets) {
    std::vector<std::string> words{"check", "scene.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const std::string upwards = "/engines/gravity/acceleration=[0, 0, 9.81]";
  const auto none = testing::Not(HasSubstr("no wall is on the way"));
  EXPECT_THAT(check({}), none);
  EXPECT_THAT(check({upwards}), HasSubstr("\nwarning\n  /engines: gravity is (0, 0, 9.81) m/s^2, and no wall is on the "
                                          "way of the bodies that fall so, but a stage waits for them to rest; "));
  EXPECT_THAT(check({upwards, R"(/stages/0/until={"type": "time", "value": 1e-3})"}), none) << "they may fly";
  EXPECT_THAT(check({upwards, "/walls/pit/open=[\"x_high\"]"}), none) << "a lid";
  EXPECT_THAT(check({"/engines/gravity/acceleration=[9.81, 0, -9.81]"}), none);
  EXPECT_THAT(check({"/walls/pit=null"}), testing::Not(none)) << "no wall at all";
  EXPECT_THAT(check({upwards, R"(/walls/lid={"type": "plane", "point": [0, 0, 1], "normal": [0, 0, -1],
      "material": "sand"})"}),
              none);
  EXPECT_THAT(check({upwards, R"(/walls/side={"type": "plane", "point": [-1, 0, 0], "normal": [1, 0, 0],
      "material": "sand"})"}),
              testing::Not(none));
}

}  // namespace
}  // namespace grit
