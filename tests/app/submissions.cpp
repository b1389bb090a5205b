// Studies whose runs are done by schedulers, here by programs of the tests.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "scenes.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Submissions : public testing::Test {
 protected:
  Submissions() {
    auto scene = json::parse(two_grains);
    scene["output"].erase("frames");
    scene["time_step"]["steps_per_impact"] = 0;
    folder.write("two.json", scene.dump());
    folder.write("sweep.json", R"({"title": "two grains", "scene": "two.json", "purpose": "sweep",
      "settings": {"safety": {"pointers": ["/time_step/safety"], "values": [0.8, 0.4]}},
      "seeds": {"values": [1]},
      "metrics": {"energy": {"type": "last", "of": "packing/kinetic_energy"}}})");
  }
  /// A program in PATH.
  void install(const std::string& name, const std::string& script) {
    const auto path = folder.write("bin/" + name, "#!/bin/bash\n" + script);
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  Outcome study(std::vector<std::string> more, const std::string& file = "sweep.json") {
    std::vector<std::string> words{"env", "PATH=" + (folder / "bin").string() + ":/usr/bin:/bin", GRIT_BINARY, "study",
                                   file};
    words.insert(words.end(), more.begin(), more.end());
    return Program(words, folder.path()).finish();
  }
  /// Only what the test installs.
  Outcome study_alone(std::vector<std::string> more) {
    std::vector<std::string> words{"/usr/bin/env", "PATH=" + (folder / "bin").string(), GRIT_BINARY, "study",
                                   "sweep.json"};
    words.insert(words.end(), more.begin(), more.end());
    return Program(words, folder.path()).finish();
  }
  json result() const { return json::parse(text_of(folder / "results/sweep/study.json")); }
  const std::string cluster = "results/sweep/cluster/";
  OwnFolder folder;
};

TEST_F(Submissions, GoToSlurmAsOneJobArray) {
  install("sbatch", "echo \"$@\" > sbatch.txt; echo '42;east'");
  install("squeue", "echo 'slurm_load_jobs error: Invalid job id specified' >&2; exit 1");
  const auto outcome =
      study({"--submit", "slurm", "--jobs", "3", "--threads", "2", "--sbatch", "--partition=short --account=soil"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(text_of(folder / "sbatch.txt"), "--parsable " + (folder / (cluster + "slurm.sh")).string() + "\n");
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("job 42: 2 runs\n"), HasSubstr("watch:   squeue --jobs=42"),
                    HasSubstr("cancel:  scancel 42\n"), HasSubstr("collect: grit study sweep.json --collect\n"),
                    HasSubstr("time limit: 10 min 00 s a run, three times the estimate")));
  EXPECT_THAT(text_of(folder / (cluster + "slurm.sh")),
              AllOf(HasSubstr("--array=0-1%3\n"), HasSubstr("--cpus-per-task=2\n"),
                    HasSubstr("#SBATCH --partition=short --account=soil\n"), HasSubstr("  runs/safety=0.8/seed-1\n"),
                    HasSubstr("study sweep.json --out results/sweep --threads 2 --only")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/sweep/runs")) << "nothing is run here";
}

TEST_F(Submissions, AreRefusedWhileTheirJobIsInTheQueue) {
  install("sbatch", "echo 42");
  ASSERT_EQ(study({"--submit", "slurm"}).status, 0);
  install("squeue", "echo \"$@\" > squeue.txt; echo '42_1 RUNNING'");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--submit", "slurm"}, {}}) {
    const auto again = study(words);
    EXPECT_EQ(again.status, 5);
    EXPECT_THAT(again.err, AllOf(HasSubstr("the job 42 of this study is in the queue of Slurm:\n42_1 RUNNING\n"),
                                 HasSubstr("scancel 42"), HasSubstr("--collect")));
  }
  EXPECT_THAT(text_of(folder / "squeue.txt"), HasSubstr("--jobs=42"));
}

TEST_F(Submissions, OmitWhatIsDone) {
  install("sbatch", "echo 42");
  ASSERT_EQ(study({"--only", "runs/safety=0.8/seed-1"}).status, 0);
  ASSERT_EQ(study({"--submit", "slurm"}).status, 0);
  EXPECT_THAT(text_of(folder / (cluster + "slurm.sh")),
              AllOf(HasSubstr("--array=0-0\n"), Not(HasSubstr("runs/safety=0.8/")), HasSubstr("runs/safety=0.4/")));
  ASSERT_EQ(study({"--only", "runs/safety=0.4/seed-1"}).status, 0);
  const auto outcome = study({"--submit", "slurm"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(Not(HasSubstr("job 42")), HasSubstr("page: results/sweep/study.html")));
}

TEST_F(Submissions, OnlyWriteTheScriptWithADryRun) {
  const auto outcome = study_alone({"--submit", "slurm", "--dry-run"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("safety=0.8, seed 1\n"), HasSubstr("2 of 2 runs are missing"),
                                 HasSubstr("submit:  sbatch " + (folder / (cluster + "slurm.sh")).string())));
  EXPECT_THAT(text_of(folder / (cluster + "slurm.sh")), HasSubstr("--array=0-1\n"));
  const auto parallel = study_alone({"--submit", "parallel", "--dry-run"});
  EXPECT_EQ(parallel.status, 0) << parallel.err;
  EXPECT_THAT(text_of(folder / (cluster + "parallel.sh")), HasSubstr("--only runs/safety=0.8/seed-1\n"));
}

TEST_F(Submissions, SayWhatSlurmRefused) {
  const auto none = study_alone({"--submit", "slurm"});
  EXPECT_EQ(none.status, 5);
  EXPECT_THAT(none.err, AllOf(HasSubstr("--submit slurm: no program \"sbatch\" was found in PATH"),
                              HasSubstr("--dry-run to write its script only")));
  EXPECT_FALSE(std::filesystem::exists(folder / "results"));
  install("sbatch", "echo 'sbatch: error: invalid partition specified: short' >&2; exit 1");
  const auto refused = study({"--submit", "slurm"});
  EXPECT_EQ(refused.status, 5);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("sbatch did not accept "), HasSubstr("invalid partition specified: short"),
                                 HasSubstr("change the options with --sbatch")));
  install("sbatch", "echo nothing");
  EXPECT_EQ(study({"--submit", "slurm"}).status, 5) << "no number of a job";
}

TEST_F(Submissions, CheckTheirOptions) {
  const auto error_of = [&](const std::vector<std::string>& words) {
    const auto outcome = study(words);
    EXPECT_EQ(outcome.status, 1);
    return outcome.err;
  };
  EXPECT_THAT(error_of({"--submit", "slrum"}),
              AllOf(HasSubstr("--submit takes slurm or parallel, not \"slrum\""), HasSubstr("did you mean \"slurm\"")));
  EXPECT_THAT(error_of({"--sbatch=--partition=a"}), HasSubstr("give --submit slurm, too"));
  EXPECT_THAT(error_of({"--submit", "slurm", "--hosts", "a"}), HasSubstr("give --submit parallel, too"));
  EXPECT_THAT(error_of({"--submit", "slurm", "--collect"}), HasSubstr("--collect starts none; give one of them"));
  EXPECT_THAT(error_of({"--submit", "slurm", "--sbatch", "partition=a"}),
              HasSubstr("--sbatch takes options for sbatch in one line"));
  EXPECT_THAT(error_of({"--only", "runs/usual/seed-1", "--dry-run"}), HasSubstr("give it without --dry-run"));
  EXPECT_THAT(error_of({"--only", "runs/safety=0.9/seed-1"}),
              HasSubstr("--only takes the folder of a run of the study, not \"runs/safety=0.9/seed-1\""));
}

TEST_F(Submissions, TouchNoScriptThatTheyDidNotWrite) {
  for (const std::string name : {"slurm", "parallel"}) {
    folder.write(cluster + name + ".sh", "#!/bin/sh\necho mine\n");
    const auto outcome = study({"--submit", name, "--dry-run"});
    EXPECT_EQ(outcome.status, 5);
    EXPECT_THAT(outcome.err, HasSubstr(cluster + name + ".sh: grit did not write this file"));
    EXPECT_THAT(text_of(folder / (cluster + name + ".sh")), HasSubstr("echo mine"));
  }
}

TEST_F(Submissions, DoOneRunAndDoItOnce) {
  const auto first = study({"--only", "runs/safety=0.8/seed-1/"});
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("results: results/sweep/runs/safety=0.8/seed-1"));
  const auto again = study({"--only", "runs/safety=0.8/seed-1"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("runs/safety=0.8/seed-1: already complete"));
  // Of another description it is replaced if that is wanted.
  folder.write("two.json", [&] {
    auto scene = json::parse(text_of(folder / "two.json"));
    scene["title"] = "other";
    return scene.dump();
  }());
  const auto other = study({"--only", "runs/safety=0.8/seed-1"});
  EXPECT_EQ(other.status, 5);
  EXPECT_THAT(other.err, HasSubstr("holds 1 run of another description"));
  EXPECT_THAT(study({"--only", "runs/safety=0.8/seed-1", "--overwrite"}).out, HasSubstr("results: "));
  EXPECT_FALSE(std::filesystem::exists(folder / "results/sweep/study.json")) << "nothing is evaluated";
}

/// GNU parallel, as far as the scripts use it: runs the lines of standard input, and writes the log.
constexpr auto fake_parallel = R"(
if [[ $1 == --version ]]; then echo 'GNU parallel 1'; exit; fi
printf '%s\n' "$@" > parallel-words.txt
while [[ $1 != --joblog ]]; do shift; done
printf 'Seq\tHost\tStarttime\n' > "$2"
failed=0
while read -r line; do
  /bin/sh -c "$line" < /dev/null || failed=$((failed + 1))
  echo "$line" >> "$2"
done
exit "$failed"
)";

TEST_F(Submissions, AreRunByParallelAndEvaluated) {
  install("parallel", fake_parallel);
  const auto outcome = study({"--submit", "parallel", "--jobs", "2", "--hosts", "a,b"});
  EXPECT_EQ(outcome.status, 0) << outcome.err << text_of(folder / (cluster + "parallel.txt"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("safety=0.8: energy "), HasSubstr("page: results/sweep/study.html")));
  EXPECT_THAT(text_of(folder / "parallel-words.txt"), AllOf(HasSubstr("--jobs\n2\n"), HasSubstr("--sshlogin\na,b\n")));
  EXPECT_EQ(result().at("variants")[1].at("samples")[0].at("status"), "done");
}

TEST_F(Submissions, ReportRunsThatDidNotEnd) {
  install("parallel", std::string(fake_parallel)
                          .replace(std::string(fake_parallel).find("  /bin/sh"), 0,
                                   "  [[ $line != *0.4* ]] || { failed=1; continue; }\n"));
  const auto outcome = study({"--submit", "parallel"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, HasSubstr("1 run did not end; see results/sweep/cluster/parallel.txt, and run the same"));
  EXPECT_THAT(outcome.out, HasSubstr("1 of 2 runs are done; 1 missing: safety=0.4, seed 1."));
  install("parallel", fake_parallel);
  const auto again = study({"--submit", "parallel"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("1 of 2 runs to do"));
}

TEST_F(Submissions, ReplaceNoFileOfOthers) {
  install("parallel", fake_parallel);
  install("sbatch", "echo 42");
  const std::string not_own = ": grit did not write this file: it would be lost; move it away";
  for (const auto& [how, name] :
       {std::pair("parallel", "parallel.sh"), std::pair("parallel", "joblog.txt"),
        std::pair("parallel", "parallel.txt"), std::pair("slurm", "slurm.sh"), std::pair("slurm", "slurm-job.txt")})
    for (const std::string text : {"mine\n", "Seq\tHost\tStarttime\n1\t:\t0\tmine\n", "42\nmine\n"}) {
      folder.write(cluster + name, text);
      const auto refused = study({"--submit", how});
      EXPECT_EQ(refused.status, 5) << name;
      EXPECT_THAT(refused.err, HasSubstr(cluster + name + not_own));
      EXPECT_EQ(text_of(folder / (cluster + name)), text);
      std::filesystem::remove(folder / (cluster + name));
    }
  for (const char* name : {"sbatch.txt", "squeue.txt", "slurm.sh.part"}) folder.write(cluster + name, "mine");
  EXPECT_EQ(study({"--submit", "slurm"}).status, 0);
  EXPECT_EQ(study({"--submit", "parallel"}).status, 0);
  for (const char* name : {"sbatch.txt", "squeue.txt", "slurm.sh.part"})
    EXPECT_EQ(text_of(folder / (cluster + name)), "mine") << name;
}

TEST_F(Submissions, RefuseAnotherParallel) {
  install("parallel", "echo 'parallel: invalid option' >&2; exit 1");
  const auto outcome = study({"--submit", "parallel"});
  EXPECT_EQ(outcome.status, 5);
  EXPECT_THAT(outcome.err, HasSubstr("bin/parallel is not GNU parallel, but another program of this name"));
}

TEST_F(Submissions, WorkInFoldersWithOddNames) {
  install("parallel", fake_parallel);
  folder.write("it's 5%/my \"sweep\".json", [&] {
    auto sweep = json::parse(text_of(folder / "sweep.json"));
    sweep["scene"] = (folder / "two.json").string();
    return sweep.dump();
  }());
  const auto outcome = study({"--submit", "parallel", "--out", "it's 5%/$results"}, "it's 5%/my \"sweep\".json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "it's 5%/$results/runs/safety=0.4/seed-1/series.h5"));
  const auto slurm = study({"--submit", "slurm", "--dry-run", "--out", "it's 5%/$other"}, "it's 5%/my \"sweep\".json");
  EXPECT_EQ(slurm.status, 0) << slurm.err;
  EXPECT_THAT(text_of(folder / "it's 5%/$other/cluster/slurm.sh"), HasSubstr("it's 5%%/$other/cluster/%A_%a.txt\""));
}

TEST_F(Submissions, AreCollectedWhileTheyGoOn) {
  ASSERT_EQ(study({"--only", "runs/safety=0.8/seed-1"}).status, 0);
  folder.write("results/sweep/runs/safety=0.4/seed-1/run.json", R"({"status": "running"})");
  const auto outcome = study({"--collect"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("1 of 2 runs are done; 1 under way: safety=0.4, seed 1."));
  EXPECT_THAT(text_of(folder / "results/sweep/study.html"), HasSubstr("1 of 2 runs done"));
  EXPECT_THAT(text_of(folder / "results/sweep/study.csv"), HasSubstr(",1,1\n"));
}

}  // namespace
}  // namespace grit
