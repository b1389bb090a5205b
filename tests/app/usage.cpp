// Help, version and wrong command lines: exit status 0 and 1. Output that cannot be written: 5.
#include <gmock/gmock.h>

#include <sstream>
#include <thread>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

const std::vector<std::string> all_commands{"run",   "check",     "expand", "schema", "plugins", "describe",
                                            "study", "calibrate", "advise", "report", "manual"};

std::size_t widest_line(const std::string& text) {
  std::size_t widest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, line.size());
  return widest;
}

TEST(Usage, HelpNamesEveryCommandAndStatus) {
  const OwnFolder folder;
  const auto help = grit_in(folder.path(), {"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.err, IsEmpty());
  for (const auto& command : all_commands) EXPECT_THAT(help.out, HasSubstr("\n  " + command + " "));
  EXPECT_THAT(help.out, HasSubstr("0 done, 1 usage, 2 description, 3 plugin, 4 numerics, 5 files or disk"));
  EXPECT_THAT(help.out, HasSubstr("130 interrupted and saved"));
  // That of the source tree, if the program has been built inside.
  const bool inside = std::string(GRIT_BINARY).starts_with(GRIT_SOURCE_DIR "/");
  EXPECT_THAT(help.out, HasSubstr(inside ? "\nDocumentation: " GRIT_SOURCE_DIR "/docs\n" : "\nDocumentation: "));
  EXPECT_LE(widest_line(help.out), 100u);
  EXPECT_EQ(grit_in(folder.path(), {"-h"}).out, help.out);
  EXPECT_EQ(grit_in(folder.path(), {"help"}).out, help.out);
}

TEST(Usage, EveryCommandHasHelp) {
  const OwnFolder folder;
  for (const auto& command : all_commands) {
    const auto help = grit_in(folder.path(), {command, "--help"});
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_THAT(help.err, IsEmpty());
    EXPECT_THAT(help.out,
                AllOf(StartsWith("grit " + command + " "), HasSubstr("[options]\n\n"), HasSubstr("--plugin-path")));
    EXPECT_LE(widest_line(help.out), 100u) << command;
    EXPECT_EQ(grit_in(folder.path(), {"help", command}).out, help.out);
  }
}

TEST(Usage, ResultsHaveTheNameOfTheFile) {
  const OwnFolder folder;
  for (const char* name : {"..json", "...json"}) {
    folder.write(name, two_grains);
    for (const char* command : {"run", "study", "calibrate"}) {
      const auto outcome = grit_in(folder.path(), {command, name});
      EXPECT_NE(outcome.status, 0);
      EXPECT_FALSE(std::filesystem::exists(folder / "results")) << command << ' ' << name;
      EXPECT_FALSE(std::filesystem::exists(folder / "run.json")) << command << ' ' << name;
    }
    const auto run = grit_in(folder.path(), {"run", name});
    EXPECT_EQ(run.status, 1);
    EXPECT_THAT(run.err,
                HasSubstr(std::string(name) +
                          ": no folder of results can have this name; rename the file, or give a folder with --out"));
    EXPECT_EQ(grit_in(folder.path(), {"run", name, "--out", "named", "--overwrite", "-q"}).status, 0);
  }
}

TEST(Usage, IsInUtf8) {
  const OwnFolder folder;
  for (const char* word : {"/title=\xff", "/title=\xc3", "/title=\xed\xa0\x80", "/title=\xc0\xaf"}) {
    const auto outcome = grit_in(folder.path(), {"check", "two.json", "--set", word});
    EXPECT_EQ(outcome.status, 1) << word;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("grit: found \"/title=\\x"), HasSubstr("which is not UTF-8"))) << word;
  }
  folder.write("\xe9t\xe9.json", "{}");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "\xe9t\xe9.json"}, {"study", "x.json", "--out", "\xff"}, {"\xff"}}) {
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("which is not UTF-8")) << outcome.err;
  }
  std::filesystem::create_directory(folder.path() / "\xe9");
  const auto there = grit_in(folder.path() / "\xe9", {"plugins"});
  EXPECT_EQ(there.status, 5);
  EXPECT_THAT(there.err, HasSubstr("\\xe9: the name of the working folder is not UTF-8"));
}

TEST(Usage, VersionSaysWhatWasBuilt) {
  const OwnFolder folder;
  const auto version = grit_in(folder.path(), {"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.out, StartsWith("grit " GRIT_VERSION));
  EXPECT_THAT(version.out, AllOf(HasSubstr("\ncompiler flags: -march=" GRIT_ARCH " "), HasSubstr("-ffp-contract=")));
  EXPECT_THAT(version.out,
              ContainsRegex("\nlibraries: Boost 1\\.[0-9.]+, Eigen [0-9.]+, fmt [0-9.]+, HDF5 1\\.[0-9.]+, "
                            "nlohmann_json [0-9.]+, spdlog [0-9.]+, zlib [0-9.]+\n"));
  EXPECT_THAT(
      version.out,
      ContainsRegex("\nplugin interface \\(SDK\\): version [0-9]+\nGPUs: (by CUDA|none \\(built without nvcc\\))\n$"));
}

TEST(Usage, AnInstructionSetThatIsNotTheBuildsOwnIsRefused) {
  const OwnFolder folder;
  const auto outcome = shell(folder.path(), "GRIT_ISA=x86-64-v9 '" GRIT_BINARY "' --version");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err,
              StartsWith("grit: GRIT_ISA=x86-64-v9: this build has one instruction set, \"" GRIT_ARCH "\" ("));
  for (const auto* allowed : {"", GRIT_ARCH})
    EXPECT_EQ(shell(folder.path(), std::string("GRIT_ISA='") + allowed + "' '" GRIT_BINARY "' --version").status, 0);
}

TEST(Usage, NoWordsShowTheHelpAsAnError) {
  const OwnFolder folder;
  const auto nothing = grit_in(folder.path(), {});
  EXPECT_EQ(nothing.status, 1);
  EXPECT_THAT(nothing.out, IsEmpty());
  EXPECT_THAT(nothing.err, HasSubstr("usage: grit COMMAND [options]"));
}

struct Wrong {
  std::vector<std::string> words;
  std::string said;
};

TEST(Usage, WrongWordsAreNamed) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  for (const auto& [words, said] : std::vector<Wrong>{
           {{"rnu"}, "unknown command \"rnu\"; did you mean \"run\"? See 'grit --help'"},
           {{"frobnicate"}, "unknown command \"frobnicate\"; see 'grit --help'"},
           {{"--verbose"}, "unknown option \"--verbose\"; see 'grit --help'"},
           {{"help", "rnu"}, "unknown command \"rnu\"; did you mean \"run\"?"},
           {{"run"}, "no description given; see 'grit run --help'"},
           {{"check"}, "no description given; see 'grit check --help'"},
           {{"expand"}, "'grit expand' takes one description, not none; see 'grit expand --help'"},
           {{"expand", "two.json", "two.json"}, "takes one description, not 2"},
           {{"schema", "two.json"}, "'grit schema' takes no arguments"},
           {{"plugins", "box", "plane"}, "'grit plugins' takes one name, not 2"},
           {{"run", "two.json", "--frobnicate"}, "unrecognised option '--frobnicate'; see 'grit run --help'"},
           {{"run", "two.json", "--treads", "2"},
            "unrecognised option '--treads'; did you mean \"--threads\"? See 'grit run --help'"},
           {{"run", "two.json", "--thr", "2"}, "unrecognised option '--thr'"},
           {{"run", "two.json", "--out"}, "the required argument for option '--out' is missing"},
           {{"run", "two.json", "--out", ""}, "--out takes a value, not \"\"; see 'grit run --help'"},
           {{"report", "results/two", "--out="},
            "the argument for option '--out' should follow immediately after the equal sign; see 'grit report --help'"},
           {{"study", "study.json", "--out", ""}, "--out takes a value, not \"\"; see 'grit study --help'"},
           {{"run", ""}, "found an empty name, \"\"; give a file or folder; see 'grit run --help'"},
           {{"run", "two.json", "--threads", "0"}, "--threads takes a number from 1 to 1024, not \"0\""},
           {{"run", "two.json", "--threads=-1"}, "--threads takes a number from 1 to 1024, not \"-1\""},
           {{"run", "two.json", "--threads", "many"}, "--threads takes a number from 1 to 1024, not \"many\""},
           {{"check", "two.json", "--threads", "0"}, "--threads takes a number from 1 to 1024, not \"0\""},
           {{"plugins", "--plugin-path", "/nope"},
            "--plugin-path takes a folder of plugins, not \"/nope\", which does not exist"},
           {{"check", "two.json", "--plugin-path", "two.json"},
            "--plugin-path takes a folder of plugins, not \"two.json\", which is a file"},
           {{"run", "two.json", "./two.json"},
            "two.json and ./two.json would both write to results/two; run them one by one, each with its own --out"},
       }) {
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 1) << said;
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err, AllOf(StartsWith("grit: "), HasSubstr(said)));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
}

TEST(Usage, PathsThatTheSystemRefusesAreReportedInWords) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  folder.write("study.json", R"({"scene": "two.json", "metrics": {"energy": {"type": "last",
    "of": "packing/kinetic_energy"}}, "settings": {"safety": {"pointers": ["/time_step/safety"], "values": [0.8, 0.4]}}, "seeds": {"values": [1]}})");
  const std::string name(300, 'a');
  std::string deep = "d";
  for (int i = 0; i < 500; ++i) deep += "/0123456789";
  for (const auto& words : std::vector<std::vector<std::string>>{{"run", "two.json", "--out", name},
                                                                 {"run", "two.json", "--out", deep},
                                                                 {"run", "two.json", "--out", deep, "--overwrite"},
                                                                 {"run", name},
                                                                 {"run", "--resume", name},
                                                                 {"study", "study.json", "--out", name},
                                                                 {"study", "study.json", "--out", "two.json"},
                                                                 {"study", "study.json", "--out", "two.json/study"},
                                                                 {"study", "study.json", "--out", name, "--collect"}}) {
    const auto outcome = grit_in(folder.path(), words);
    EXPECT_EQ(outcome.status, 5) << outcome.err;
    EXPECT_THAT(outcome.err, Not(HasSubstr("filesystem error"))) << words.front();
    EXPECT_THAT(outcome.err, Not(HasSubstr("did not write"))) << words.front();
  }
}

TEST(Usage, AWorkingFolderThatIsGoneIsNamed) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const std::string scene = (folder / "two.json").string();
  const auto outcome =
      shell(folder.path(), "mkdir gone; cd gone; rmdir ../gone; \"" GRIT_BINARY "\" run --quiet " + scene);
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("No such file or directory"),
                                 HasSubstr("the working folder was removed: change to one that exists"),
                                 Not(HasSubstr("filesystem error"))));
}

TEST(Usage, AUnitDatabaseThatDoesNotReadIsNamed) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  folder.write("damaged.xml", "<unit-system");
  const auto error_with = [&](const std::string& database) {
    const auto outcome =
        Program({"env", "UDUNITS2_XML_PATH=" + database, GRIT_BINARY, "check", "two.json"}, folder.path()).finish();
    EXPECT_EQ(outcome.status, 5) << outcome.err;
    return outcome.err;
  };
  EXPECT_EQ(error_with("missing.xml"),
            "grit: missing.xml: the unit database of UDUNITS-2 does not open; install libudunits2-data, or set "
            "UDUNITS2_XML_PATH to its path\n");
  EXPECT_EQ(error_with("damaged.xml"),
            "grit: damaged.xml: the unit database of UDUNITS-2 does not read: it is damaged, or there is no memory "
            "left\n");
}

TEST(Usage, MoreThreadsThanThoseOfTheMachineAreReported) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  const unsigned present = std::thread::hardware_concurrency();
  if (present == 0 || present >= 1024) GTEST_SKIP();
  const std::string has = std::to_string(present), more = std::to_string(present + 1);
  for (const char* command : {"check", "run"}) {
    const auto outcome = grit_in(folder.path(), {command, "two.json", "--threads", more});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, StartsWith("grit: warning: --threads " + more + ": this machine runs " + has +
                                        " at once, and more of them are slower; give " + has + " or fewer\n"));
  }
  EXPECT_THAT(grit_in(folder.path(), {"check", "two.json", "--threads", has}).err, IsEmpty());
}

TEST(Output, AFullDiskBehindARedirectionIsNoticed) {
  const OwnFolder folder;
  folder.write("two.json", two_grains);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"schema"}, {"expand", "two.json"}, {"check", "two.json"}, {"plugins"}, {"describe", "walls"}}) {
    const auto outcome = grit_in(folder.path(), words, "/dev/full");
    EXPECT_EQ(outcome.status, 5) << words[0];
    EXPECT_THAT(outcome.err, HasSubstr("standard output cannot be written"));
  }
}

}  // namespace
}  // namespace grit
