#include "study/submission.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "grit/error.hpp"
#include "study/run_command.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Submission two_runs(const std::string& folder = "/home/me/results/box/cluster") {
  return {.name = "box",
          .directory = "/home/me",
          .folder = folder,
          .command = {"/opt/grit/bin/grit", "study", "my box.json", "--only"},
          .runs = {"runs/usual/seed-1", "runs/a=it_s/seed-2"},
          .threads = 4};
}

TEST(RunCommand, IsThatOfOneRun) {
  const RunProgram with{"/bin/grit", 2, {"/plug ins"}};
  EXPECT_THAT(run_words(with, "box.json", "out/runs/usual/seed-1", {"/seed=1", "/a=\"b\""}, true),
              ElementsAre("/bin/grit", "run", "box.json", "--out", "out/runs/usual/seed-1", "--resume", "--quiet",
                          "--no-report", "--threads", "2", "--plugin-path", "/plug ins", "--set", "/seed=1", "--set",
                          "/a=\"b\""));
  EXPECT_THAT(run_words(with, "box.json", "out", {}, false), testing::Contains("--overwrite"));
  EXPECT_TRUE(is_of_study(run_words(with, "box.json", "out", {}, false)));
  EXPECT_TRUE(is_of_study(run_words({"/bin/grit"}, "box.json", "out", {"/seed=1"}, true)));
  EXPECT_FALSE(is_of_study({"/bin/grit", "run", "box.json", "--out", "out", "--overwrite", "--threads", "2"}));
  EXPECT_THAT(task_words(with, "study.json", "out", true), testing::Contains("--overwrite"));
  EXPECT_THAT(task_words(with, "study.json", "out", false),
              ElementsAre("/bin/grit", "study", "study.json", "--out", "out", "--threads", "2", "--plugin-path",
                          "/plug ins", "--only"));
}

TEST(SlurmScript, IsAJobArray) {
  const std::string script = slurm_script(two_runs(), {.limits = {5400, 700e6}, .at_once = 3, .sbatch = {}});
  EXPECT_THAT(script, testing::StartsWith("#!/bin/bash\n# Written by 'grit study' for Slurm"));
  for (const char* line : {"#SBATCH --job-name=box\n", "#SBATCH --array=0-1%3\n", "#SBATCH --open-mode=append\n",
                           "#SBATCH --requeue\n", "#SBATCH --output=\"/home/me/results/box/cluster/%A_%a.txt\"\n",
                           "#SBATCH --signal=B:USR1@120\n", "#SBATCH --cpus-per-task=4\n", "#SBATCH --time=01:30:00\n",
                           "#SBATCH --mem=700M\n", "  runs/usual/seed-1\n", "cd /home/me || exit 5\n",
                           "/opt/grit/bin/grit study \"my box.json\" --only \"${runs[SLURM_ARRAY_TASK_ID]}\" &\n"})
    EXPECT_THAT(script, HasSubstr(line));
  EXPECT_THAT(slurm_script(two_runs(), {}), HasSubstr("--array=0-1\n")) << "as many at once as Slurm starts";
}

TEST(SlurmScript, HasTheOptionsOfTheUserInPlaceOfItsOwn) {
  const auto script_with = [](const std::vector<std::string>& options) {
    return slurm_script(two_runs(), {.limits = {600, 700e6}, .sbatch = options});
  };
  EXPECT_THAT(script_with({"--partition=long --account=soil", "-C zen4"}),
              AllOf(HasSubstr("#SBATCH --partition=long --account=soil\n#SBATCH -C zen4\n"),
                    HasSubstr("--time=00:10:00\n"), HasSubstr("--mem=700M\n")));
  // Slurm refuses a script that has two of --mem, --mem-per-cpu and --mem-per-gpu.
  EXPECT_THAT(script_with({"--mem-per-cpu=2G"}), Not(HasSubstr("--mem=")));
  EXPECT_THAT(script_with({"--account=soil --time=5"}), Not(HasSubstr("--time=00")));
  EXPECT_THAT(script_with({"-t 5"}), Not(HasSubstr("--time=00")));
  EXPECT_THAT(script_with({"--time-min=5"}), HasSubstr("--time=00:10:00")) << "another option";
}

TEST(SlurmScript, QuotesPaths) {
  Submission of = two_runs("/home/it's \"me\" 5%/cluster");
  of.directory = "/home/it's $HOME";
  of.name = "it's a box";
  const std::string script = slurm_script(of, {});
  EXPECT_THAT(script, AllOf(HasSubstr("--output=\"/home/it's \\\"me\\\" 5%%/cluster/%A_%a.txt\"\n"),
                            HasSubstr("cd '/home/it'\\''s $HOME' || exit 5\n"), HasSubstr("--job-name=it_s_a_box\n")));
  of.folder = "/home/back\\slash";
  EXPECT_THROW(slurm_script(of, {}), Error) << "it ends patterns in Slurm";
  of.folder = "/home/two\nlines";
  EXPECT_THROW(slurm_script(of, {}), Error);
  EXPECT_THROW(parallel_script(of, {}), Error);
}

TEST(SlurmScript, IsABashScript) {
  const OwnFolder folder;
  folder.write("slurm.sh", slurm_script(two_runs(), {}));
  folder.write("parallel.sh", parallel_script(two_runs(), {}));
  for (const char* name : {"slurm.sh", "parallel.sh"}) {
    const auto outcome = shell(folder.path(), std::string("bash -n ") + name);
    EXPECT_EQ(outcome.status, 0) << name << outcome.err;
    EXPECT_TRUE(is_own_script(folder / name)) << name;
  }
  EXPECT_FALSE(is_own_script(folder.write("other.sh", "#!/bin/bash\necho mine\n")));
  EXPECT_FALSE(is_own_script(folder / "none.sh"));
}

/// Scripts whose run is a program of the test.
class Tasks : public testing::Test {
 protected:
  Outcome task(const std::string& program, const std::string& before = "") {
    Submission of = two_runs((folder / "cluster").string());
    of.directory = folder.path();
    of.command = {folder.write("program.sh", "#!/bin/bash\n" + program)};
    std::filesystem::permissions(of.command.front(), std::filesystem::perms::owner_all);
    folder.write("bin/scontrol", "#!/bin/sh\necho scontrol \"$@\" >> requeued.txt\nexit 1\n");
    std::filesystem::permissions(folder / "bin/scontrol", std::filesystem::perms::owner_all);
    folder.write("slurm.sh", slurm_script(of, {}));
    return shell(folder.path(),
                 "export PATH=\"$PWD/bin:$PATH\" SLURM_ARRAY_TASK_ID=1 SLURM_JOB_ID=17; " + before + "bash slurm.sh");
  }
  OwnFolder folder;
};

TEST_F(Tasks, DoTheRunOfTheirNumberAndEndAsItDoes) {
  const auto outcome = task("echo \"$@\"; exit 4");
  EXPECT_EQ(outcome.status, 4);
  EXPECT_EQ(outcome.out, "runs/a=it_s/seed-2\n");
}

// The run waits for a signal that the script gets from another process, as from Slurm.
constexpr auto saves = "trap 'echo saved; exit 130' HUP\nkill -SIGNAL $PPID\nwhile true; do sleep 0.01; done\n";

std::string saves_on(const std::string& signal) {
  std::string text = saves;
  return text.replace(text.find("SIGNAL"), 6, signal);
}

TEST_F(Tasks, GoBackIntoTheQueueWhenTimeIsUp) {
  const auto outcome = task(saves_on("USR1"));
  EXPECT_EQ(outcome.status, 130);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("saved\n"), HasSubstr("out of time")));
  EXPECT_EQ(text_of(folder / "requeued.txt"), "scontrol requeue 17\n");
}

TEST_F(Tasks, SaveWhenTheyAreCancelledAndDoNotGoBack) {
  const auto outcome = task(saves_on("TERM"));
  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(outcome.out, "saved\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "requeued.txt"));
}

TEST(ParallelScript, HasOneLinePerRun) {
  const std::string script = parallel_script(two_runs(), {.at_once = 2, .hosts = ""});
  EXPECT_THAT(
      script,
      AllOf(HasSubstr("exec parallel --jobs 2 --joblog /home/me/results/box/cluster/joblog.txt --resume-failed"),
            HasSubstr("\n/opt/grit/bin/grit study \"my box.json\" --only runs/usual/seed-1\n"),
            HasSubstr("--only runs/a=it_s/seed-2\nend_of_runs\n"), Not(HasSubstr("ssh"))));
  EXPECT_THAT(parallel_script(two_runs(), {}), HasSubstr("--jobs 25% ")) << "four threads each";
}

TEST(ParallelScript, NamesHosts) {
  const OwnFolder folder;
  const auto file = folder.write("my hosts", "node1\n");
  EXPECT_THAT(parallel_script(two_runs(), {.hosts = file.string()}),
              AllOf(HasSubstr("--sshloginfile \"" + file.string() + '"'), HasSubstr("--workdir /home/me ")));
  EXPECT_THAT(parallel_script(two_runs(), {.hosts = "node1,8/node2"}), HasSubstr("--sshlogin node1,8/node2 "));
}

TEST(Limits, HaveMargins) {
  EXPECT_EQ(time_limit(1), 600) << "10 minutes";
  EXPECT_EQ(time_limit(1000), 3000);
  EXPECT_EQ(time_limit(1001), 3060) << "whole minutes";
  EXPECT_EQ(time_limit(1e9), 86400) << "a day";
  EXPECT_EQ(time_limit(std::nan("")), 86400);
  EXPECT_EQ(memory_limit(0), 300e6);
  EXPECT_EQ(memory_limit(1e9), 2300e6);
}

TEST(Jobs, AreNamedByTheirNumber) {
  EXPECT_EQ(job_in("123\n"), "123");
  EXPECT_EQ(job_in("123;east\n"), "123");
  EXPECT_EQ(job_in("sbatch: warning: 5 of 6\n123\n"), "123");
  EXPECT_EQ(job_in("sbatch: error: no\n"), "");
  EXPECT_EQ(job_in(""), "");
}

}  // namespace
}  // namespace grit
