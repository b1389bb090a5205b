// Walls that move too fast or face away, of which `check` warns.
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

TEST(Descriptions, CheckWarnsOfWallsThatAreTooFastForThePrescribedStep) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["time_step"]["value"] = 1e-6;
  scene["walls"]["lid"] = {{"type", "plane"}, {"material", "sand"}, {"point", {0, 0, 1}}, {"normal", {0, 0, -1}}};
  scene["walls"]["gate"] = {{"type", "rectangle"},
                            {"material", "sand"},
                            {"corner", {0.5, 0, 0}},
                            {"edge_a", {0, 0.1, 0}},
                            {"edge_b", {0, 0, 0.1}}};
  scene["stages"][1] = {
      {"name", "press"}, {"until", {{"type", "steps"}, {"value", 2}}}, {"limit", 1}, {"change", json::object()}};
  folder.write("scene.json", scene.dump());
  const auto check = [&](const std::vector<std::string>& sets) {
    std::vector<std::string> words{"check", "scene.json"};
    for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const auto motion = [](const std::string& wall, const std::string& motion) {
    return R"(/stages/1/change={"walls": {")" + wall + R"(": {"motion": )" + motion + "}}}";
  };
  const auto none = testing::Not(HasSubstr("/motion: in stage"));
  EXPECT_THAT(
      check({motion("lid", R"({"velocity": [0, 0, -400]})")}),
      HasSubstr("\nwarning\n  /walls/lid/motion: in stage \"press\" the wall moves by 0.0004 m in a time step of "
                "1e-06 s, 0.4 of the smallest radius and more than /guards/travel 0.05: the run stops where "
                "it meets bodies; reduce its speed or /time_step/value\n"));
  EXPECT_THAT(check({motion("lid", R"({"oscillation": {"amplitude": [0, 0, 0.01], "frequency": 1e4}})")}),
              HasSubstr("0.6283 of the smallest radius"));
  EXPECT_THAT(check({motion("gate", R"({"spin": [0, 0, 1e4]})")}), HasSubstr("/walls/gate/motion: in stage"));
  EXPECT_THAT(check({motion("gate", R"({"spin": [1e4, 0, 0]})")}), none) << "in its own plane";
  EXPECT_THAT(check({motion("lid", R"({"velocity": [400, 0, 0]})")}), none) << "along itself";
  EXPECT_THAT(check({motion("lid", R"({"velocity": [0, 0, 400]})")}), none) << "away from bodies";
  EXPECT_THAT(check({motion("lid", R"({"velocity": [0, 0, -40]})")}), none) << "slow enough";
  EXPECT_THAT(check({motion("lid", R"({"velocity": [0, 0, -400]})"), "/time_step=null"}), none)
      << "the step follows it";
}

TEST(Descriptions, CheckWarnsOfWallsThatFaceAway) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["engines"]["gravity"] = {{"type", "gravity"}};
  folder.write("scene.json", scene.dump());
  const auto check = [&](const std::vector<std::string>& walls) {
    std::vector<std::string> words{"check", "scene.json"};
    for (std::size_t i = 0; i < walls.size(); ++i)
      words.insert(words.end(), {"--set", "/walls/w" + std::to_string(i) + "=" + walls[i]});
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const auto floor = [](double height, const std::string& edges, const std::string& more = "") {
    return R"({"type": "rectangle", "material": "sand", "corner": [-0.01, -0.01, )" + std::to_string(height) + "], " +
           edges + R"(, "two_sided": false)" + more + "}";
  };
  const std::string up = R"("edge_a": [0.02, 0, 0], "edge_b": [0, 0.02, 0])",
                    down = R"("edge_a": [0, 0.02, 0], "edge_b": [0.02, 0, 0])",
                    warning =
                        "\nwarning\n  /walls/w0: 2 of 2 bodies are behind it, none is in front: it holds only bodies "
                        "in front of it; ";
  const auto none = testing::Not(HasSubstr("are behind it"));
  EXPECT_THAT(check({floor(-0.005, up)}), none);
  EXPECT_THAT(check({floor(-0.005, down)}), HasSubstr(warning + "exchange edge_a and edge_b"));
  EXPECT_THAT(check({R"({"type": "rectangle", "material": "sand", "corner": [-0.01, -0.01, -0.005], )" + down + "}"}),
              none)
      << "it has two sides";
  EXPECT_THAT(check({floor(-0.005, down, R"(, "motion": {"spin": [1, 0, 0]})")}), none) << "it turns towards them";
  EXPECT_THAT(check({floor(-0.005, down), floor(-0.004, up)}), none) << "the back of a plate";
  const auto tube = [](const std::string& inside, double radius) {
    return R"({"type": "cylinder", "material": "sand", "start": [-0.02, 0, -0.03], "end": [0.02, 0, -0.03], "inside": )" +
           inside + R"(, "radius": )" + std::to_string(radius) + "}";
  };
  EXPECT_THAT(check({tube("true", 0.1)}), none);
  EXPECT_THAT(check({tube("false", 0.1)}), HasSubstr(warning + "set its \"inside\" to the side of the bodies"));
  EXPECT_THAT(check({tube("true", 0.01)}), HasSubstr(warning));
  EXPECT_THAT(check({tube("false", 0.01)}), none);
  EXPECT_THAT(check({floor(-0.005, down), R"({"type": "plane", "material": "sand", "point": [0, 0, -0.1]})"}),
              HasSubstr(warning))
      << "a wall beyond it does not hide it";
}

}  // namespace
}  // namespace grit
