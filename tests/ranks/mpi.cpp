// `mpirun grit run`, as users start it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "support/program.hpp"

namespace grit::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Mpi : public testing::Test {
 protected:
  Mpi() {
    // Open MPI refuses to run as root otherwise, as in a container.
    for (const char* variable : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"})
      ::setenv(variable, "1", 1);
  }
  /// `command` for a shell, on so many ranks.
  Outcome on(unsigned ranks, const std::string& command) const {
    return Program({GRIT_MPIRUN, "--oversubscribe", "-n", std::to_string(ranks), "/bin/sh", "-c", command},
                   folder_.path())
        .finish();
  }
  std::string run(const std::string& more = "") const {
    return std::string("exec " GRIT_BINARY " run " GRIT_SOURCE_DIR "/bench/scenes/tiny.json --no-report ") +
           (more.find("--out") == std::string::npos ? "--out out " : "") +
           "--set /stages/0/until/value=20 --set /stages/1/until/value=20 " + more;
  }

  OwnFolder folder_;
};

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(Mpi, OnlyTheFirstRankReports) {
  const Outcome two = on(2, run());
  EXPECT_EQ(two.status, 0) << two.err;
  EXPECT_THAT(two.err, HasSubstr("2 ranks of "));
  EXPECT_EQ(count_of(two.out, "results: out"), 1u);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/final.h5"));
}

#ifdef GRIT_FAULTS_SHIM
TEST_F(Mpi, ClocksTimeZonesAndLocalesMayDiffer) {
  const Outcome alone = Program({"/bin/sh", "-c", run("--out alone")}, folder_.path()).finish();
  ASSERT_EQ(alone.status, 0) << alone.err;
  const Outcome two = on(2, "[ $OMPI_COMM_WORLD_RANK = 0 ] || export LD_PRELOAD=" GRIT_FAULTS_SHIM
                            " FAULTS_CLOCK=7:10 TZ=Asia/Tokyo LC_ALL=de_DE.UTF-8; " +
                                run());
  ASSERT_EQ(two.status, 0) << two.err;
  const Outcome compared =
      Program({"/usr/bin/python3", GRIT_SOURCE_DIR "/scripts/same_results.py", "alone", "out"}, folder_.path())
          .finish();
  EXPECT_EQ(compared.status, 0) << compared.out << compared.err;
}
#endif

TEST_F(Mpi, ADescriptionThatDiffersIsRefused) {
  const Outcome two = on(2, run("--set /seed=$((5 + OMPI_COMM_WORLD_RANK))"));
  EXPECT_EQ(two.status, 2);
  EXPECT_THAT(two.err, HasSubstr("grit: rank 1 on "));
  EXPECT_THAT(two.err, HasSubstr(": differs from rank 0; use the same grit, plugins and files on all hosts\n"
                                 "  description: found \"seed\": 6; rank 0 has \"seed\": 5\n"));
  EXPECT_THAT(two.err, HasSubstr("grit: 2 ranks cannot run this together, see above"));
}

TEST_F(Mpi, AFileThatDiffersIsRefused) {
  const Outcome two =
      on(2,
         "mkdir $OMPI_COMM_WORLD_RANK; cd $OMPI_COMM_WORLD_RANK; echo 0.004 0.005 0.005 0.000$((5 + "
         "OMPI_COMM_WORLD_RANK)) > grain.txt; " +
             run("--set /bodies/sand/source='{\"type\": \"file\", \"path\": \"/proc/self/cwd/grain.txt\"}'"));
  EXPECT_EQ(two.status, 2);
  EXPECT_THAT(two.err, HasSubstr("  files: found /proc/self/cwd/grain.txt, checksum "));
}

TEST_F(Mpi, WhatOneRankLacksIsReportedWithItsNumber) {
  const Outcome two = on(2, "[ $OMPI_COMM_WORLD_RANK = 0 ] || set -- --set /contacts/type=none; " + run("\"$@\""));
  EXPECT_EQ(two.status, 2);
  EXPECT_THAT(two.err, HasSubstr("grit: rank 1 on "));
  EXPECT_THAT(two.err, HasSubstr("\"none\""));
}

TEST_F(Mpi, AFaultOfAllIsReportedOnce) {
  const Outcome two = on(2, run("--set /seed=none"));
  EXPECT_EQ(two.status, 2);
  EXPECT_EQ(count_of(two.err, "1 problem in the description"), 1u) << two.err;
}

TEST_F(Mpi, AFolderOfResultsStopsAllRanks) {
  EXPECT_EQ(on(2, run()).status, 0);
  const Outcome again = on(2, run());
  EXPECT_EQ(again.status, 5);
  EXPECT_EQ(count_of(again.err, "out holds the results of a run"), 1u) << again.err;
  EXPECT_THAT(again.err, Not(HasSubstr("MPI_ABORT")));
}

TEST_F(Mpi, ProcessesThatItDoesNotConnectAreRefused) {
  const auto expect_refused = [&](const std::string& variables, const std::string& why) {
    const Outcome alone = Program({"/bin/sh", "-c", "export " + variables + "; " + run()}, folder_.path()).finish();
    EXPECT_EQ(alone.status, 2);
    EXPECT_THAT(alone.err, HasSubstr(why));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out"));
  };
  expect_refused("PMI_SIZE=2 PMI_RANK=0",
                 "started as one of 2 processes, of which MPI connects none; use mpirun of the same");
  expect_refused("SLURM_STEP_NUM_TASKS=2",
                 "started as one of 2 processes by Slurm, which does not connect them; use srun --mpi=pmix, or mpirun");
}

TEST_F(Mpi, TakesOneDescription) {
  const Outcome two = on(2, run(GRIT_SOURCE_DIR "/bench/scenes/tiny.json"));
  EXPECT_EQ(two.status, 1);
  EXPECT_THAT(two.err, HasSubstr("found 2 descriptions for 2 ranks, which run one; start them one by one"));
}

}  // namespace
}  // namespace grit::test
