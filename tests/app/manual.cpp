// Manual pages: what they hold, and that formatters take them without a warning.
#include <gmock/gmock.h>

#include <algorithm>
#include <regex>

#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// The commands by the help.
std::vector<std::string> listed_commands(const std::filesystem::path& folder) {
  const std::string help = grit_in(folder, {"--help"}).out;
  const std::regex line("\n  ([a-z]+) ");
  std::vector<std::string> names;
  for (std::sregex_iterator found(help.begin(), help.end(), line), end; found != end; ++found)
    names.push_back((*found)[1]);
  return names;
}

/// A page as roff writes it, with the marks of fonts removed and "\-" as a hyphen.
std::string plain(const std::string& page) {
  return std::regex_replace(std::regex_replace(page, std::regex("\\\\f[A-Z]"), ""), std::regex("\\\\-"), "-");
}

TEST(Manual, HasTheOptionsOfTheHelp) {
  const OwnFolder folder;
  const auto commands = listed_commands(folder.path());
  ASSERT_GE(commands.size(), 11u);
  std::size_t options = 0;
  for (const auto& command : commands) {
    const auto page = grit_in(folder.path(), {"manual", command});
    EXPECT_EQ(page.status, 0) << page.err;
    for (const char* section : {"NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXIT STATUS", "SEE ALSO"})
      EXPECT_THAT(page.out, HasSubstr(std::string("\n.SH ") + section + '\n')) << command;
    const std::string help = grit_in(folder.path(), {command, "--help"}).out;
    const std::regex option("\n  (?:-[a-z] \\[ )?(--[a-z-]+)(?: \\])?(?: ([^ \n]+))?");
    for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found, ++options) {
      const std::string value = (*found)[2];
      EXPECT_THAT(plain(page.out), HasSubstr((*found)[1].str() + (value.empty() ? "" : " " + value) + '\n')) << command;
    }
  }
  EXPECT_GE(options, 50u);
}

TEST(Manual, OfGritHasCommandsStatusesVariablesAndFiles) {
  const OwnFolder folder;
  const std::string page = plain(grit_in(folder.path(), {"manual"}).out);
  EXPECT_THAT(page, StartsWith(".TH GRIT 1 20"));
  for (const auto& command : listed_commands(folder.path())) {
    EXPECT_THAT(page, HasSubstr(".TP\n" + command));
    EXPECT_THAT(page, HasSubstr("grit-" + command + "(1)"));
  }
  for (const char* term : {"0", "1", "2", "3", "4", "5", "70", "130", "GRIT_ISA", "GRIT_PLUGIN_PATH", "run.json"})
    EXPECT_THAT(page, HasSubstr(std::string(".TP\n") + term + '\n'));
}

TEST(Manual, IsInAscii) {
  const OwnFolder folder;
  auto commands = listed_commands(folder.path());
  commands.emplace_back("");
  for (const auto& command : commands) {
    const auto page = shell(folder.path(), "'" GRIT_BINARY "' manual " + command).out;
    EXPECT_TRUE(std::ranges::all_of(page, [](unsigned char byte) { return byte < 0x80; })) << page;
  }
  EXPECT_THAT(grit_in(folder.path(), {"manual", "run"}).out, HasSubstr("\\fIFILE\\&...\\fR [\\fIoptions\\fR]\n"));
}

TEST(Manual, TellsWhereTheDocumentationIs) {
  const OwnFolder folder;
  EXPECT_THAT(plain(grit_in(folder.path(), {"manual"}).out), HasSubstr("\n.TP\n/usr/share/doc/grit\nPages in docs"));
  for (const auto& command : listed_commands(folder.path()))
    EXPECT_THAT(plain(grit_in(folder.path(), {"manual", command}).out),
                HasSubstr("\n.PP\nThe documentation is in share/doc/grit of"));
}

TEST(Manual, ReplacesOnlyItsOwnPages) {
  const OwnFolder folder;
  folder.write("pages/grit-run.1", ".TH MINE 1\n");
  const auto refused = grit_in(folder.path(), {"manual", "--out", "pages"});
  EXPECT_EQ(refused.status, 5);
  EXPECT_THAT(refused.err, HasSubstr("pages/grit-run.1: grit did not write this file: it would be lost; move it away"));
  EXPECT_EQ(text_of(folder / "pages/grit-run.1"), ".TH MINE 1\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "pages/grit.1")) << "nothing is written";
  std::filesystem::remove(folder / "pages/grit-run.1");
  for (int twice = 0; twice < 2; ++twice) {
    const auto outcome = grit_in(folder.path(), {"manual", "--out", "pages"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_EQ(text_of(folder / "pages/grit-run.1"), grit_in(folder.path(), {"manual", "run"}).out);
}

TEST(Manual, DoesNotDependOnTheMachine) {
  const OwnFolder folder;
  const auto on_one_core = [&](const std::string& command) {
    const std::string core = "$(taskset -pc $$ | sed 's/.*: //; s/[,-].*//')";  // the first of those allowed
    return shell(folder.path(), "taskset -c " + core + " '" GRIT_BINARY "' manual " + command).out;
  };
  for (const char* command : {"run", "check", "study"}) {
    EXPECT_THAT(std::regex_replace(on_one_core(command), std::regex("\n"), " "), HasSubstr("Default: all cores."));
    EXPECT_EQ(on_one_core(command), grit_in(folder.path(), {"manual", command}).out);
  }
}

/// Warnings of a formatter about all pages.
void expect_no_warnings(const std::string& formatter, const std::string& arguments) {
  const OwnFolder folder;
  if (shell(folder.path(), "command -v " + formatter).status != 0) GTEST_SKIP() << formatter << " is not installed";
  ASSERT_EQ(grit_in(folder.path(), {"manual", "--out", "pages"}).status, 0);
  const auto outcome = shell(folder.path(), formatter + ' ' + arguments + " pages/*.1 2>&1");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, IsEmpty());
  folder.write("pages/wrong.1", ".TH X 1\n.SH NAME\nx \\- y\n.nonsense\n\\fQz\n");
  EXPECT_THAT(shell(folder.path(), formatter + ' ' + arguments + " pages/wrong.1 2>&1").out, Not(IsEmpty()));
}

TEST(Manual, IsTakenByGroff) { expect_no_warnings("groff", "-man -ww -z -Tutf8 -rLL=78n"); }
/// A character that a terminal of ASCII has no likeness of is a warning.
TEST(Manual, IsWholeInATerminalOfAscii) { expect_no_warnings("groff", "-man -ww -z -Tascii -rLL=78n"); }
TEST(Manual, IsTakenByMandoc) { expect_no_warnings("mandoc", "-T lint -W style"); }

TEST(Manual, IsWrittenIntoAFolder) {
  const OwnFolder folder;
  ASSERT_EQ(grit_in(folder.path(), {"manual", "--out", "a/man1"}).status, 0);
  EXPECT_EQ(text_of(folder / "a/man1/grit-run.1"), grit_in(folder.path(), {"manual", "run"}).out);
  std::size_t pages = 0;
  for ([[maybe_unused]] const auto& page : std::filesystem::directory_iterator(folder / "a/man1")) ++pages;
  EXPECT_EQ(pages, listed_commands(folder.path()).size() + 1);
}

TEST(Manual, NamesWhatIsWrong) {
  const OwnFolder folder;
  folder.write("file", "");
  struct Case {
    std::vector<std::string> words;
    int status;
    std::string said;
  };
  for (const auto& [words, status, said] : std::vector<Case>{
           {{"manual", "rnu"}, 1, "unknown command \"rnu\"; did you mean \"run\"?"},
           {{"manual", "run", "check"}, 1, "'grit manual' takes one command, not 2"},
           {{"manual", "run", "--out", "pages"},
            1,
            "--out writes the pages of all commands; give it without a command"},
           {{"manual", "--out", "file"}, 5, "file"},
       }) {
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, status) << said;
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err, AllOf(StartsWith("grit: "), HasSubstr(said)));
  }
}

}  // namespace
}  // namespace grit
