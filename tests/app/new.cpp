// `grit new`: plugins of one's own, from the examples of the guides.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Example {
  const char* kind;
  const char* name;
  const char* page;
  const char* type;  ///< the class

  friend void PrintTo(const Example& example, std::ostream* out) { *out << example.kind; }
};
class New : public testing::TestWithParam<Example> {
 protected:
  std::string block(const std::string& file) const {
    const std::string page = text_of(GRIT_SOURCE_DIR "/docs/plugins/" + std::string(GetParam().page));
    const std::string head = ' ' + file + '\n';
    const auto begin = page.find(head) + head.size();
    return page.substr(begin, page.find("```", begin) - begin);
  }
  Outcome grit(std::vector<std::string> words) const { return grit_in(folder.path(), std::move(words)); }
  OwnFolder folder;
};

TEST_P(New, WithTheNameOfTheExampleIsTheExample) {
  const auto [kind, name, page, type] = GetParam();
  const auto made = grit({"new", kind, name});
  ASSERT_EQ(made.status, 0) << made.err;
  for (const std::string& file :
       {std::string(name) + ".hpp", std::string(name) + ".cpp", "test_" + std::string(name) + ".cpp"})
    EXPECT_EQ(text_of(folder / (std::string(name) + '/' + file)), block(file)) << file;
}

TEST_P(New, HasTheNewNameEverywhere) {
  const auto [kind, name, page, type] = GetParam();
  ASSERT_EQ(grit({"new", kind, "my-own2", "--out", "deep/er"}).status, 0);
  const std::string code = text_of(folder / "deep/er/my-own2.hpp") + text_of(folder / "deep/er/my-own2.cpp"),
                    test = text_of(folder / "deep/er/test_my-own2.cpp"),
                    lists = text_of(folder / "deep/er/CMakeLists.txt");
  EXPECT_THAT(code, AllOf(HasSubstr("#include \"my-own2.hpp\""), HasSubstr("\"my-own2\""), HasSubstr(" MyOwn2 ")));
  EXPECT_THAT(test, AllOf(HasSubstr("#include \"my-own2.hpp\""), HasSubstr("MyOwn2")));
  EXPECT_THAT(lists, AllOf(HasSubstr(" my-own2)"), HasSubstr("find_package(grit ")));
  for (const std::string& text : {code, test, lists}) {
    EXPECT_THAT(text, Not(HasSubstr('"' + std::string(name) + '"')));
    EXPECT_FALSE(std::regex_search(text, std::regex("\\b" + std::string(type) + "\\b")));
  }
}

/// "state" would make a class State, which the example of a law has, too.
TEST_P(New, NamesAClassAsNothingElseIsNamed) {
  const auto [kind, name, page, type] = GetParam();
  const std::string code = block(std::string(name) + ".hpp");
  const std::regex capital("\\b[A-Z][a-z]+\\b");
  for (std::sregex_iterator word(code.begin(), code.end(), capital), end; word != end; ++word) {
    const std::string taken = word->str();
    if (taken == type) continue;
    std::string own = taken;
    own[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(own[0])));
    const std::string out = "of-" + own;
    if (std::filesystem::exists(folder / out)) continue;
    ASSERT_EQ(grit({"new", kind, own, "--out", out}).status, 0) << own;
    EXPECT_THAT(text_of(folder / (out + '/' + own + ".cpp")), HasSubstr(taken + "Plugin"));
  }
}

TEST_P(New, NamesTheGuideAndThePackagesOfItsTest) {
  ASSERT_EQ(grit({"new", GetParam().kind, "my-own"}).status, 0);
  const std::string readme = text_of(folder / "my-own/README.md"), packages = "libgtest-dev libgmock-dev",
                    guide = std::string("docs/plugins/") + GetParam().page;
  EXPECT_THAT(readme, AllOf(HasSubstr(guide + '`'), HasSubstr(packages)));
  EXPECT_THAT(text_of(folder / "my-own/CMakeLists.txt"), HasSubstr(packages));
}

/// As a law that meets no contact cannot be tried. The example of the kind is not installed here.
TEST(NewPlugin, HasASceneWithContacts) {
  const OwnFolder folder;
  ASSERT_EQ(grit_in(folder.path(), {"new", "contact", "my-own"}).status, 0);
  const auto run =
      grit_in(folder.path(), {"run", "my-own/scene.json", "--set", "/contacts/type=linear-rolling", "--out", "out"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto facts = nlohmann::json::parse(text_of(folder / "out/run.json"));
  EXPECT_GT(facts.at("contacts_per_body").get<double>(), 0.5);
  EXPECT_EQ(facts.at("warnings").size(), 0u) << facts.at("warnings");
}

TEST_P(New, ReplacesNothing) {
  folder.write("mine.txt", "");
  std::filesystem::create_directories(folder / "my-own");
  folder.write("my-own/notes.txt", "kept");
  for (const char* out : {"my-own", "mine.txt"}) {
    const auto refused = grit({"new", GetParam().kind, "my-own", "--out", out});
    EXPECT_EQ(refused.status, 5);
    EXPECT_THAT(refused.err, AllOf(HasSubstr(out), HasSubstr("nothing was written")));
  }
  EXPECT_EQ(text_of(folder / "my-own/notes.txt"), "kept");
  EXPECT_FALSE(std::filesystem::exists(folder / "my-own/CMakeLists.txt"));
}

INSTANTIATE_TEST_SUITE_P(Kind, New,
                         testing::Values(Example{"contact", "adhesive", "contact-law.md", "Adhesive"},
                                         Example{"geometry", "ball", "geometry.md", "Ball"},
                                         Example{"probe", "peak-speed", "probe.md", "PeakSpeed"},
                                         Example{"engine", "linear-drag", "engine.md", "LinearDrag"},
                                         Example{"scenario", "heap", "scenario.md", "Heap"},
                                         Example{"body", "shell", "body.md", "Shell"}),
                         [](const auto& info) { return std::string(info.param.kind); });

TEST(NewPlugin, RefusesWhatCannotBe) {
  const OwnFolder folder;
  const auto refusal = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "new");
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.out, IsEmpty());
    return outcome.err;
  };
  EXPECT_THAT(refusal({"contact"}), HasSubstr("takes a kind and a name, as in 'grit new contact my-law'"));
  EXPECT_THAT(refusal({"contacts", "mine"}), HasSubstr("found the kind \"contacts\"; did you mean \"contact\"?"));
  EXPECT_THAT(refusal({"law", "mine"}), HasSubstr("allowed are contact, geometry, probe, engine, scenario, body"));
  for (const char* name : {"My", "2nd", "a_b", "a--b", "a-", "../a", "a/b", "a b", "ä"})
    EXPECT_THAT(refusal({"contact", name}), HasSubstr("lower-case letters")) << name;
  EXPECT_THAT(refusal({"contact", ""}), HasSubstr("found an empty name"));
  EXPECT_THAT(refusal({"contact", "linear-rolling"}), HasSubstr("which an installed contact has"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace grit
