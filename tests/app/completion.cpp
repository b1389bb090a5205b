// Completion by the tab key: what shells offer, with the scripts that are installed.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;

std::vector<std::string> sorted_lines(const std::string& text) {
  std::vector<std::string> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  std::ranges::sort(all);
  return all;
}

/// A folder with descriptions, other files and results in `results/box`, where a line is completed.
class Completion : public testing::Test {
 protected:
  Completion() {
    for (const char* file : {"box.json", "my box.json", "page.html", "notes.txt", "results/box/run.json"}) {
      std::filesystem::create_directories((folder_ / file).parent_path());
      folder_.write(file, "");
    }
    std::filesystem::create_directories(folder_ / "other");
  }

  /// What bash offers after words that readline has split.
  std::vector<std::string> bash(const std::string& words) const {
    folder_.write("terminal.bash", "source '" GRIT_SOURCE_DIR
                                   "/core/src/app/completion/grit.bash'\n"
                                   "compopt() { [[ $* == '-o filenames' ]]; }\n"  // works within readline only
                                   "COMP_WORDS=(grit " +
                                       words +
                                       ")\n"
                                       "COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                                       "_grit '" GRIT_BINARY
                                       "'\n"
                                       "[[ ${#COMPREPLY[@]} == 0 ]] || printf '%s\\n' \"${COMPREPLY[@]}\"\n");
    const auto outcome =
        Program({"env", "-u", "GRIT_ISA", "-u", "GRIT_PLUGIN_PATH", "bash", "terminal.bash"}, folder_.path()).finish();
    EXPECT_THAT(outcome.err, IsEmpty());
    return sorted_lines(outcome.out);
  }

  /// What an interactive zsh offers after a line.
  std::vector<std::string> zsh(const std::string& line) const {
    folder_.write("terminal.zsh", R"(
zmodload zsh/zpty
zpty z zsh -f -i
zpty -w z "PROMPT=; fpath=($1 \$fpath); path=($2 \$path); autoload -Uz compinit; compinit -u -D; bindkey '^I' complete-word"
zpty -w z 'compadd() { local -a hits; case " $* " in *" -O "*|*" -A "*|*" -D "*) ;; *) builtin compadd -A hits "$@"; print -rl -- "<hit>"$^hits ;; esac; builtin compadd "$@" }'
zpty -w z 'finish() { print -r -- DO""NE }; zle -N finish; bindkey "^G" finish'
zpty -w z 'zle-line-init() { print -r -- REA""DY }; zle -N zle-line-init'
zpty -r z seen '*READY*'
zpty -w -n z "$3"$'\t\C-G'
zpty -r z seen '*DONE*'
print -r -- $seen | tr -d '\r' | grep -ao '<hit>.*' | sed 's/<hit>//' | sort -u
)");
    const std::filesystem::path program = GRIT_BINARY;
    const auto outcome =
        Program({"env", "-u", "GRIT_ISA", "-u", "GRIT_PLUGIN_PATH", "TERM=dumb", "zsh", "-f", "terminal.zsh",
                 GRIT_SOURCE_DIR "/core/src/app/completion", program.parent_path(), line},
                folder_.path())
            .finish();
    EXPECT_THAT(outcome.err, IsEmpty());
    return sorted_lines(outcome.out);
  }

  const OwnFolder folder_;
};

TEST_F(Completion, OffersCommands) {
  EXPECT_THAT(bash("''"), IsSupersetOf({"run", "check", "study", "manual", "help"}));
  EXPECT_THAT(bash("''"), Not(Contains("--version")));
  EXPECT_THAT(bash("re"), ElementsAre("report"));
  EXPECT_THAT(bash("help c"), ElementsAre("calibrate", "check"));
  EXPECT_THAT(bash("manual sc"), ElementsAre("schema"));
  EXPECT_THAT(bash("--"), ElementsAre("--help", "--version"));
  EXPECT_THAT(bash("frobnicate --"), IsEmpty());
}

TEST_F(Completion, OffersTheOptionsOfTheHelp) {
  const auto help = grit_in(folder_.path(), {"run", "--help"}).out;
  const auto offered = bash("run --");
  EXPECT_THAT(offered, IsSupersetOf({"--out", "--resume", "--set", "--threads", "--plugin-path", "--help"}));
  for (const auto& option : offered) EXPECT_THAT(help, HasSubstr(option));
  EXPECT_THAT(bash("run --o"), ElementsAre("--out", "--overwrite"));
}

TEST_F(Completion, OffersAnOptionAgainIfItMayBeRepeated) {
  const auto offered = bash("run --quiet --set /seed = 2 --out other --");
  EXPECT_THAT(offered,
              AllOf(Contains("--set"), Contains("--overwrite"), Not(Contains("--out")), Not(Contains("--quiet"))));
}

TEST_F(Completion, OffersDescriptionsAndFolders) {
  EXPECT_THAT(bash("run ''"), ElementsAre("box.json", "my box.json", "other", "results"));
  EXPECT_THAT(bash("run --quiet box.json b"), ElementsAre("box.json"));  // of several
  EXPECT_THAT(bash("run 'my\\ '"), ElementsAre("my box.json"));
  EXPECT_THAT(bash("expand box.json ''"), IsEmpty());  // takes one
  EXPECT_THAT(bash("schema ''"), IsEmpty());
}

TEST_F(Completion, OffersWhatAnOptionTakes) {
  EXPECT_THAT(bash("run --out ''"), ElementsAre("other", "results"));
  EXPECT_THAT(bash("run --out ="), ElementsAre("other", "results"));
  EXPECT_THAT(bash("run --out = o"), ElementsAre("other"));
  EXPECT_THAT(bash("run --threads ''"), IsEmpty());
  EXPECT_THAT(bash("study --submit ''"), ElementsAre("parallel", "slurm"));
  EXPECT_THAT(bash("study --submit = s"), ElementsAre("slurm"));
  EXPECT_THAT(bash("report --out p"), ElementsAre("page.html"));
  EXPECT_THAT(bash("study --hosts n"), ElementsAre("notes.txt"));
}

TEST_F(Completion, OffersFoldersThatHoldRuns) {
  EXPECT_THAT(bash("report ''"), ElementsAre("results"));
  EXPECT_THAT(bash("report results/"), ElementsAre("results/box"));
  EXPECT_THAT(bash("report o"), IsEmpty());
}

TEST_F(Completion, OffersComponentsAndSections) {
  EXPECT_THAT(bash("plugins linear"), ElementsAre("linear-cohesive", "linear-frictional", "linear-rolling"));
  EXPECT_THAT(bash("plugins ''"), AllOf(IsSupersetOf({"gravity", "box", "triaxial"}), Not(Contains("stages"))));
  EXPECT_THAT(bash("describe ''"), IsSupersetOf({"gravity", "box", "triaxial", "stages", "study", "calibration"}));
  folder_.write("more/contacts/own-law.so", "");  // listed, not loaded
  EXPECT_THAT(bash("plugins own"), IsEmpty());
  EXPECT_THAT(bash("plugins --plugin-path more own"), ElementsAre("own-law"));
  EXPECT_THAT(bash("plugins --plugin-path nowhere box"), ElementsAre("box"));
}

TEST_F(Completion, WorksInZsh) {
  if (shell(folder_.path(), "command -v zsh").status != 0) GTEST_SKIP() << "zsh is not installed";
  EXPECT_THAT(zsh("grit r"), ElementsAre("report", "run"));
  EXPECT_THAT(zsh("grit run "), ElementsAre("box.json", "my\\ box.json", "other", "results"));
  EXPECT_THAT(zsh("grit run --o"), ElementsAre("--out", "--overwrite"));
  EXPECT_THAT(zsh("grit run --out=o"), ElementsAre("other"));
  EXPECT_THAT(zsh("grit study --submit "), ElementsAre("parallel", "slurm"));
  EXPECT_THAT(zsh("grit report "), ElementsAre("results"));
  EXPECT_THAT(zsh("grit plugins linear"), ElementsAre("linear-cohesive", "linear-frictional", "linear-rolling"));
}

}  // namespace
}  // namespace grit
