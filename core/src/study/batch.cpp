#include "study/batch.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <thread>
#include <utility>

#include "grit/error.hpp"

namespace grit {
namespace {

constexpr auto poll_interval = std::chrono::milliseconds(50);

/// In the child: becomes the program, which gets SIGTERM when its parent ends, even if that is killed. Returns only if
/// it cannot be started.
void become(char* const* words, int log, pid_t parent, const sigset_t& usual) {
  // Programs such as scripts expect these signals to end them.
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGXCPU}) std::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  ::sigprocmask(SIG_SETMASK, &usual, nullptr);
  if (::getppid() != parent) ::raise(SIGTERM);  // it ended before that
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 && ::dup2(log, STDOUT_FILENO) >= 0 &&
      ::dup2(log, STDERR_FILENO) >= 0)
    ::execvp(words[0], words);
}

/// Throws FileError. posix_spawn cannot ask for a signal at the end of the parent.
pid_t start(const BatchJob& job) {
  std::vector<char*> words;
  for (const auto& word : job.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  std::filesystem::create_directories(job.log.parent_path());
  const int log = ::open(job.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (log < 0) throw FileError(job.log.string() + ": cannot write it: " + std::strerror(errno));
  if (::write(log, job.heading.data(), job.heading.size()) != static_cast<ssize_t>(job.heading.size())) {
    const int error = errno;
    ::close(log);
    throw FileError(job.log.string() + ": cannot write it: " + std::strerror(error));
  }
  // The child reports why it could not become the program; otherwise that closes the pipe.
  int pipe[2] = {-1, -1};
  int fault = ::pipe2(pipe, O_CLOEXEC) == 0 ? 0 : errno;
  pid_t child = -1;
  if (fault == 0) {
    sigset_t all, usual;
    sigfillset(&all);
    ::sigprocmask(SIG_SETMASK, &all, &usual);  // the handlers of the parent are not for the child
    const pid_t parent = ::getpid();
    child = ::fork();
    if (child == 0) {
      become(words.data(), log, parent, usual);
      const int why = errno;
      static_cast<void>(!::write(pipe[1], &why, sizeof why));
      for (;;) ::pause();  // the parent kills it, so that none of its destructors run here
    }
    if (child < 0) fault = errno;
    ::sigprocmask(SIG_SETMASK, &usual, nullptr);
    ::close(pipe[1]);
    ssize_t count = 0;
    do count = child < 0 ? 0 : ::read(pipe[0], &fault, sizeof fault);
    while (count < 0 && errno == EINTR);
    ::close(pipe[0]);
  }
  ::close(log);
  if (fault == 0) return child;
  if (child > 0) ::kill(child, SIGKILL), ::waitpid(child, nullptr, 0);
  throw FileError(job.words.front() + " cannot be started: " + std::strerror(fault));
}

}  // namespace

void run_batch(std::span<const BatchJob> jobs, std::size_t at_once, const std::atomic<bool>& interrupted,
               const BatchEvents& events) {
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  bool go_on = true, stopped = false;
  const auto stop_all = [&] {
    for (const auto& [pid, index] : running) ::kill(pid, SIGTERM);
  };
  try {
    while (true) {
      go_on = go_on && !interrupted.load();
      if (!go_on && !std::exchange(stopped, true)) stop_all();
      while (go_on && next < jobs.size() && running.size() < at_once) {
        running.emplace(start(jobs[next]), next);
        ++next;
      }
      if (running.empty()) return;
      int status = 0;
      const pid_t pid = ::waitpid(-1, &status, WNOHANG);
      if (const auto found = running.find(pid); found != running.end()) {
        const std::size_t index = found->second;
        running.erase(found);
        go_on = events.ended(index, WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status)) && go_on;
        continue;
      }
      events.waiting(running.size());
      std::this_thread::sleep_for(poll_interval);
    }
  } catch (...) {
    stop_all();
    for (const auto& [pid, index] : running) ::waitpid(pid, nullptr, 0);
    throw;
  }
}

}  // namespace grit
