// A package of two instruction sets: OWN is that of the build at hand, OTHER the lower one that was made for the test.
#include <gmock/gmock.h>

#include <array>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

const std::string own = OWN, other = OTHER;

/// A program of grit's with these words, and GRIT_ISA as it is given; "" leaves it unset.
Outcome grit(const fs::path& folder, const std::string& isa, std::vector<std::string> words,
             const std::string& program = GRIT_BINARY) {
  std::vector<std::string> all{"env", "-u", "GRIT_ISA", "-u", "GRIT_PLUGIN_PATH"};
  if (!isa.empty()) all.push_back("GRIT_ISA=" + isa);
  all.push_back(program);
  all.insert(all.end(), words.begin(), words.end());
  return Program(all, folder).finish();
}

/// Two grains with the law of the package.
std::string scene() {
  auto json = nlohmann::json::parse(two_grains);
  json["contacts"]["type"] = LAW;
  return json.dump();
}

/// run.json of a run of two grains.
nlohmann::json run(const OwnFolder& folder, const std::string& isa, const std::string& results) {
  folder.write("two.json", scene());
  const auto outcome = grit(folder.path(), isa, {"run", "two.json", "--out", results});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(text_of(folder / results / "run.json"));
}

/// x y z radius of both grains at the end.
std::array<double, 8> grains(const OwnFolder& folder, const std::string& results) {
  std::array<double, 8> all{};
  std::istringstream lines(text_of(folder / results / "packing.txt"));
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);)
    if (std::istringstream numbers(line); !line.starts_with('#'))
      while (count < all.size() && numbers >> all[count]) ++count;
  EXPECT_EQ(count, all.size());
  return all;
}

class Chosen : public testing::TestWithParam<std::string> {
 protected:
  const OwnFolder folder;
  const std::string isa = GetParam(), not_chosen = isa == own ? other : own;
};

TEST_P(Chosen, IsWhatRunJsonTells) {
  const auto json = run(folder, isa, "results");
  EXPECT_EQ(json.at("grit").at("arch"), isa);
  std::vector<std::string> files;
  for (const auto& plugin : json.at("plugins")) {
    EXPECT_EQ(plugin.at("build").at("instruction_set"), json.at("grit").at("instruction_set"));
    if (plugin.at("file") != "") files.push_back(plugin.at("file"));
  }
  EXPECT_GE(files.size(), 2u);
  EXPECT_THAT(files, Each(StartsWith(INSTALLED + isa + "/")));
}

TEST_P(Chosen, IsWhatTheCommandTells) {
  EXPECT_THAT(grit(folder.path(), isa, {"--version"}).out, HasSubstr(" (-march=" + isa + ")\n"));
  EXPECT_THAT(grit(folder.path(), isa, {"plugins"}).out,
              AllOf(HasSubstr(" (-march=" + isa + ")\n"), HasSubstr(INSTALLED + isa + "/contacts/" LAW ".so"),
                    Not(HasSubstr(INSTALLED + not_chosen + "/"))));
}

TEST_P(Chosen, IsWhatTheDynamicLinkerLoads) {
  folder.write("two.json", scene());
  const auto outcome =
      shell(folder.path(), "GRIT_ISA=" + isa +
                               " LD_DEBUG=files LD_DEBUG_OUTPUT=loaded '" GRIT_BINARY "' run two.json && cat loaded.*");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("calling init: " INSTALLED + isa + "/libgrit.so"),
                                 HasSubstr("calling init: " INSTALLED + isa + "/contacts/" LAW ".so"),
                                 HasSubstr("calling init: " INSTALLED + isa + "/probes/packing.so"),
                                 Not(HasSubstr(INSTALLED + not_chosen + "/"))));
}

TEST_P(Chosen, IsWhatTheLoopOfTheLawIsMadeOf) {
  const std::string tag = run(folder, isa, "results").at("grit").at("instruction_set");
  const auto has = [&](const char* text) { return tag.find(text) != std::string::npos; };
  const std::string widest = has("v4") || has("avx512f") ? "zmm" : has("v3") || has("avx") ? "ymm" : "xmm";
  for (const auto& registers : {"lanes", widest.c_str()}) {
    const auto check = shell(folder.path(), CHECK_LOOPS " '" INSTALLED + isa + "/contacts/" LAW ".so' " + registers);
    EXPECT_EQ(check.status, 0) << registers << '\n' << check.err;
  }
}

TEST_P(Chosen, GivesIdenticalValuesAgain) {
  run(folder, isa, "once"), run(folder, isa, "again");
  EXPECT_EQ(text_of(folder / "once" / "packing.txt"), text_of(folder / "again" / "packing.txt"));
}

INSTANTIATE_TEST_SUITE_P(Package, Chosen, testing::Values(own, other),
                         [](const auto& info) { return info.param == own ? "own" : "other"; });

TEST(Package, TakesTheBestUnlessTold) {
  const OwnFolder folder;
  EXPECT_EQ(run(folder, "", "results").at("grit").at("arch"), own);
}

TEST(Package, TellsWhereItsDocumentationIs) {
  const OwnFolder folder;
  const auto place = fs::path(GRIT_BINARY).parent_path().parent_path() / "share/doc/grit";
  for (const auto& isa : {own, other})
    EXPECT_THAT(grit(folder.path(), isa, {"--help"}).out,
                AllOf(HasSubstr("\nDocumentation: " + (place / "docs").string() + '\n'),
                      HasSubstr("\nDescriptions of tests: " + (place / "sims").string() + '\n')));
  EXPECT_TRUE(fs::exists(place / "docs/README.md") && fs::exists(place / "sims/column/quick.json"));
}

TEST(Package, AgreesToRoundOff) {
  const OwnFolder folder;
  run(folder, own, "own"), run(folder, other, "other");
  const auto one = grains(folder, "own"), two = grains(folder, "other");
  EXPECT_GT(std::abs(one[4] - 1.999e-3), 1e-9) << "the grains did not move";
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(one[i], two[i], 1e-12 * 1e-3);
}

TEST(Package, RefusesWhatIsNotInstalled) {
  const OwnFolder folder;
  const auto outcome = grit(folder.path(), "x86-64-v9", {"--version"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, AllOf(StartsWith("grit: GRIT_ISA=x86-64-v9: this instruction set is not installed in "),
                                 HasSubstr(own), HasSubstr(other)));
}

TEST(Package, HasProgramsThatKnowTheirOwn) {
  const OwnFolder folder;
  for (const std::string& program : {std::string(ONE_BUILD), INSTALLED + own + "/grit"}) {
    const auto outcome = grit(folder.path(), other, {"--version"}, program);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err,
                AllOf(StartsWith("grit: GRIT_ISA=" + other + ": this build has one instruction set, \"" + own + "\" ("),
                      HasSubstr("unset GRIT_ISA, build with -DGRIT_ARCH=" + other +
                                ", or install several with scripts/package.sh\n")));
    EXPECT_EQ(grit(folder.path(), own, {"--version"}, program).status, 0);
  }
}

TEST(Package, RefusesAPluginOfAnother) {
  const OwnFolder folder;
  const auto tag = [&](const std::string& isa) -> std::string {
    return run(folder, isa, isa).at("grit").at("instruction_set");
  };
  const std::string expected = tag(own), found = tag(other);
  if (expected == found) GTEST_SKIP() << "both are " << found;
  const auto outcome = grit(folder.path(), own, {"plugins", "adhesive", "--plugin-path", OUTSIDE "/" + other});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("adhesive.so"),
                                 HasSubstr("instruction set: expected \"" + expected + "\", found \"" + found + '"'),
                                 HasSubstr("cmake/grit -DGRIT_ARCH=" + own + " && ")));
}

TEST(Package, FindsAPluginInTheFolderOfItsOwn) {
  const OwnFolder folder;
  const std::vector<std::string> words{"plugins", "adhesive", "--plugin-path", OUTSIDE};
  const auto found = grit(folder.path(), other, words);
  EXPECT_EQ(found.status, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr(OUTSIDE "/" + other + "/contacts/adhesive.so\n"));
  EXPECT_EQ(grit(folder.path(), own, words).status, 3);
}

}  // namespace
}  // namespace grit
