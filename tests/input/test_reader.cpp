#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "folder.hpp"
#include "input/reader.hpp"
#include "input/reference.hpp"
#include "plugins/parameter_values.hpp"

using namespace grit;
using testing::HasSubstr;

namespace {

struct Round {
  static constexpr const char* type_name = "round";
  static constexpr const char* type_doc = "a ball";
  double radius = 0.5;
  void declare(Parameters& p) { p.add("radius", radius).unit("m").above(0).doc("of the thing"); }
};
struct Tree;
struct Tall {
  static constexpr const char* type_name = "tall";
  static constexpr const char* type_doc = "a stack of parts";
  std::vector<std::unique_ptr<Tree>> parts;
  void declare(Parameters& p);
};
struct Tree {
  OneOf<Round, Tall> is{"shape"};
  void declare(Parameters& p) { p.choose(is); }
};
void Tall::declare(Parameters& p) {
  p.add_target("parts", ListTarget{[this] { return parts.size(); }, [this] { parts.clear(); },
                                   [this](Parameters& q) { parts.emplace_back(std::make_unique<Tree>())->declare(q); },
                                   [this](std::size_t i, Parameters& q) { parts[i]->declare(q); }})
      .doc("its parts");
}

/// A parameter of every kind that can be declared.
struct Everything {
  double modulus = 3e8, share = 0.1;
  std::optional<double> limit;
  std::int64_t count = 3;
  bool flag = true;
  std::string word = "one", text, file;
  Vec3 place{1, 2, 3};
  std::optional<Vec3> about;
  std::array<bool, 3> axes{true, false, true};
  std::vector<double> lengths{0.1, 0.2};
  std::vector<std::string> names{"a"};
  Description free = {{"x", 1}};
  Round round;
  std::optional<Round> maybe;
  std::deque<Round> list;
  std::map<std::string, Round> by_name;
  Tree tree;
  int checked = 0;

  void declare(Parameters& p) {
    p.add("modulus", modulus).unit("Pa").symbol("E").above(0).doc("modulus");
    p.add("share", share).at_least(0).at_most(1);
    p.add("limit", limit).unit("s").above(0);
    p.add("count", count).at_least(1).at_most(10);
    p.add("flag", flag);
    p.add("word", word).one_of({"one", "two"});
    p.add("text", text);
    p.add("file", file).file();
    p.add("place", place).unit("m");
    p.add("about", about).unit("m");
    p.add("axes", axes);
    p.add("lengths", lengths).unit("m").above(0).entries(2);
    p.add("names", names);
    p.add("free", free);
    p.add("round", round);
    p.add("maybe", maybe);
    p.add("list", list).entries(1);
    p.add("by_name", by_name);
    p.add("tree", tree);
    p.check([this](const Complain& complain) {
      ++checked;
      if (count == 7) complain("count", "7", "anything else");
    });
  }
};

Description written(Everything& object) {
  Parameters p;
  object.declare(p);
  return write(p);
}

std::string problems_of(Everything& object, const Description& json) {
  Parameters p;
  object.declare(p);
  std::vector<Problem> problems;
  read(Document(json, "test"), "", p, problems);
  return problems.empty() ? "" : DescriptionError(problems).what();
}

const char* const full = R"({"modulus": "200 kPa", "share": "25 %", "limit": "2 min", "count": 1e1, "flag": false,
  "word": "two", "text": "ä/~", "file": "/x/y", "place": [0, "1 mm", -1], "about": ["1 cm", 0, 0],
  "axes": [false, true, false], "lengths": [1, "2 mm", 3], "names": [], "free": [null, {"a": "5 kPa"}],
  "round": {"radius": 2}, "maybe": {"radius": 3}, "list": [{"radius": 4}, {}], "by_name": {"b": {"radius": 5}, "a": {}},
  "tree": {"type": "tall", "parts": [{"type": "round", "radius": "6 mm"}, {"type": "tall"}]}})";

}  // namespace

TEST(Reader, SuggestsDegreesForAnglesOutsideTheirRange) {
  struct Angles {
    double steep = 0, any = 0;
    void declare(Parameters& p) {
      p.add("steep", steep).unit("rad").at_least(0).below(1.5);
      p.add("any", any).unit("rad");
    }
  };
  const auto problems = [](const char* json) {
    Angles angles;
    Parameters p;
    angles.declare(p);
    std::vector<Problem> all;
    read(Document(Description::parse(json), "test"), "", p, all);
    return all.empty() ? "" : std::string(DescriptionError(all).what());
  };
  EXPECT_EQ(problems(R"({"steep": 30})"),
            "test: /steep: found 30 rad; did you mean \"30 deg\"? Allowed is from 0 rad to below 1.5 rad");
  EXPECT_EQ(problems(R"({"steep": 100})"), "test: /steep: found 100 rad; allowed is from 0 rad to below 1.5 rad");
  EXPECT_EQ(problems(R"({"steep": -30})"), "test: /steep: found -30 rad; allowed is from 0 rad to below 1.5 rad");
  EXPECT_EQ(problems(R"({"steep": "100 deg"})"),
            "test: /steep: found 100 deg; allowed is from 0 deg to below 85.9437 deg");
  EXPECT_EQ(problems(R"({"any": 30})"), "");
}

TEST(Reader, FillsWhatWasDeclared) {
  Everything x;
  EXPECT_EQ(problems_of(x, Description::parse(full)), "");
  EXPECT_EQ(x.modulus, 2e5);
  EXPECT_EQ(x.share, 0.25);
  EXPECT_EQ(x.limit, 120);
  EXPECT_EQ(x.count, 10);
  EXPECT_FALSE(x.flag);
  EXPECT_EQ(x.word, "two");
  EXPECT_EQ(x.text, "ä/~");
  EXPECT_EQ(x.place, Vec3(0, 1e-3, -1));
  EXPECT_EQ(x.about, Vec3(0.01, 0, 0));
  EXPECT_EQ(x.axes, (std::array{false, true, false}));
  EXPECT_EQ(x.lengths, (std::vector{1.0, 2e-3, 3.0}));
  EXPECT_TRUE(x.names.empty());
  EXPECT_EQ(x.round.radius, 2);
  EXPECT_EQ(x.maybe->radius, 3);
  EXPECT_EQ(x.list.at(1).radius, 0.5);
  EXPECT_EQ(x.by_name.at("b").radius, 5);
  const auto& parts = std::get<Tall>(x.tree.is.value()).parts;
  EXPECT_EQ(std::get<Round>(parts.at(0)->is.value()).radius, 6e-3);
  EXPECT_EQ(parts.at(1)->is.type(), "tall");
  EXPECT_EQ(x.checked, 1);
}

TEST(Reader, KeepsDefaultsOfMissingKeys) {
  Everything x;
  EXPECT_EQ(problems_of(x, Description::object()), "");
  EXPECT_EQ(x.modulus, 3e8);
  EXPECT_EQ(x.lengths.size(), 2u);
  EXPECT_FALSE(x.maybe);
  EXPECT_EQ(x.tree.is.type(), "");
}

TEST(Writer, WhatIsWrittenReadsTheSame) {
  for (const char* text : {"{}", full}) {
    Everything x, y;
    ASSERT_EQ(problems_of(x, Description::parse(text)), "");
    const Description first = written(x);
    ASSERT_EQ(problems_of(y, first), "");
    EXPECT_EQ(written(y).dump(), first.dump());
    // As text, too: numbers keep all digits.
    EXPECT_EQ(Description::parse(first.dump(2)), first);
  }
}

TEST(Writer, WritesAllInSi) {
  Everything x;
  ASSERT_EQ(problems_of(x, Description::parse(full)), "");
  const Description all = written(x);
  EXPECT_EQ(all.at("modulus"), 2e5);
  EXPECT_EQ(all.at("place"), Description::parse("[0.0, 1e-3, -1.0]"));
  EXPECT_EQ(all.at("tree").dump(),
            R"({"type":"tall","parts":[{"type":"round","radius":0.006},{"type":"tall","parts":[]}]})");
  Everything y;
  EXPECT_FALSE(written(y).contains("limit"));
  EXPECT_FALSE(written(y).contains("maybe"));
  EXPECT_FALSE(written(y).contains("tree"));
}

TEST(Reader, ReportsEveryProblemAtOnce) {
  Everything x;
  const std::string text =
      problems_of(x, Description::parse(R"({"modulus": "2 m", "share": 2, "limit": "5", "count": 11,
      "flag": 1, "word": "tow", "place": [1, 2], "lengths": [-1, 1], "names": ["a", 2], "rond": 1, "list": [],
      "by_name": {"a": {"radius": 0}, "b c": {}}, "tree": {"type": "tall", "parts": [{"type": "rund"}, {}]}})"));
  for (const char* line :
       {"test: /rond: unknown key \"rond\"; did you mean \"round\"? Allowed are modulus, share, limit",
        "test: /modulus: found the text \"2 m\"; allowed is a number of Pa, or a text with a number and one of Pa, kPa",
        "test: /share: found 2; allowed is from 0 to 1",
        "test: /limit: found the text \"5\", a number without a unit; allowed is a number of s",
        "test: /count: found 11; allowed is from 1 to 10", "test: /flag: found the number 1; allowed is true or false",
        "test: /word: found \"tow\"; did you mean \"two\"? Allowed is one of one, two",
        "test: /place: found a list of 2; allowed is a list of 3 numbers",
        "test: /lengths/0: found -1 m; allowed is above 0 m", "test: /names/1: found the number 2; allowed is a text",
        "test: /list: found 0 entries; allowed are 1 or more",
        "test: /by_name/a/radius: found 0 m; allowed is above 0 m", "test: /by_name/b c: found the name \"b c\"",
        "test: /tree/parts/0/type: unknown shape \"rund\"; did you mean \"round\"? Allowed are round, tall",
        "test: /tree/parts/1: missing key \"type\", the shape; allowed are round, tall"})
    EXPECT_THAT(text, HasSubstr(line));
  EXPECT_EQ(std::ranges::count(text, '\n'), 14) << text;
  EXPECT_EQ(x.checked, 0);
  EXPECT_EQ(x.modulus, 3e8);
}

TEST(Reader, ChecksReportTheirKey) {
  Everything x;
  EXPECT_EQ(problems_of(x, {{"count", 7}}), "test: /count: found 7; allowed is anything else");
}

TEST(Reader, AKeyDeclaredTwiceIsThePluginsFault) {
  double number = 0;
  Parameters p;
  p.add("a", number), p.add("a", number);
  std::vector<Problem> problems;
  EXPECT_THROW(read(Document(Description::object(), "test"), "", p, problems), PluginError);
}

TEST(Reader, FilesAreThoseBesideTheDescription) {
  const Folder folder;
  folder.write("base/base.json", R"({"file": "grains.txt"})");
  const auto path = folder.write("top.json", R"({"extends": "base/base.json"})");
  Everything x;
  Parameters p;
  x.declare(p);
  read(Document::load(path), p);
  EXPECT_EQ(x.file, (folder.path() / "base/grains.txt").string());

  Document document = Document::load(path);
  document.set("/file=other.txt");
  Everything y;
  Parameters q;
  y.declare(q);
  read(document, q);
  EXPECT_EQ(y.file, (std::filesystem::current_path() / "other.txt").string());
}

TEST(Reference, ListsEveryParameter) {
  Everything x;
  Parameters p;
  x.declare(p);
  const std::string text = reference_text(p);
  const auto line = [&](const std::string& name) {
    const auto at = text.find('\n' + name) + 1;
    std::string found = text.substr(at, text.find('\n', at) - at);
    found.erase(std::unique(found.begin(), found.end(), [](char a, char b) { return a == ' ' && b == ' '; }),
                found.end());
    return found;
  };
  EXPECT_EQ(line("modulus"), "modulus E Pa 300 MPa above 0 Pa modulus");
  EXPECT_EQ(line("share"), "share number 0.1 from 0 to 1");
  EXPECT_EQ(line("limit"), "limit s none above 0 s");
  EXPECT_EQ(line("count"), "count integer 3 from 1 to 10");
  EXPECT_EQ(line("word"), "word text one one, two");
  EXPECT_EQ(line("place"), "place 3 × m 1 m, 2 m, 3 m any");
  EXPECT_EQ(line("  radius"), " radius m 0.5 m above 0 m of the thing");
  EXPECT_EQ(line("  type"), " type one of required round, tall shape");
  EXPECT_EQ(line("    \"round\""), " \"round\" a ball");
  EXPECT_EQ(line("        type"), " type one of required round, tall shape, as above");
}
