// Bodies in the depth of a plane problem, which `check` counts.
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

TEST(Descriptions, CheckReportsADepthWithMoreContactsThanScatterJustifies) {
  const OwnFolder folder;
  auto many = json::parse(two_grains);
  many["domain"] = {{"low", {0, 0, 0}}, {"high", {0.1, 0.1, 0.1}}, {"periodic", {false, true, false}}};
  many["bodies"]["grains"]["source"] = {{"type", "cloud"},
                                        {"low", {0, 0, 0}},
                                        {"high", {0.1, 0.1, 0.1}},
                                        {"count", 40000},
                                        {"sizes", {{"type", "uniform"}, {"smallest", "0.9 mm"}, {"largest", "1 mm"}}}};
  folder.write("many.json", many.dump());
  const auto check = [&](const std::string& set) {
    return grit_in(folder.path(), {"check", "many.json", "--set", set}).out;
  };
  // 2.5 contacts a grain; 1/√40 000 is 0.5 %.
  EXPECT_THAT(check("/seed=2"), HasSubstr("  /domain/high/1: the cell is periodic along y; a depth of 0.1 m has about "
                                          "100000 contacts, so that means scatter between samples by about 1/√contacts "
                                          "= 0.32 %; 0.04 m would give 0.5 % at 0.4 of the cost"));
  EXPECT_THAT(check("/bodies/grains/source/count=30000"), testing::Not(HasSubstr("1/√contacts")));
  EXPECT_THAT(check("/domain/periodic=[true, true, false]"), testing::Not(HasSubstr("1/√contacts")))
      << "which of the two is its depth?";
  EXPECT_THAT(check("/bodies/grains/source/high/1=0.05"), testing::Not(HasSubstr("1/√contacts"))) << "a heap";
  EXPECT_THAT(check(R"(/engines/weight={"type": "gravity", "acceleration": [0, -9.81, 0]})"),
              testing::Not(HasSubstr("1/√contacts")));
  EXPECT_THAT(check(R"(/walls/floor={"type": "plane", "point": [0, 0, 0], "material": "sand"})"),
              HasSubstr("1/√contacts"));
  EXPECT_THAT(check(R"(/walls/floor={"type": "rectangle", "corner": [0, 0, 0], "edge_a": [0.1, 0, 0],
      "edge_b": [0, 0.04, 0], "material": "sand"})"),
              testing::Not(HasSubstr("1/√contacts")))
      << "a floor that ends";
}

TEST(Descriptions, CheckReportsAnExcessDepthBetweenPanesOfAScenario) {
  const std::string file = GRIT_SOURCE_DIR "/sims/direct-shear/quick.json";
  const OwnFolder folder;
  const auto check = [&](std::vector<std::string> sets) {
    std::vector<std::string> words{"check", file};
    for (const auto& set : sets) words.insert(words.end(), {"--set", set});
    return grit_in(folder.path(), words).out;
  };
  EXPECT_THAT(check({"/scenario/depth=60 mm"}),
              HasSubstr("  /scenario/depth: its walls \"front\" and \"back\" along y are at rest and frictionless; a "
                        "depth of 0.06 m has about "));
  EXPECT_THAT(check({"/scenario/depth=10 mm"}), testing::Not(HasSubstr("1/√contacts")));
  EXPECT_THAT(check({"/scenario/depth=60 mm", "/materials/sand/rolling_limit=0.4", "/walls/front/material=sand"}),
              testing::Not(HasSubstr("1/√contacts")))
      << "it drags grains";
  EXPECT_THAT(check({"/scenario/depth=60 mm", "/stages/0/change/materials/smooth={\"friction_angle\": 0.4}"}),
              testing::Not(HasSubstr("1/√contacts")))
      << "in a stage";
}

TEST(Descriptions, CheckCountsGrainsOfAllLayersInADepth) {
  const OwnFolder folder;
  const auto outcome = grit_in(
      folder.path(),
      {"check", GRIT_SOURCE_DIR "/sims/silo-quasistatic/quick-very-rough-layers.json", "--set", "/scenario/depth=0.2"});
  EXPECT_THAT(outcome.out, HasSubstr("about 2368")) << outcome.err;
}

}  // namespace
}  // namespace grit
