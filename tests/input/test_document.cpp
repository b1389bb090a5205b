#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "folder.hpp"
#include "grit/error.hpp"
#include "input/document.hpp"

using namespace grit;
using testing::HasSubstr;

namespace {

std::string problems_of(const std::filesystem::path& path) {
  try {
    Document::load(path);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return {};
}

std::string problems_of(Document& document, const std::string& assignment) {
  try {
    document.set(assignment);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST(Document, EveryValueHasItsLine) {
  const Folder folder;
  const auto document = Document::load(folder.write(
      "a.json", "{\n\"a\": 1\n,\"b\": [1,\n2\n],\"c\": {\"d\"\n:\ntrue}, \"e\":\n\"x\"\n,\"f\":-1.5e3\n}"));
  const auto line = [&](const char* pointer) { return document.origin(pointer).line; };
  EXPECT_EQ(line(""), 1);
  EXPECT_EQ(line("/a"), 2);  // a number ends at the next character
  EXPECT_EQ(line("/b"), 3);
  EXPECT_EQ(line("/b/0"), 3);
  EXPECT_EQ(line("/b/1"), 4);
  EXPECT_EQ(line("/c"), 5);
  EXPECT_EQ(line("/c/d"), 7);
  EXPECT_EQ(line("/e"), 8);
  EXPECT_EQ(line("/f"), 9);
  EXPECT_EQ(line("/c/not/there"), 5);
  EXPECT_EQ(document.origin("/c/not/there").pointer, "/c/not/there");
}

TEST(Document, IsReadWhateverItsLineEndsAndByteOrderMark) {
  const Folder folder;
  for (const std::string end : {"\n", "\r\n", "\r"})
    for (const std::string mark : {"", "\xef\xbb\xbf"}) {
      const std::string text = mark + "{" + end + "\"a\": 1" + end + ",\"b\": [" + end + end + "2]}" + end;
      for (const Document& document : {Document::load(folder.write("a.json", text)), Document::parse(text, "text")}) {
        EXPECT_EQ(document.json(), Description::parse(R"({"a": 1, "b": [2]})"));
        EXPECT_EQ(document.origin("/a").line, 2);
        EXPECT_EQ(document.origin("/b").line, 3);
        EXPECT_EQ(document.origin("/b/0").line, 5);
      }
      EXPECT_THAT(problems_of(folder.write("b.json", mark + "{\"a\": 1," + end + "\"b\": }" + end)),
                  HasSubstr("b.json:2: not JSON: syntax error"));
    }
}

TEST(Document, ThatIsUtf16IsRefused) {
  const Folder folder;
  for (const char* mark : {"\xff\xfe", "\xfe\xff"}) {
    const auto path = folder.write("a.json", mark);
    EXPECT_THAT([&] { Document::load(path); },
                testing::ThrowsMessage<FileError>(path.string() + ": the file is UTF-16 text; save it as UTF-8"));
    EXPECT_THAT([&] { Document::parse(mark, "text"); },
                testing::ThrowsMessage<FileError>("text: the file is UTF-16 text; save it as UTF-8"));
  }
}

TEST(Document, ProblemsShowControlCharacters) {
  const Folder folder;
  const auto document = Document::parse(R"({"a\u0000b": "x\u001b[1m\u0000y"})", "text");
  const std::string key("/a\0b", 4);
  EXPECT_EQ(describe_value(document.json().front()), "the text \"x\\x1b[1m\\x00y\"");
  const Problem problem = document.problem(key, "unknown key " + key);
  EXPECT_EQ(problem.pointer, "/a\\x00b");
  EXPECT_EQ(problem.message, "unknown key /a\\x00b");
  EXPECT_THAT(problems_of(folder.write("a.json", R"({"a\u0000b": 1, "a\u0000b": 2})")),
              HasSubstr("a.json:1: /a\\x00b: the key \"a\\x00b\" appears twice, first in line 1"));
  EXPECT_THAT(problems_of(folder.write("b.json", "{\"a\": \"\xff\"}")), HasSubstr("last read: '\"\\xff'"));
}

TEST(Document, CommentsAreDroppedWhateverTheyHold) {
  const Folder folder;
  const auto document = Document::load(folder.write(
      "a.json", R"({"//": {"x": [1, {"//": 2}], "y": "z"}, "a": [{"//": [[]]}, 2], "//": 3, "b": {"//": null}})"));
  EXPECT_EQ(document.json().dump(), R"({"a":[{},2],"b":{}})");
}

TEST(Document, AllDuplicateKeysAreReported) {
  const Folder folder;
  const auto path = folder.write("a.json", "{\"a\": 1,\n\"a\": 2,\n\"b\": {\"c/d\": 1,\n\"c/d\": 1}}");
  EXPECT_EQ(problems_of(path),
            path.string() + ":2: /a: the key \"a\" appears twice, first in line 1; keep one of them\n" + path.string() +
                ":4: /b/c~1d: the key \"c/d\" appears twice, first in line 3; keep one of them");
}

TEST(Document, WhatIsNotJsonIsRefusedWithItsLine) {
  const Folder folder;
  EXPECT_THAT(problems_of(folder.write("a.json", "{\"a\": 1,\n\"b\": }\n")),
              HasSubstr("a.json:2: not JSON: syntax error"));
  EXPECT_THAT(problems_of(folder.write("b.json", "{\"a\": {\"b\": 1\n")),
              HasSubstr("b.json:1: /a: not JSON: syntax error"));
  EXPECT_THAT(problems_of(folder.write("c.json", "{} {}")), HasSubstr("c.json:1: not JSON"));
  EXPECT_THAT(problems_of(folder.write("d.json", "")), HasSubstr("d.json:1: not JSON"));
  EXPECT_THAT(problems_of(folder.write("e.json", "{\"a\":\n1e999}")), HasSubstr("e.json:2: not JSON: number overflow"));
  EXPECT_THAT(problems_of(folder.write("f.json", "[1]")),
              HasSubstr("f.json:1: found a list; a description is an object"));
}

TEST(Document, AFileThatCannotBeReadIsNoDescriptionError) {
  const Folder folder;
  EXPECT_THROW(Document::load(folder.path() / "none.json"), FileError);
  EXPECT_THROW(Document::load(folder.path()), FileError);
}

TEST(Document, ExtendingMergesAndKeepsOrigins) {
  const Folder folder;
  folder.write("base/base.json", "{\"a\": {\"x\": 1,\n\"y\": [1, 2]},\n\"b\": {\"z\": 1}, \"c\": 1}");
  folder.write("base/middle.json", "{\"extends\": \"base.json\",\n\"d\": {\"new\": {\"k\": 1, \"n\": null}}}");
  const auto top = folder.write(
      "top.json", "{\n\"extends\": \"base/middle.json\",\n\"a\": {\"y\":\n[3]}, \"b\": null, \"c\": {\"q\": 2}}");
  const auto document = Document::load(top);
  EXPECT_EQ(document.json(), Description::parse(R"({"a":{"x":1,"y":[3]},"c":{"q":2},"d":{"new":{"k":1}}})"));
  EXPECT_EQ(document.origin("/a/x").source->name, (folder.path() / "base/base.json").string());
  EXPECT_EQ(document.origin("/a/x").line, 1);
  EXPECT_EQ(document.origin("/a/y/0").source->name, top.string());
  EXPECT_EQ(document.origin("/a/y/0").line, 4);
  EXPECT_EQ(document.origin("/a/y/1").line, 4);  // removed with its list
  EXPECT_EQ(document.origin("/b/z").pointer, "/b/z");
  EXPECT_EQ(document.origin("/c/q").line, 4);
  EXPECT_EQ(document.origin("/d/new/k").source->name, (folder.path() / "base/middle.json").string());
}

TEST(Document, EntriesOfAListAreMergedByIndex) {
  const auto merged = [](const char* patch) {
    Document document(Description::parse(R"({"l": [{"x": 1, "y": 2}, 3]})"), "base");
    document.merge(Document(Description::parse(patch), "patch"));
    EXPECT_EQ(document.origin("/l/0/y").source->name, document.json()["l"].is_array() ? "base" : "patch");
    return document.json()["l"];
  };
  EXPECT_EQ(merged(R"({"l": {"0": {"x": 5}, "1": [4]}})"), Description::parse(R"([{"x": 5, "y": 2}, [4]])"));
  for (const char* other : {R"({"0": 1, "x": 1})", R"({"0": null})", "{}"})
    EXPECT_TRUE(merged((R"({"l": )" + std::string(other) + '}').c_str()).is_object()) << other;
}

TEST(Document, CirclesAndMissingFilesAreRefused) {
  const Folder folder;
  folder.write("b.json", "{\"extends\": \"a.json\"}");
  EXPECT_THAT(problems_of(folder.write("a.json", "{\n\"extends\": \"./b.json\"}")), HasSubstr("b.json:1: /extends: "));
  EXPECT_THAT(problems_of(folder.path() / "a.json"), HasSubstr("a.json extends itself"));
  EXPECT_THAT(problems_of(folder.write("c.json", "{\n\"extends\": \"none.json\"}")),
              HasSubstr("c.json:2: /extends: there is no file"));
  EXPECT_THAT(problems_of(folder.write("d.json", "{\"extends\": 5}")),
              HasSubstr("found the number 5; allowed is the path"));
}

TEST(Document, SetTakesJsonOrText) {
  Document document(Description::parse(R"({"a": {"b": 1}, "l": [1, {"x": 1}]})"), "test");
  document.set("/a/b=2.5");
  document.set("/a/c=200 kPa");
  document.set("/new/deep/er={\"//\": 0, \"k\": [1]}");
  document.set("/l/1/x=true");
  document.set("/l/-=7");
  document.set("/t=x=y");
  document.set("/e~1f=");
  document.set("/l/0=\"3\"");
  EXPECT_EQ(document.json(), Description::parse(R"({"a": {"b": 2.5, "c": "200 kPa"}, "l": ["3", {"x": true}, 7],
      "new": {"deep": {"er": {"k": [1]}}}, "t": "x=y", "e/f": ""})"));
  document.set("/a/b=null");
  EXPECT_FALSE(document.json().at("a").contains("b"));
  EXPECT_EQ(document.origin("/a/c").source->name, "--set");
  EXPECT_EQ(document.origin("/new/deep").source->name, "--set");
  EXPECT_EQ(document.origin("/new/deep").pointer, "/new/deep");
  EXPECT_EQ(document.origin("/l/1").source->name, "test");
}

TEST(Document, MergingRefusesAnIndexBeyondTheList) {
  Document list(Description::parse(R"({"l": [{"a": 1}, {"a": 2}]})"), "base");
  for (const std::string number : {"2", "00"}) {
    Document patch(Description::parse("{}"), "test");
    patch.set("/l/" + number + "/a=3");
    try {
      list.merge(patch);
      ADD_FAILURE() << list.json();
    } catch (const DescriptionError& error) {
      ASSERT_EQ(error.problems().size(), 1u);
      EXPECT_EQ(error.problems()[0].message,
                "there is no entry \"" + number + "\" in /l, which has 2 entries, counted from 0");
      EXPECT_EQ(error.problems()[0].pointer, "/l/" + number);
      EXPECT_EQ(error.problems()[0].file, "--set");
    }
  }
  Document another(Description::parse(R"({"l": {"type": "other"}})"), "test");
  list.merge(another);
  EXPECT_EQ(list.json(), Description::parse(R"({"l": {"type": "other"}})")) << "a value of another kind replaces it";
}

TEST(Document, SetRefusesWhatItCannotDo) {
  Document document(Description::parse(R"({"a": 1, "l": [1]})"), "test");
  EXPECT_EQ(problems_of(document, "/a/b=1"), "--set: /a/b: there is nothing below /a, which is the number 1");
  EXPECT_EQ(problems_of(document, "/l/1=1"),
            "--set: /l/1: there is no entry \"1\" in /l, which has 1 entry, counted from 0");
  EXPECT_EQ(problems_of(document, "/l/00=1"),
            "--set: /l/00: there is no entry \"00\" in /l, which has 1 entry, counted from 0");
  EXPECT_EQ(problems_of(document, "a=1"), "--set: a: found \"a\"; allowed is a JSON pointer, e.g. /stages/0/limit");
  EXPECT_EQ(problems_of(document, "/a~2=1"),
            "--set: /a~2: found \"/a~2\"; allowed is a JSON pointer, e.g. /stages/0/limit");
  EXPECT_THAT(problems_of(document, "/a"), HasSubstr("found \"/a\"; allowed is /pointer=value"));
  EXPECT_THAT(problems_of(document, "/b={\"x\": 1, \"x\": 2}"), HasSubstr("--set:1: /x: the key \"x\" appears twice"));
  EXPECT_EQ(document.json(), Description::parse(R"({"a": 1, "l": [1]})"));
}

TEST(Document, IsNotNestedDeeplyNorHasEndlessKeys) {
  const Folder folder;
  const auto nested = [](std::size_t levels) {
    return R"({"a": )" + std::string(levels - 1, '[') + std::string(levels - 1, ']') + "}";
  };
  EXPECT_EQ(problems_of(folder.write("a.json", nested(100))), "");
  const std::string levels =
      "found lists and objects inside each other at more than 100 levels; allowed is up to 100 levels";
  EXPECT_THAT(problems_of(folder.write("a.json", "{\n" + nested(101).substr(1))),
              testing::AllOf(HasSubstr("a.json:2: /a/0/0/"), HasSubstr("…: " + levels)));
  EXPECT_THAT(problems_of(folder.write("a.json", std::string(50'000, '['))), HasSubstr(levels)) << "not complete";
  EXPECT_THAT(problems_of(folder.write("a.json", R"({"//": )" + std::string(50'000, '['))), HasSubstr(levels))
      << "in a comment";
  std::string objects;
  for (int i = 0; i < 8000; ++i) objects += R"({"x":)";
  EXPECT_THAT(problems_of(folder.write("a.json", objects)), HasSubstr(levels));
  EXPECT_THAT(problems_of(folder.write("a.json", "{\"" + std::string(2001, 'k') + "\": [1]}")),
              HasSubstr("found keys of more than 2000 characters in all; allowed is shorter keys, or fewer levels"));
  Document document;
  EXPECT_THAT(problems_of(document, "/a=" + nested(101)), HasSubstr("--set:1: /a/0/0/"));
  EXPECT_THAT(problems_of(document, "/a=" + nested(101)), HasSubstr(levels));
  EXPECT_EQ(problems_of(document, "/a=[[1"), "") << "a text";
  EXPECT_EQ(document.json().at("a"), "[[1");
}
