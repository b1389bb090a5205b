// What a run.json has about its commands and its description, and what a resumed run takes over.
#include "output/run_facts.hpp"

#include <gmock/gmock.h>

#include "fake_world.hpp"
#include "folder.hpp"
#include "output/read_results.hpp"
#include "output/results_folder.hpp"

namespace grit::run_facts_tests {
namespace {

using testing::ElementsAre;

using Words = std::vector<std::string>;

RunFacts first_command() {
  RunFacts facts;
  facts.commands = {{"grit", "run", "test.json"}};
  facts.source = {.path = "/sims/test.json",
                  .written = {{"//", "a test"}, {"extends", "base.json"}, {"scenario", {{"width", "60 mm"}}}},
                  .sets = {"/seed=2"},
                  .unexpanded = {{"scenario", {{"type", "oedometer"}, {"width", "60 mm"}}}, {"seed", 2}}};
  return facts;
}

RunFacts resuming(const Words& sets) {
  RunFacts facts;
  facts.commands = {{"grit", "run", "--resume", "results/test"}};
  facts.source = {.path = "results/test/description.json", .written = {{"seed", 2}}, .sets = sets};
  return facts;
}

Description run_json_of(const RunFacts& facts) {
  const Folder folder;
  ResultsOptions options;
  options.folder = folder / "run";
  options.facts = facts;
  NumberedWorld world;
  world.add(0, {0, 0, 0}, 1);
  ResultsFolder results(options);
  results.begin(world, {});
  return read_run_json(folder / "run").value();
}

TEST(RunJson, HasTheCommandAndTheDescriptionAsWritten) {
  const Description run = run_json_of(first_command());
  EXPECT_EQ(run.at("commands"), Description::parse(R"([["grit", "run", "test.json"]])"));
  EXPECT_EQ(run.at("source"), Description::parse(R"({
    "path": "/sims/test.json",
    "written": {"//": "a test", "extends": "base.json", "scenario": {"width": "60 mm"}},
    "set": ["/seed=2"],
    "unexpanded": {"scenario": {"type": "oedometer", "width": "60 mm"}, "seed": 2}})"));
  EXPECT_EQ(run_json_of({}).at("source"),
            Description::parse(R"({"path": "", "written": null, "set": [], "unexpanded": null})"));
}

TEST(RunFacts, OfAResumedRunHaveAllCommands) {
  RunFacts facts = resuming({"/guards/travel=0.1"});
  continue_from(run_json_of(first_command()), true, facts);
  EXPECT_THAT(facts.commands,
              ElementsAre(Words{"grit", "run", "test.json"}, Words{"grit", "run", "--resume", "results/test"}));
  EXPECT_EQ(facts.source.path, "/sims/test.json");
  EXPECT_EQ(facts.source.written.at("extends"), "base.json");
  EXPECT_THAT(facts.source.sets, ElementsAre("/seed=2", "/guards/travel=0.1"));
  EXPECT_EQ(facts.source.unexpanded.at("guards").at("travel"), 0.1);
  EXPECT_EQ(facts.source.unexpanded.at("seed"), 2);

  RunFacts again = resuming({});
  continue_from(run_json_of(facts), true, again);
  EXPECT_EQ(again.commands.size(), 3u);
  EXPECT_THAT(again.source.sets, ElementsAre("/seed=2", "/guards/travel=0.1"));
}

TEST(RunFacts, OfARunResumedByItsFileHaveThisFile) {
  RunFacts facts = resuming({"/guards/travel=0.1"});
  facts.source.path = "/sims/moved.json";
  continue_from(run_json_of(first_command()), false, facts);
  EXPECT_EQ(facts.commands.size(), 2u);
  EXPECT_EQ(facts.source.path, "/sims/moved.json");
  EXPECT_THAT(facts.source.sets, ElementsAre("/guards/travel=0.1"));
}

TEST(RunFacts, HaveNoUnexpandedDescriptionIfAnAssignmentNeedsTheExpanded) {
  RunFacts facts = resuming({"/seed/of/nothing=1"});
  continue_from(run_json_of(first_command()), true, facts);
  EXPECT_TRUE(facts.source.unexpanded.is_null());
  EXPECT_EQ(facts.source.path, "/sims/test.json");
}

TEST(RunFacts, OfARunJsonWithoutCommandsAreThoseOfThisCommand) {
  for (const char* text : {"{}", R"({"commands": 1})", R"({"commands": [], "source": {"path": "x"}})"}) {
    RunFacts facts = resuming({"/seed=2"});
    continue_from(Description::parse(text), true, facts);
    EXPECT_THAT(facts.commands, ElementsAre(Words{"grit", "run", "--resume", "results/test"})) << text;
    EXPECT_EQ(facts.source.path, "results/test/description.json") << text;
    EXPECT_THAT(facts.source.sets, ElementsAre("/seed=2")) << text;
  }
}

}  // namespace
}  // namespace grit::run_facts_tests
