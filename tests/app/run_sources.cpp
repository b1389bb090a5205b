// What run.json has about the command line and the description as written.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;

class RunSources : public testing::Test {
 protected:
  RunSources() { folder.write("two.json", two_grains); }
  Outcome grit(std::vector<std::string> words) const { return grit_in(folder.path(), std::move(words)); }
  json run_json(const std::string& results) const { return json::parse(text_of(folder / (results + "/run.json"))); }
  std::string path_of(const std::string& name) const {
    return (std::filesystem::canonical(folder.path()) / name).string();
  }

  OwnFolder folder;
};

TEST_F(RunSources, AreTheCommandLineAndTheDescriptionAsWritten) {
  const std::vector<std::string> words{"run",   "./two.json", "--no-report", "--out",        "results/two of them",
                                       "--set", "/seed=5",    "--set",       "/title=other", "--quiet"};
  ASSERT_EQ(grit(words).status, 0);
  const json run = run_json("results/two of them"), &source = run.at("source");
  EXPECT_EQ(run.at("commands"), json::array({grit_with(words)}));
  EXPECT_EQ(source.at("path"), path_of("two.json"));
  EXPECT_EQ(source.at("written"), json::parse(two_grains));
  EXPECT_EQ(source.at("set"), json({"/seed=5", "/title=other"}));
  EXPECT_TRUE(source.at("unexpanded").is_null());
}

TEST_F(RunSources, AreOfTheFileWithoutThoseItExtends) {
  const std::string child = R"({"//": "the same, stiffer", "extends": "two.json", "seed": 3})";
  folder.write("child.json", "\xef\xbb\xbf" + child);
  ASSERT_EQ(grit({"run", "child.json", "--no-report"}).status, 0);
  const json run = run_json("results/child");
  EXPECT_EQ(run.at("source").at("written"), json::parse(child));
  EXPECT_EQ(run.at("description").at("title"), "two grains");
}

TEST_F(RunSources, AreUnknownForAPipe) {
  const auto outcome = shell(folder.path(), "\"" GRIT_BINARY "\" run <(cat two.json) --no-report --out piped");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(run_json("piped").at("source").at("written").is_null());
}

TEST_F(RunSources, HaveAScenarioBeforeItIsExpanded) {
  folder.write("shear.json", R"({"extends": ")" GRIT_SOURCE_DIR R"(/sims/direct-shear/quick.json"})");
  // A guard stops it in its first step.
  ASSERT_EQ(grit({"run", "shear.json", "--no-report", "--set", "/guards/travel=1e-9", "--set",
                  "/scenario/normal_stress=100 kPa"})
                .status,
            4);
  const json run = run_json("results/shear"), &unexpanded = run.at("source").at("unexpanded");
  EXPECT_EQ(unexpanded.at("scenario").at("type"), "direct-shear") << "inherited";
  EXPECT_EQ(unexpanded.at("scenario").at("normal_stress"), "100 kPa");
  EXPECT_FALSE(unexpanded.contains("walls"));
  EXPECT_FALSE(unexpanded.contains("//"));
}

TEST_F(RunSources, OfAResumedRunHaveAllCommands) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report", "--set", "/guards/travel=1e-6"}).status, 4);
  const auto rest = grit({"run", "--resume", "results/two/", "--no-report", "--set", "/guards/travel=0.05"});
  ASSERT_EQ(rest.status, 0) << rest.err;
  json run = run_json("results/two");
  ASSERT_EQ(run.at("commands").size(), 2u);
  EXPECT_EQ(run.at("commands").at(0).at(2), "two.json");
  EXPECT_EQ(run.at("commands").at(1).at(2), "--resume");
  EXPECT_EQ(run.at("source").at("path"), path_of("two.json"));
  EXPECT_EQ(run.at("source").at("written"), json::parse(two_grains));
  EXPECT_EQ(run.at("source").at("set"), json({"/guards/travel=1e-6", "/guards/travel=0.05"}));

  EXPECT_EQ(grit({"run", "--resume", "results/two"}).status, 0) << "already complete";
  EXPECT_EQ(run_json("results/two"), run);

  ASSERT_EQ(grit({"run", "two.json", "--no-report", "--overwrite"}).status, 0);
  run = run_json("results/two");
  EXPECT_EQ(run.at("commands").size(), 1u) << "of another run";
  EXPECT_TRUE(run.at("source").at("set").empty());
}

TEST_F(RunSources, OfARunResumedByItsFileAreThoseOfTheLastCommand) {
  ASSERT_EQ(grit({"run", "two.json", "--no-report", "--set", "/guards/travel=1e-6"}).status, 4);
  ASSERT_EQ(grit({"run", "two.json", "--resume", "--no-report"}).status, 0);
  const json run = run_json("results/two");
  EXPECT_EQ(run.at("commands").size(), 2u);
  EXPECT_TRUE(run.at("source").at("set").empty());
}

}  // namespace
}  // namespace grit
