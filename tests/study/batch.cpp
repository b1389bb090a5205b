#include "study/batch.hpp"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "grit/error.hpp"
#include "support/program.hpp"

namespace grit {
namespace {

class Batch : public testing::Test {
 protected:
  BatchJob shell_job(const std::string& script) {
    return {{"/bin/sh", "-c", script}, folder / ("log" + std::to_string(++count) + "/log.txt")};
  }
  void run(const std::vector<BatchJob>& jobs, std::size_t at_once) {
    status.assign(jobs.size(), 1000);
    run_batch(jobs, at_once, interrupted,
              {.ended = [&](std::size_t i, int s) { return status[i] = s, go_on; },
               .waiting = [&](std::size_t n) { most = std::max(most, n), on_wait(); }});
  }
  OwnFolder folder;
  std::vector<int> status;
  std::atomic<bool> interrupted{false};
  std::function<void()> on_wait = [] {};
  bool go_on = true;
  std::size_t most = 0;
  int count = 0;
};

TEST_F(Batch, ReportsHowEachEndedAndKeepsItsOutput) {
  run({shell_job("echo out; echo err >&2; exit 3"), shell_job("kill -9 $$"), shell_job("read line || exit 5")}, 2);
  EXPECT_THAT(status, testing::ElementsAre(3, -9, 5)) << "standard input is empty";
  EXPECT_EQ(text_of(folder / "log1/log.txt"), "out\nerr\n");
}

TEST_F(Batch, RunsNoMoreAtOnceThanRequested) {
  // Each waits for the other of its pair, so that they end only if both are running.
  const auto pair = [&](const std::string& own, const std::string& other) {
    return shell_job("cd " + folder.path().string() + "; touch " + own + "; while [ ! -e " + other +
                     " ]; do sleep 0.01; done");
  };
  run({pair("a", "b"), pair("b", "a"), pair("c", "d"), pair("d", "c")}, 2);
  EXPECT_THAT(status, testing::Each(0));
  EXPECT_EQ(most, 2u);
}

TEST_F(Batch, StopsAllWhenInterrupted) {
  on_wait = [&] { interrupted = true; };
  run({shell_job("exec sleep 1000"), shell_job("exec sleep 1000"), shell_job("exit 0")}, 2);
  EXPECT_THAT(status, testing::ElementsAre(-15, -15, 1000)) << "the third never begins";
}

TEST_F(Batch, StopsAllWhenOneGoesWrong) {
  go_on = false;
  run({shell_job("exit 2"), shell_job("exec sleep 1000"), shell_job("exit 0")}, 2);
  EXPECT_THAT(status, testing::ElementsAre(2, -15, 1000));
}

TEST_F(Batch, SaysWhatCannotBeStarted) {
  const auto fault = [&](const BatchJob& job) {
    try {
      run({job}, 1);
    } catch (const FileError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(fault({{"/no/such/program"}, folder / "log.txt"}),
            "/no/such/program cannot be started: No such file or directory");
  std::filesystem::create_directory(folder / "taken");
  EXPECT_THAT(fault({{"true"}, folder / "taken"}), testing::HasSubstr("taken: cannot write it: Is a directory"));
  EXPECT_EQ(fault({{"true"}, folder / "log.txt"}), "none") << "found in PATH";
}

TEST_F(Batch, EndsWithTheProcessThatStartedIt) {
  // Programs without a parent become children of this process.
  ASSERT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0);
  const pid_t batch = ::fork();
  if (batch == 0) {
    run({shell_job("cd " + folder.path().string() + "; echo $$ > pid; exec sleep 1000")}, 1);
    ::_exit(0);
  }
  while (!text_of(folder / "pid").ends_with('\n')) std::this_thread::yield();
  const pid_t program = std::stoi(text_of(folder / "pid"));
  ::kill(batch, SIGKILL);
  int how = 0;
  ASSERT_EQ(::waitpid(batch, nullptr, 0), batch);
  ASSERT_EQ(::waitpid(program, &how, 0), program);
  EXPECT_TRUE(WIFSIGNALED(how));
  EXPECT_EQ(WTERMSIG(how), SIGTERM);
}

}  // namespace
}  // namespace grit
