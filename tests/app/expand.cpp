// Output of `expand` and `schema`.
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The output of `expand` for a file, run in this folder.
std::string expanded(const std::filesystem::path& folder, const std::string& file) {
  const auto outcome = grit_in(folder, {"expand", file});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.out;
}

class Sims : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Sims, ExpandToPlainDescriptionsThatStayAsTheyAre) {
  const OwnFolder folder;
  const std::string plain = expanded(folder.path(), GetParam());
  EXPECT_FALSE(json::parse(plain).contains("scenario"));
  EXPECT_FALSE(json::parse(plain).contains("extends"));
  folder.write("plain.json", plain);
  EXPECT_EQ(expanded(folder.path(), "plain.json"), plain);
}

/// The small ones alone: the big ones differ from them in numbers, and hold tens of thousands of grains.
class SmallSims : public Sims {};

TEST_P(SmallSims, AreCheckedWhenPlainAsTheyWereBefore) {
  const OwnFolder folder;
  folder.write("plain.json", expanded(folder.path(), GetParam()));
  const auto rest = [&](const std::string& file) {
    const auto outcome = grit_in(folder.path(), {"check", file, "--threads", "1"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    // What is free changes meanwhile.
    const std::regex free("; [^;\n]* are (available|free on this disk)");
    return std::regex_replace(outcome.out.substr(outcome.out.find('\n')), free, "");
  };
  EXPECT_EQ(rest("plain.json"), rest(GetParam()));
}

/// The descriptions of sims/ whose names begin with this.
std::vector<std::filesystem::path> sims(const std::string& start) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(GRIT_SOURCE_DIR "/sims"))
    if (entry.path().extension() == ".json" && entry.path().filename().string().starts_with(start) &&
        entry.path().parent_path().filename() != "studies" && entry.path().parent_path().filename() != "calibrations")
      files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::string name_of(const testing::TestParamInfo<std::filesystem::path>& info) {
  std::string name = info.param.parent_path().filename().string() + "_" + info.param.stem().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Sims, testing::ValuesIn(sims("")), name_of);
INSTANTIATE_TEST_SUITE_P(All, SmallSims, testing::ValuesIn(sims("quick")), name_of);

TEST(Expand, NamesFilesSoThatTheyAreFoundFromAnywhere) {
  const OwnFolder folder;
  auto scene = json::parse(two_grains);
  scene["bodies"]["grains"]["source"] = {{"type", "file"}, {"path", "grains.txt"}};
  folder.write("inner/scene.json", scene.dump());
  folder.write("inner/grains.txt", "0 0 0 1e-3\n");
  folder.write("elsewhere/plain.json", expanded(folder.path(), "inner/scene.json"));
  const auto outcome = grit_in(folder.path(), {"check", "elsewhere/plain.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("bodies: 1,"));
}

TEST(Expand, AppliesSets) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto outcome = grit_in(folder.path(), {"expand", "two.json", "--set", "/seed=7", "--set", "/title=\"other\""});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out).at("seed"), 7);
  EXPECT_EQ(json::parse(outcome.out).at("title"), "other");
}

TEST(Expand, AnObjectThatIsSetReplacesThatOfAFileAndIsMergedOntoThatOfAScenario) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const auto expand = [&](const std::string& file, const std::string& set) {
    const auto outcome = grit_in(folder.path(), {"expand", file, "--set", set});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out);
  };
  EXPECT_EQ(expand("two.json", R"(/materials/sand={"friction_angle": 0.1})").at("materials").at("sand"),
            json({{"friction_angle", 0.1}}));
  const auto platen = expand(GRIT_SOURCE_DIR "/sims/direct-shear/quick.json", R"(/walls/platen={"material": "sand"})")
                          .at("walls")
                          .at("platen");
  EXPECT_EQ(platen.at("material"), "sand");
  EXPECT_TRUE(platen.contains("type"));
  for (const char* command : {"run", "check", "expand", "advise"}) {
    std::string help = grit_in(folder.path(), {command, "--help"}).out;
    help = std::regex_replace(help, std::regex("\\s+"), " ");
    EXPECT_THAT(help, HasSubstr("an object replaces that of the file and is merged onto that of a scenario"))
        << command;
  }
}

TEST(Schema, IsAJsonSchema) {
  const OwnFolder folder;
  const auto outcome = grit_in(folder.path(), {"schema"});
  EXPECT_EQ(outcome.status, 0);
  const auto schema = json::parse(outcome.out);
  EXPECT_EQ(schema.at("$schema"), "http://json-schema.org/draft-07/schema#");
  EXPECT_EQ(schema.at("type"), "object");
}

}  // namespace
}  // namespace grit
