// Which program the installed command becomes, and what it says where it becomes none.
#include <gmock/gmock.h>

#include <algorithm>

#include "support/program.hpp"

namespace grit {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A prefix in which programs that print their instruction set and their arguments are installed.
class Prefix {
 public:
  explicit Prefix(const std::vector<std::string>& levels) {
    fs::create_directories(folder_ / "bin");
    fs::copy_file(GRIT_BINARY, folder_ / "bin/grit");
    for (const auto& level : levels)
      fs::permissions(folder_.write(program(level), "#!/bin/sh\necho " + level + "\nprintf '[%s]' \"$@\"\n"),
                      fs::perms::owner_all);
  }
  static std::string program(const std::string& level) { return LIBRARIES "/grit/" + level + "/grit"; }
  const fs::path& path() const { return folder_.path(); }
  /// GRIT_ISA is unset where `isa` is "-".
  Outcome run(const std::string& isa, const std::vector<std::string>& words = {},
              const std::string& command = "bin/grit") const {
    std::vector<std::string> all{"env", "-u", "GRIT_ISA"};
    if (isa != "-") all.push_back("GRIT_ISA=" + isa);
    all.push_back(folder_ / command);
    all.insert(all.end(), words.begin(), words.end());
    return Program(all, path()).finish();
  }

 private:
  OwnFolder folder_;
};

/// What the dynamic linker, not the launcher, says of this processor.
bool processor_has(const std::string& level) {
  const OwnFolder folder;
  return shell(folder.path(), "/lib64/ld-linux-x86-64.so.2 --help").out.find(level + " (supported") !=
         std::string::npos;
}

const std::vector<std::string> all_levels{"x86-64-v2", "x86-64-v3", "x86-64-v4"};

TEST(Launcher, RunsTheBestThatTheProcessorHas) {
  const Prefix prefix(all_levels);
  std::string best;
  for (const auto& level : all_levels)
    if (processor_has(level)) best = level;
  ASSERT_NE(best, "") << "a processor from before 2009";
  for (const auto* unset : {"-", ""}) EXPECT_THAT(prefix.run(unset).out, StartsWith(best + '\n'));
}

TEST(Launcher, RunsTheOneThatIsNamed) {
  const Prefix prefix(all_levels);
  for (const auto& level : all_levels) {
    if (processor_has(level)) EXPECT_THAT(prefix.run(level).out, StartsWith(level + '\n'));
  }
}

TEST(Launcher, TakesWhatIsThere) {
  EXPECT_THAT(Prefix({"x86-64", "x86-64-v2"}).run("-").out, StartsWith("x86-64-v2\n"));
  EXPECT_THAT(Prefix({"x86-64"}).run("-").out, StartsWith("x86-64\n"));
}

TEST(Launcher, PrefersABuildForThisMachine) {
  const Prefix prefix({"native", "x86-64", "x86-64-v2"});
  EXPECT_THAT(prefix.run("-").out, StartsWith("native\n"));
  EXPECT_THAT(prefix.run("native").out, StartsWith("native\n"));
  EXPECT_THAT(prefix.run("x86-64").out, StartsWith("x86-64\n"));
}

TEST(Launcher, HandsOnTheArgumentsAndTheStatus) {
  const Prefix prefix({"x86-64"});
  EXPECT_EQ(prefix.run("-", {"run", "a b", "", "*"}).out, "x86-64\n[run][a b][][*]");
  std::ofstream(prefix.path() / Prefix::program("x86-64")) << "#!/bin/sh\nexit 7\n";
  EXPECT_EQ(prefix.run("-").status, 7);
}

TEST(Launcher, IsFoundThroughALink) {
  const Prefix prefix({"x86-64"});
  fs::create_symlink("bin/grit", prefix.path() / "link");
  EXPECT_EQ(prefix.run("-", {"x"}, "link").out, "x86-64\n[x]");
}

TEST(Launcher, RefusesWhatIsNotInstalled) {
  const Prefix prefix({"x86-64", "x86-64-v2"});
  for (const std::string isa : {"x86-64-v3", "avx2", "x86-64-v", "../grit/x86-64"}) {
    const auto outcome = prefix.run(isa);
    EXPECT_EQ(outcome.status, 2) << isa;
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err,
                StartsWith("grit: GRIT_ISA=" + isa + ": this instruction set is not installed in " +
                           (prefix.path() / LIBRARIES "/grit\n").string() +
                           "  installed: x86-64-v2, x86-64; supported by this processor: x86-64-v2, "
                           "x86-64\n"
                           "  set GRIT_ISA to a supported one, unset it to use the best, or install another "
                           "with scripts/package.sh\n"));
  }
}

TEST(Launcher, RefusesWhatTheProcessorLacks) {
  if (processor_has("x86-64-v4")) GTEST_SKIP() << "this processor has all levels";
  const auto outcome = Prefix(all_levels).run("x86-64-v4");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err,
              AllOf(StartsWith("grit: GRIT_ISA=x86-64-v4: this processor does not support this instruction set\n"
                               "  installed: x86-64-v4, x86-64-v3, x86-64-v2; supported by this "
                               "processor: "),
                    HasSubstr("set GRIT_ISA to a supported one")));
  const auto none = Prefix({"x86-64-v4"}).run("-");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, AllOf(StartsWith("grit: this processor supports none of the instruction sets installed in "),
                              HasSubstr("installed: x86-64-v4; supported by this processor: none\n")));
}

TEST(Launcher, SaysThatNothingIsInstalled) {
  const auto outcome = Prefix({}).run("-");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("installed: none; supported by this processor: none\n"));
}

TEST(Launcher, SaysWhatCannotBeRun) {
  const Prefix prefix({"x86-64"});
  const auto program = prefix.path() / Prefix::program("x86-64");
  std::ofstream(program) << "no program";
  fs::permissions(program, fs::perms::owner_read);
  const auto outcome = prefix.run("-");
  EXPECT_EQ(outcome.status, 5);
  EXPECT_EQ(outcome.err, "grit: " + program.string() + ": cannot be executed: Permission denied\n");
}

}  // namespace
}  // namespace grit
